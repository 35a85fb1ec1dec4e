"""A campaign made elsewhere is refused by name or does no harm, whatever it says."""

import re
from pathlib import Path
from typing import Any

import pytest
from campaign_by_table import BY_TABLE
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from inertial.tables.campaign_files import logs_of
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from stages.plan.stage import plan

ROOT = Path(__file__).parent.parent
INSTRUMENTS = ROOT / "data/instruments.yaml"
CAMPAIGN = f"""{BY_TABLE}\
  - {{id: all, do: tumble, up: +x, about: +y, step_degrees: 45, steps: 8, seconds: 60}}
  - {{id: more, do: rest, up: [0, 0, 1], rows: [0, 100], seconds: 20}}
"""


def campaign(folder: Path, text: str | bytes) -> Path:
    folder.mkdir(exist_ok=True)
    file = folder / "campaign.yaml"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return file


def planned(file: Path, *logs: Path) -> dict[str, Any]:
    return dict(plan([file], list(logs), [INSTRUMENTS]))


@pytest.fixture
def session(tmp_path: Path) -> Path:
    log = tmp_path / "session.asc"
    log.write_bytes(b"")
    return log


def test_the_campaign_itself_is_understood(tmp_path, session):
    assert len(planned(campaign(tmp_path, CAMPAIGN), session)["manoeuvres"]) == 11


# ---- what it may read


@pytest.mark.parametrize(
    "name",
    [
        "../session.asc",
        "/etc/passwd",
        "sub/session.asc",
        "..",
        ".",
        "",
        "-rf",
        "--output",
        ".hidden",
        "session.asc\n",
        "ses\nsion.asc",
        'ses"sion.asc',
        "ses'sion.asc",
        "session.asc;rm -rf .",
        "$(id).asc",
        "`id`.asc",
        "{rule}.asc",
        "a|b",
        "a\x00b",
        "con\u202egpj.asc",
    ],
)
def test_a_log_is_a_plain_name_in_the_campaign_s_folder(tmp_path, session, name):
    written = CAMPAIGN.replace("log: session.asc", f"log: {YAML_TEXT(name)}")
    file = campaign(tmp_path, written)
    with pytest.raises(Refusal, match=r"campaign\.yaml"):
        planned(file, session)


def YAML_TEXT(text: str) -> str:  # noqa: N802
    """A text in double quotes as YAML has it."""
    return '"' + "".join(f"\\U{ord(c):08x}" for c in text) + '"'


def test_a_name_with_blanks_is_a_name(tmp_path):
    log = tmp_path / "session of 2 November.asc"
    log.write_bytes(b"")
    text = CAMPAIGN.replace("log: session.asc", f"log: {log.name}")
    assert len(planned(campaign(tmp_path, text), log)["logs"]) == 1


def test_a_link_that_leaves_the_folder_is_refused(tmp_path):
    outside = tmp_path / "secret"
    outside.write_bytes(b"")
    folder = tmp_path / "campaign"
    file = campaign(folder, CAMPAIGN)
    link = folder / "session.asc"
    link.symlink_to(outside)
    with pytest.raises(Refusal, match=r"a link to .*secret"):
        planned(file, link)


def test_a_link_inside_the_folder_is_a_log(tmp_path):
    (tmp_path / "kept.asc").write_bytes(b"")
    link = tmp_path / "session.asc"
    link.symlink_to("kept.asc")
    assert len(planned(campaign(tmp_path, CAMPAIGN), link)["logs"]) == 1


def test_a_log_that_is_linked_from_elsewhere_as_a_whole_campaign_is_the_user_s_own(tmp_path):
    folder = tmp_path / "elsewhere"
    file = campaign(folder, CAMPAIGN)
    (folder / "session.asc").write_bytes(b"")
    (tmp_path / "campaign").symlink_to(folder)
    linked = tmp_path / "campaign"
    assert len(planned(linked / file.name, linked / "session.asc")["logs"]) == 1


# ---- what it may be


def grown(levels: int) -> str:
    """A few lines that become ten to the power of `levels` values."""
    lines = ['a0: &a0 "lol"']
    lines += [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 10)}]" for k in range(1, levels + 1)]
    return "\n".join(lines)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("text", "words"),
    [
        (grown(9), "more than 100000 values"),
        ("a: &a [*a]", "campaign: 1"),
        ("a: &a {b: *a}", "campaign: 1"),
        ("[" * 1000 + "]" * 1000, "levels"),
        ("{a: " * 1000 + "1" + "}" * 1000, "levels"),
        (b"serial: \xff\xfe", "no UTF-8"),
        ("serial: a\x00b", "YAML"),
        ("? [a, b]\n: 1", "a key of text"),
        ("a: !!python/object/apply:os.system [id]", "remove its tag"),
        ("a: !secret b", "remove its tag"),
        ("a: .nan", "a finite number"),
        ("a: -.inf", "a finite number"),
        ("a: 1e400", "a finite number"),
        ("a: 1e300", "at most 1e"),
        ("a: 123456789012345678901234567890", "at most 1e"),
        ("a: 1\na: 2", "YAML 1.2"),
        ("", "campaign: 1"),
        ("campaign: 2", "campaign: 1"),
        ("[1, 2]", "campaign: 1"),
    ],
)
def test_what_is_no_campaign_is_refused_at_once(tmp_path, text, words):
    with pytest.raises(Refusal, match=re.escape(words)):
        planned(campaign(tmp_path, text))


def test_a_campaign_of_many_megabytes_is_refused_unread(tmp_path):
    with pytest.raises(Refusal, match="is this a log"):
        YamlFile(campaign(tmp_path, b"a: 1\n" * 1_000_000))


# ---- whatever stands where


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(10**20), 10**20),
    st.floats(),
    st.sampled_from([0, -1, 1e-320, 1e14, -1e14, "", "unknown", "+x", [], {}, [0, 0, 0], "<b>"]),
    st.text(max_size=8),
    st.lists(st.floats(-2, 2) | st.integers(-3, 3), max_size=4),
    st.dictionaries(st.text(max_size=5), st.integers(), max_size=2),
)


def places(content: Any, key: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    """Every key of the campaign."""
    inside = content.items() if isinstance(content, dict) else enumerate(content)
    found = []
    for name, value in inside:
        found.append((*key, name))
        if isinstance(value, dict | list):
            found += places(value, (*key, name))
    return found


def loaded() -> Any:
    return YAML(typ="safe", pure=True).load(CAMPAIGN)


@given(st.lists(st.tuples(st.sampled_from(places(loaded())), VALUES), min_size=1, max_size=3))
@settings(max_examples=150)
def test_any_value_anywhere_is_understood_or_refused_by_name(tmp_path_factory, changes):
    content = loaded()
    for key, value in changes:
        inside = content
        try:
            for name in key[:-1]:
                inside = inside[name]
            inside[key[-1]] = value
        except (KeyError, IndexError, TypeError):
            continue
    folder = tmp_path_factory.getbasetemp() / "any"
    folder.mkdir(exist_ok=True)
    file = folder / "campaign.yaml"
    with file.open("w", encoding="utf-8") as stream:
        YAML().dump(content, stream)
    raw = [folder / log for log in logs_of(file) if re.fullmatch(r"[\w. -]+", log)]
    for log in raw:
        if not log.is_dir():
            log.write_bytes(b"")
    try:
        planned(file, *(log for log in raw if log.is_file()))
    except Refusal as refusal:
        assert str(refusal).startswith(str(file))
