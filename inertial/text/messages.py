"""The sentences that a person reads: gettext, with values by name.

_("{count} records are missing before record {record}", count=12, record=4711)

The English sentence is its own key. Another language is a file `<language>.po` beside this one, to
which `make docs` adds what is new in the code; a test fails where it lacks a sentence. A process
speaks English unless it says `speak` before it imports what has sentences in it; then the sentences
of the tables that it reads are in that language too.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from gettext import GNUTranslations, NullTranslations
from io import BytesIO
from pathlib import Path
from string import Formatter
from typing import Any

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


# ---- What sentences are made of: the message of the catalogue, and the values in it.
#
# Stages write their tables in English. Of each sentence the table keeps beside it from which
# messages and values it was made (`needed`), so whoever reads the table can have it in another
# language (`rendered`), and no stage runs again for it. A text that is put together from several
# sentences is taken apart at the places where they are known to begin and to end.

WORDS = re.compile(r"[A-Za-z]{2}")  # what has none is a number, a unit or a sign
MOST_KNOWN = 100_000  # sentences; what a damaged log has more stays English
WORD = re.compile(r"[A-Za-z0-9_]+")
BESIDE = r"A-Za-z0-9_/\-"  # what a part of a longer word or identifier stands beside

ENGLISH_WORD = re.compile(r"\b[a-z]{2,}\b")
ONE_WORD = re.compile(r"[A-Za-z]+")
ENDS, BEGINS = re.compile(r"(?<![\w.-])[a-z]+ $"), re.compile(r" [a-z]+(?![\w.-])")
# (message, forms of its plural): the English is the key of the catalogue.
Key = tuple[str, ...]


@dataclass(frozen=True)
class Recipe:
    """One sentence: its message, singular first, the count that chose the form, and its values.

    `values`: by what stands in the braces, as they stand in the sentence.
    """

    message: Key
    values: Mapping[str, str] = field(default_factory=dict)
    count: int | None = None
    cut: bool = False  # its full stop is taken off


_known: dict[str, Recipe] = {}
_by_word: dict[str, list[str]] = {}  # the known sentences by the first word of each


def values_in(message: str, values: Mapping[str, Any]) -> dict[str, str]:
    """The values of a message, each as it stands in the sentence, by what its braces hold."""
    found = {}
    for _before, name, form, conversion in Formatter().parse(message):
        if name is not None:
            key = f"{name}!{conversion}" if conversion else name
            key = f"{key}:{form}" if form else key
            found[key] = f"{{{key}}}".format_map(values)
    return found


def filled(message: str, values: Mapping[str, str]) -> str:
    """A message with values that stand by what its braces hold; unknown braces stay."""
    parts = []
    for before, name, form, conversion in Formatter().parse(message):
        parts.append(before)
        if name is not None:
            key = f"{name}!{conversion}" if conversion else name
            key = f"{key}:{form}" if form else key
            parts.append(values.get(key, f"{{{key}}}"))
    return "".join(parts)


def remember(text: str, recipe: Recipe) -> None:
    """`text` was made by this recipe; so was it with another first letter, or without its end."""
    for start in (text[:1], text[:1].swapcase()):
        _keep(start + text[1:], recipe)
        if text.endswith(".") and len(text) > 1:
            _keep(start + text[1:-1], replace(recipe, cut=True))


def _keep(text: str, recipe: Recipe) -> None:
    if text not in _known and len(_known) < MOST_KNOWN:
        _known[text] = recipe
        if WORDS.search(text):
            _by_word.setdefault(WORD.findall(text)[0], []).append(text)


def learn(stored: Mapping[str, Any]) -> None:
    """What a table keeps of its sentences, as `needed` gave it."""
    for text, (message, values, count, cut) in stored.items():
        _keep(text, Recipe(tuple(message), values, count, cut))


def needed(texts: Iterable[str]) -> dict[str, Any]:
    """The recipes of these texts and of the values in them, for JSON."""
    found: dict[str, Any] = {}
    waiting = list(dict.fromkeys(texts))
    while waiting:
        for part in parts_of(waiting.pop()):
            if part in _known and part not in found:
                recipe = _known[part]
                found[part] = [list(recipe.message), dict(recipe.values), recipe.count, recipe.cut]
                waiting += recipe.values.values()
    return found


def rendered(text: str, in_language: Callable[[Recipe], str]) -> str:
    """The text with every sentence in it that is known said by `in_language`."""
    said = []
    for part in parts_of(text):
        recipe = _known.get(part)
        if recipe is None:
            said.append(part)
        else:
            values = {name: rendered(each, in_language) for name, each in recipe.values.items()}
            sentence = in_language(replace(recipe, values=values))
            said.append(sentence.rstrip(".。") if recipe.cut else sentence)
    return "".join(said)


def parts_of(text: str) -> Iterator[str]:
    """The known sentences of a text, the longest first taken, and what is between them."""
    if not WORDS.search(text):
        yield text
        return
    if text in _known:
        yield text
        return
    words = dict.fromkeys(WORD.findall(text))
    within = [known for word in words for known in _by_word.get(word, ()) if known in text]
    parts = [*_parts(text, sorted(within, key=len, reverse=True))]
    if any(part not in _known and ENGLISH_WORD.search(part) for part in parts):
        # Of a text from outside no word is a sentence: “a text of the laboratory”.
        parts = _joined(parts)
    yield from parts


def _parts(text: str, candidates: list[str]) -> Iterator[str]:
    for number, known in enumerate(candidates):
        if known in text and (found := _alone(known).search(text)):
            rest = candidates[number:]
            if found.start():
                yield from _parts(text[: found.start()], rest)
            yield known
            if found.end() < len(text):
                yield from _parts(text[found.end() :], rest)
            return
    if text:
        yield text


def _joined(parts: list[str]) -> list[str]:
    """Parts of one word that stand beside an English word that is no part, joined with it."""
    joined: list[str] = []
    for part in parts:
        last = joined[-1] if joined else ""
        unknown = last and last not in _known
        if (
            (unknown and ONE_WORD.fullmatch(part) and ENDS.search(last))
            or (last and ONE_WORD.fullmatch(last) and part not in _known and BEGINS.match(part))
            or (unknown and part not in _known)
        ):
            joined[-1] += part
        else:
            joined.append(part)
    return joined


def _alone(known: str) -> re.Pattern[str]:
    """A known text that is no part of a longer word."""
    before = rf"(?<![{BESIDE}])" if re.match(r"\w", known) else ""
    after = rf"(?![{BESIDE}])" if re.search(r"\w$", known) else ""
    return re.compile(before + re.escape(known) + after)


# ---- Enumerations in a sentence.


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names as part of a sentence: a, b and c."""
    if len(names) < 2:
        return "".join(names)
    return _(", ").join(names[:-1]) + (_(" and ") if last == "and" else _(" or ")) + names[-1]


def first_of(names: Sequence[str], most: int) -> str:
    """Names, of which those beyond `most` are only counted: a, b and 3 more."""
    rest = len(names) - most
    return ", ".join(names[:most]) + (_(" and {more} more", more=rest) if rest > 0 else "")
