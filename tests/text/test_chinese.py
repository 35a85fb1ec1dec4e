"""The report in Chinese: every message translated, the sentences of tables, type."""

from __future__ import annotations

import re
import string
import subprocess
import sys
from collections.abc import Iterator
from html import unescape
from pathlib import Path

import pytest
from babel.messages.catalog import Message
from babel.messages.pofile import read_po

from inertial.tables import FINDINGS
from inertial.tables.parquet import Writer
from inertial.text import messages
from inertial.text.messages import LANGUAGES, _, plural, speak
from inertial.text.numbers import counted
from inertial.text.typography import CHINESE, columns_of, typeset, wrapped

FILE = LANGUAGES / "zh.po"
# What is the same in both languages: names of parameters, units, parts of files.
SAME = {"IMU", "ppm", "s", "ms²", "PDF", "Kalibr (imu.yaml)", "positions", "{seconds:.1f} s"}


@pytest.fixture
def chinese() -> Iterator[None]:
    """A process that speaks Chinese."""
    speak("zh")
    yield
    speak("en")


def translated() -> list[Message]:
    with FILE.open("rb") as file:
        return [message for message in read_po(file) if message.id]


def forms(message: Message) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The English and the Chinese forms of a message."""
    english, chinese = message.id, message.string
    return (
        (english,) if isinstance(english, str) else tuple(english),
        (chinese,) if isinstance(chinese, str) else tuple(chinese),
    )


def holes(text: str) -> set[tuple[str, str | None, str | None]]:
    """What stands in the braces of a message."""
    return {
        (name, how, spec) for _before, name, spec, how in string.Formatter().parse(text) if name
    }


def test_every_message_is_translated() -> None:
    every = translated()
    missing = [forms(m)[0] for m in every if not all(forms(m)[1])]
    assert not missing, "translate what `make docs` added to zh.po"
    alike = {english[0] for english, own in map(forms, every) if english[0] == own[0]}
    plain = {text for text in alike if text not in SAME and not text.startswith(("#", "lib"))}
    assert not plain


def english_left(page: str) -> list[str]:
    """Sentences of the catalogue, of four words and more, that a page has in English."""
    shown = re.sub(r"<(script|style).*?</\1>|<[^>]+>", " ", page, flags=re.DOTALL)
    plain = " ".join(unescape(shown).split())
    every = (english[0] for english, _own in map(forms, translated()))
    return [one for one in every if len(one.split()) > 3 and not holes(one) and one in plain]


def test_a_translation_has_the_values_of_its_message() -> None:
    for english, own in map(forms, translated()):
        wanted = set.union(*map(holes, english))
        for text in own:
            assert holes(text) == wanted, english[0]


def test_a_table_keeps_what_its_sentences_were_made_of(tmp_path: Path) -> None:
    kept = _("{name}: {count} of {all}.", name="x-up.asc", count=counted(3, "record"), all=9)
    several = kept + " " + plural("{count} spike", "{count} spikes", 1) + _(" or ") + _("gap")
    row = dict.fromkeys((column.name for column in FINDINGS.columns), "")
    row |= {"severity": 1, "count": 1, "from_s": None, "to_s": None, "size": None, "p_value": None}
    row |= {"sentence": several, "consequence": "Messraum 3, Keller"}
    with Writer(tmp_path, {"findings": FINDINGS}, dict) as writer:
        writer.write("findings", FINDINGS.frame([row]))
    path = tmp_path / "findings.parquet"
    assert FINDINGS.read(path)["sentence"][0] == "x-up.asc: 3 records of 9. 1 spike or gap"
    speak("zh")
    try:
        read = FINDINGS.read(path)
    finally:
        speak("en")
    # The two messages that no catalogue has stay English; what stands in them does not.
    assert typeset(read["sentence"][0]) == "x-up.asc: 3 个记录 of 9. 1 spike 或数据中断"
    assert read["consequence"][0] == "Messraum 3, Keller"


def test_a_process_speaks_the_language_that_it_is_told(chinese: None) -> None:
    assert _("angle random walk") == "angle random walk"  # no message
    assert _("Angle random walk") == "角度随机游走"
    assert _("up to {size} σ", size="3.2") == "最多 3.2 σ"
    assert _("up to {size} σ").format(size="3.2") == "最多 3.2 σ"
    assert counted(2, "record") == "2 个记录"
    assert _("is") == ""  # which Chinese does not have here
    assert messages.language() == "zh"


@pytest.mark.parametrize(
    ("put_together", "right"),
    [
        (
            "零偏: 3.2 µg, 4.1 µg; 比例因子 (p = 0.3).",
            "零偏：3.2 µg, 4.1 µg；比例因子（p = 0.3）。",
        ),
        ("已更正。 结果有效.", "已更正。结果有效。"),
        ("陀螺仪 (已内插), 加速度计", "陀螺仪（已内插），加速度计"),
        ("bias: 3.2 µg, f(x), 1.5.", "bias: 3.2 µg, f(x), 1.5."),
        ("x-up.asc: 静止 300 s.", "x-up.asc：静止 300 s。"),
        ("各轴按记录值.数据中断共 2 s.", "各轴按记录值。数据中断共 2 s。"),
    ],
)
def test_marks_are_those_of_the_language(put_together: str, right: str) -> None:
    assert typeset(put_together) == right


def test_lines_are_as_wide_as_they_look_and_begin_with_no_mark() -> None:
    text = "陀螺仪在静止时的读数为地球自转，而不是零；加速度计 x-up.asc 的读数为 +g。" * 4
    lines = wrapped(text, 40, "- ", "  ")
    assert "".join(line.strip(" -") for line in lines).replace(" ", "") == text.replace(" ", "")
    assert all(CHINESE.search(line) and columns_of(line) <= 42 for line in lines)
    assert not any(line.strip()[0] in "，。；）" for line in lines)


DRAWN = """
import sys
from inertial.text.messages import speak
speak(sys.argv[1])
import pandas as pd
from stages.report.sections.compensation import _chosen
from stages.report.tables import Tables
rest = {"manoeuvre": "a", "do": "rest", "up_z": -1.0, "angle": None}
turn = {"manoeuvre": "b", "do": "turn", "about_z": 1.0, "angle": 6.3}
axes = [f"{of}_{axis}" for of in ("up", "about") for axis in "xyz"]
plan = pd.DataFrame([rest, turn]).reindex(columns=["manoeuvre", "do", "angle", "rate", *axes])
print(*_chosen(Tables({"segments": plan, "manoeuvres": plan}, {})), sep="; ")
"""


@pytest.mark.parametrize(
    ("language", "shown"),
    [("en", "z down; turn forward about z"), ("zh", "z 朝下; 绕 z 轴正向转动")],
)
def test_the_same_manoeuvres_are_drawn_in_both_languages(language: str, shown: str) -> None:
    command = [sys.executable, "-c", DRAWN, language]
    done = subprocess.run(command, capture_output=True, text=True, check=True, encoding="utf-8")
    assert done.stdout.strip() == shown
