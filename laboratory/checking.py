"""Validation of a specification against simulated.schema.yaml."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import get_close_matches
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator
from jsonschema.exceptions import ValidationError
from ruamel.yaml import YAML

from laboratory.errors import Complaint, SpecificationError

SCHEMA = Path(__file__).with_name("simulated.schema.yaml")


@cache
def the_schema() -> dict[str, Any]:
    """simulated.schema.yaml."""
    schema: dict[str, Any] = YAML(typ="safe", pure=True).load(SCHEMA)
    return schema


def check(document: object, source: str) -> None:
    """Refuse what the schema does not allow; `source` is the file in the message."""
    complaints = list(not_finite(document, "")) or [
        complaint
        for error in sorted(
            Draft202012Validator(the_schema()).iter_errors(document), key=lambda e: place_of(e.path)
        )
        for complaint in complaints_of(error)
    ]
    if complaints:
        raise SpecificationError(source, *dict.fromkeys(complaints))


def complaints_of(error: ValidationError) -> Iterator[Complaint]:
    """What is wrong according to the schema, in words."""
    place = place_of(error.absolute_path)
    schema: dict[str, Any] = error.schema  # type: ignore[assignment]  # none of ours is a bare true
    found: Any = error.instance
    if error.validator == "additionalProperties":
        known = list(schema["properties"])
        for key in found:
            if key not in known:
                yield Complaint(joined(place, key), "a key that is not known", one_of(key, known))
    elif error.validator == "required":
        for key in schema["required"]:
            if key not in found:
                meaning = described(schema["properties"][key])
                yield Complaint(joined(place, key), "nothing", meaning)
    else:
        yield Complaint(place or "the file", shown(found), described(schema))


def described(schema: Mapping[str, Any]) -> str:
    """What the schema expects: its description, or else its type."""
    if "$ref" in schema:
        definition = schema["$ref"].removeprefix("#/$defs/")
        schema = {**the_schema()["$defs"][definition], **schema}
    if "description" in schema:
        return str(schema["description"])
    if "enum" in schema:
        return "one of " + ", ".join(map(str, schema["enum"]))
    return str(schema.get("const", schema.get("type", "another value")))


def one_of(key: object, known: Sequence[str]) -> str:
    """The keys that are known, and the one that was probably meant."""
    meant = get_close_matches(str(key), known, n=1)
    hint = f" (did you mean {meant[0]}?)" if meant else ""
    return "one of " + ", ".join(known) + hint


def shown(found: object) -> str:
    """What was found, short enough for one line, with its kind."""
    text = repr(found) if isinstance(found, (str, int, float, bool, list, dict)) else str(found)
    if len(text) > 80:
        text = text[:77] + "..."
    return f"{text} ({KINDS.get(type(found).__name__, type(found).__name__)})"


KINDS = {
    "str": "text",
    "int": "number",
    "float": "number",
    "bool": "true or false",
    "list": "list",
    "dict": "mapping",
    "NoneType": "empty",
    "date": "a date; put it in quotes",
}


def not_finite(value: object, place: str) -> Iterator[Complaint]:
    """Numbers that are not finite: .nan and .inf are valid YAML."""
    if isinstance(value, float) and not isfinite(value):
        yield Complaint(place, str(value), "a finite number")
    elif isinstance(value, Mapping):
        for key, inner in value.items():
            yield from not_finite(inner, joined(place, key))
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from not_finite(inner, f"{place}[{index}]")


def place_of(path: Iterable[str | int]) -> str:
    """A path through the document as one word: campaign.plan[3].up."""
    place = ""
    for step in path:
        place = f"{place}[{step}]" if isinstance(step, int) else joined(place, step)
    return place


def joined(place: str, key: object) -> str:
    """A key below a place."""
    return f"{place}.{key}" if place else str(key)
