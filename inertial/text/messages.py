"""The sentences that a person reads: gettext, with values by name.

    _("{count} records are missing before record {record}", count=12, record=4711)

The English sentence is its own key. Another language is a file `<language>.po` beside this one, to
which `make docs` adds what is new in the code; a test fails where it lacks a sentence. A process
speaks English unless it says `speak` before it imports what has sentences in it; then the sentences
of the tables that it reads are in that language too.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from gettext import GNUTranslations, NullTranslations
from io import BytesIO
from pathlib import Path
from typing import Any

from inertial.text.recipes import Recipe, filled, remember, rendered, values_in

LANGUAGES = Path(__file__).parent
ENGLISH = "en"
NOTHING = "\u200b"  # in place of a word that another language does not have; "" is no translation
LOCALES = {"en": "en", "zh": "zh-CN"}  # as a page states it


def translations(language: str, folder: Path = LANGUAGES) -> NullTranslations:
    """The sentences in a language; those that it lacks stay English."""
    file = folder / f"{language}.po"
    if not file.exists():
        return NullTranslations()
    from babel.messages.mofile import write_mo
    from babel.messages.pofile import read_po

    compiled = BytesIO()
    with file.open("rb") as source:
        write_mo(compiled, read_po(source))
    compiled.seek(0)
    return GNUTranslations(compiled)


class Message(str):
    """A sentence with braces, whose values come later; what it was makes them a recipe."""

    __slots__ = ("message",)
    message: str

    def format(self, *args: object, **values: object) -> str:
        """The sentence with these values."""
        return self.format_map(values)

    def format_map(self, values: Mapping[str, object]) -> str:  # type: ignore[override]
        """The same."""
        return _remembered(str.format_map(self, values), self.message, values)


_language = ENGLISH
_chosen = NullTranslations()


THIN_SPACE = "\u202f"  # between thousands


def speak(language: str) -> None:
    """What follows in this process is said in a language of `LOCALES`."""
    global _language, _chosen
    _language, _chosen = language, translations(language)


def speak_as_set(arguments: Sequence[str]) -> None:
    """Speak the `language` of `--settings JSON` among the arguments; English where it has none."""
    if "--settings" in arguments[:-1]:
        settings = json.loads(arguments[arguments.index("--settings") + 1])
        speak(settings.get("language", ENGLISH))


def language() -> str:
    """The language of this process."""
    return _language


def _(message: str, **values: Any) -> str:
    """A sentence in the language of this process, its `{names}` replaced by the values."""
    sentence = _translated(message)
    if values:
        return _remembered(sentence.format_map(values), message, values)
    if "{" not in message:
        return _remembered(sentence, message, {})
    later = Message(sentence)
    later.message = message
    return later


def _translated(message: str) -> str:
    sentence = _chosen.gettext(message)
    return "" if sentence == NOTHING else sentence


def noun(name: str) -> str:
    """A message without values, whose text comes from elsewhere in the code."""
    return _remembered(_translated(name), name, {})


def plural(one: str, many: str, count: int, **values: Any) -> str:
    """The same in the form that goes with a count, which the sentence names as `{count}`."""
    values = values | {"count": f"{count:,}".replace(",", THIN_SPACE)}
    text = _chosen.ngettext(one, many, count).format_map(values)
    if _language == ENGLISH:
        used = one if count == 1 else many
        remember(text, Recipe((one, many), values_in(used, values), count))
    return text


def _remembered(text: str, message: str, values: Mapping[str, object]) -> str:
    if _language == ENGLISH:
        remember(text, Recipe((message,), values_in(message, values)))
    return text


def in_this_language(text: str) -> str:
    """An English text of a table in the language of this process."""
    return rendered(text, _said)


def _said(recipe: Recipe) -> str:
    if recipe.count is None:
        return filled(_translated(recipe.message[0]), recipe.values)
    one, many = recipe.message
    return filled(_chosen.ngettext(one, many, recipe.count), recipe.values)
