"""The catalogue of sentences: whole, and every sentence finds the values that it names."""

import ast
import string
from collections.abc import Iterator
from pathlib import Path

import pytest
from babel.messages.catalog import Catalog
from babel.messages.extract import extract_from_dir
from babel.messages.pofile import read_po, write_po

from inertial.text.messages import LANGUAGES, translations

ROOT = Path(__file__).parents[2]
KEYWORDS = {"_": None, "plural": (1, 2), "counted": (2,)}
PLACES = ("inertial", "stages", "commands", "overviews")


def written() -> dict[str | tuple[str, ...], str]:
    """Every sentence in the code, and where it first stands."""
    return {
        message: f"{place}/{file}:{line}"
        for place in PLACES
        for file, line, message, _, _ in extract_from_dir(ROOT / place, keywords=KEYWORDS)
    }


def calls() -> Iterator[tuple[str, ast.Call]]:
    """Every call that hands over a sentence, and where it stands."""
    for place in PLACES:
        for path in sorted((ROOT / place).rglob("*.py")):
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
                if isinstance(node, ast.Call) and getattr(node.func, "id", "") in KEYWORDS:
                    yield f"{path.relative_to(ROOT)}:{node.lineno}", node


@pytest.mark.slow
@pytest.mark.parametrize("translation", sorted(LANGUAGES.glob("*.po")), ids=lambda file: file.stem)
def test_a_translation_has_every_sentence_of_the_code_and_no_other(translation: Path) -> None:
    with translation.open("rb") as file:
        listed = {message.id for message in read_po(file) if message.id}
    found = written()
    assert len(found) > 300
    missing = [f"{found[m]}: {m}" for m in found if m not in listed]
    assert not missing, "run `make docs`"
    assert not listed - set(found), "run `make docs`"


def test_every_sentence_gets_the_values_that_it_names() -> None:
    for place, call in calls():
        given = {keyword.arg for keyword in call.keywords}
        if call.func.id == "counted":  # type: ignore[attr-defined]
            continue  # a noun, which names no value
        several = call.func.id == "plural"  # type: ignore[attr-defined]
        for text in call.args[: 2 if several else 1]:
            assert isinstance(text, ast.Constant) and isinstance(text.value, str), place
            if several or given:
                named = {name for _, name, _, _ in string.Formatter().parse(text.value) if name}
                known = given | ({"count"} if several else set())
                assert {name.partition(".")[0].partition("[")[0] for name in named} <= known, place


def test_another_language_is_a_file_beside_the_catalogue(tmp_path: Path) -> None:
    german = Catalog(locale="de")
    german.add("{count} records are missing", "es fehlen {count} Datensätze")
    german.add(("{count} spike", "{count} spikes"), ("{count} Ausreißer", "{count} Ausreißer"))
    with (tmp_path / "de.po").open("wb") as file:
        write_po(file, german)
    chosen = translations("de", tmp_path)
    assert chosen.gettext("{count} records are missing") == "es fehlen {count} Datensätze"
    assert chosen.ngettext("{count} spike", "{count} spikes", 3) == "{count} Ausreißer"
    assert chosen.gettext("not translated yet") == "not translated yet"


@pytest.mark.parametrize("language", ["en", "xx"])
def test_a_language_without_a_file_is_english(tmp_path: Path, language: str) -> None:
    assert translations(language, tmp_path).gettext("a sentence") == "a sentence"
