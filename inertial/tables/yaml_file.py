"""A YAML 1.2 file that people wrote: its content, and the line of every key for errors.

Dates stay text, as YAML 1.2 has it.
"""

import difflib
import re
from collections.abc import Sequence
from datetime import date
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any

import jsonschema
from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.error import MarkedYAMLError, YAMLError
from ruamel.yaml.resolver import VersionedResolver
from ruamel.yaml.scalarbool import ScalarBoolean
from ruamel.yaml.tag import Tag

from inertial.tables.errors import Refusal
from inertial.text.messages import _

Key = Sequence[str | int]
MAX_BYTES = 4_000_000  # a campaign file of a person is a thousand times smaller
MAX_VALUES, MAX_DEPTH = (
    100_000,
    40,
)  # values, and levels of them: a few lines of aliases make billions
MOST_KEYS = 8  # that a refusal lists; of more those near to the unknown one and those required
MAX_NUMBER = 1e15  # nothing that a laboratory writes down is larger, in whichever unit
FOLDER = Path(__file__).parent
QUOTES = "'\""
TEXT = Tag(suffix="tag:yaml.org,2002:str")


class _DatesAreText(VersionedResolver):
    """The YAML 1.2 core schema: without the timestamps that ruamel.yaml adds to it."""

    def resolve(self, kind: Any, value: Any, implicit: Any) -> Any:
        tag = super().resolve(kind, value, implicit)
        return TEXT if str(tag).endswith(":timestamp") else tag


FORMATS = jsonschema.FormatChecker(formats=())


@FORMATS.checks("day", ValueError)
def _is_day(text: object) -> bool:
    """Whether a text that looks like a date is one of the calendar."""
    return not isinstance(text, str) or text == "unknown" or bool(date.fromisoformat(text))


class YamlFile:
    """The content of a YAML file as plain dicts, lists and scalars.

    Raises
    ------
    Refusal
        where it is no YAML, with the line; later, where it breaks a schema, with line and key
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._lines: dict[tuple[str | int, ...], int] = {}
        self._values = 0
        self.content = self._plain(self._load(), ())

    def place(self, key: Key) -> str:
        """Line and key, as an error names them: `line 12, plan[3].up (id x-down)`."""
        known = tuple(key)
        while known and known not in self._lines:
            known = known[:-1]
        name = "".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in key).lstrip(".")
        line = f"line {self._lines[known]}" if known else ""
        return ", ".join(part for part in (line, name) if part) + self._id_of(key)

    def _id_of(self, key: Key) -> str:
        """The id of the item of a list that a key is in, in brackets; nothing where it has none."""
        part: Any = getattr(self, "content", None)
        found = ""
        for step in key:
            try:
                part = part[step]
            except (KeyError, IndexError, TypeError):
                break
            if isinstance(step, int) and isinstance(part, dict) and "id" in part:
                found = f" (id {shown(part['id']).strip(QUOTES)})"
        return found

    def refuse(self, key: Key, found: object, expected: str, cure: str) -> Refusal:
        """The error that names this file and `key`."""
        return Refusal(str(self.path), self.place(key), shown(found), expected, cure)

    def check(self, schema: str, entries: str | None = None, within: Key = ()) -> None:
        """Hold the content, or each of its entries, against `inertial/tables/<schema>.schema.yaml`.

        `entries` is the definition of that schema that every entry must follow; `within`: the key
        of what is held against it, where that is a part of the content.
        """
        rules = schema_of(schema)
        if entries:
            of_each = {"$ref": f"#/$defs/{entries}"}
            rules = {"type": "object", "additionalProperties": of_each, "$defs": rules["$defs"]}
        validator = jsonschema.Draft202012Validator(rules, format_checker=FORMATS)
        part = self.content
        for name in within:
            part = part[name]
        errors = list(validator.iter_errors(part))
        if errors:
            raise self._refusal_of(jsonschema.exceptions.best_match(errors), within)

    def _refusal_of(self, error: jsonschema.ValidationError, within: Key) -> Refusal:
        key = [*within, *error.absolute_path]
        rule: Any = error.schema
        meaning = rule.get("description", "") if isinstance(rule, dict) else ""
        if error.validator == "additionalProperties":
            allowed = list(rule["properties"])
            given: Any = error.instance
            unknown = next(k for k in given if k not in allowed)
            near = difflib.get_close_matches(str(unknown), allowed, n=1)
            cure = f"write {near[0]}" if near else "remove it"
            if isinstance(unknown, int):  # 48,35 within braces is 48 and a key 35
                cure = _("write decimals with a point: 48.35, not 48,35")
            found = _("the key {unknown}", unknown=shown(unknown))
            expected = _keys_near(str(unknown), allowed, rule.get("required", ()))
            return self.refuse_text([*key, unknown], found, expected, cure)
        if error.validator == "required":
            required: Any = error.validator_value
            instance: Any = error.instance
            missing = next(k for k in required if k not in instance)
            description = rule.get("properties", {}).get(missing, {}).get("description", "")
            return self.refuse_text(
                key,
                _("no key {missing!r}", missing=missing),
                f"{missing}: {description}".rstrip(": "),
                f"add {missing}",
            )
        if key and key[-1] in ("serial", "date") and not isinstance(error.instance, str):
            found = _(
                "the number {instance}, in which leading zeros are lost",
                instance=shown(error.instance),
            )
            return self.refuse_text(
                key, found, meaning, _('put it in quotes: {key}: "…"', key=key[-1])
            )
        above = error.parent
        while not meaning and above is not None and isinstance(above.schema, dict):
            meaning, above = above.schema.get("description", ""), above.parent
        told = f"{meaning} ({error.message})" if meaning else error.message
        by_form = error.validator in ("pattern", "format")
        expected = meaning if meaning and by_form else told
        return self.refuse(key, error.instance, expected, "correct the value")

    def refuse_text(self, key: Key, found: str, expected: str, cure: str) -> Refusal:
        """The error that names this file and `key`, with `found` in words."""
        return Refusal(str(self.path), self.place(key), found, expected, cure)

    def _load(self) -> Any:
        size = self.path.stat().st_size
        if size > MAX_BYTES:
            raise Refusal(
                str(self.path),
                "",
                f"{size} bytes",
                _("at most {max_bytes}", max_bytes=MAX_BYTES),
                "is this a log?",
            )
        yaml = YAML(typ="rt", pure=True)
        yaml.Resolver = _DatesAreText
        text = ""
        try:
            text = self.path.read_text(encoding="utf-8")
            return yaml.load(text)
        except UnicodeDecodeError as error:
            raise Refusal(
                str(self.path),
                f"byte {error.start}",
                "no UTF-8",
                "UTF-8 text",
                _("save it as UTF-8"),
            ) from None
        except MarkedYAMLError as error:
            mark = error.problem_mark
            if mark and (slip := _slip(text, mark.line)) is not None:
                number, found, expected, cure = slip
                line = _("line {line}", line=number + 1)
                raise Refusal(str(self.path), line, found, expected, cure) from None
            line = (
                _("line {line}, column {column}", line=mark.line + 1, column=mark.column + 1)
                if mark
                else ""
            )
            found = str(error.problem)
            raise Refusal(
                str(self.path), line, found, "YAML 1.2", _("correct this line or the one before")
            ) from None
        except (YAMLError, ValueError) as error:
            raise Refusal(str(self.path), "", str(error), "YAML 1.2", "correct the file") from None
        except RecursionError:
            raise self._too_much(
                "levels without end", _("at most {max_depth} levels", max_depth=MAX_DEPTH)
            ) from None

    def _too_much(self, found: str, expected: str) -> Refusal:
        return Refusal(str(self.path), "", found, expected, _("write it out without aliases"))

    def _plain(self, node: Any, key: tuple[str | int, ...]) -> Any:
        self._values += 1
        if self._values > MAX_VALUES:
            raise self._too_much(
                _("more than {max_values} values, aliases written out", max_values=MAX_VALUES),
                "fewer",
            )
        if len(key) > MAX_DEPTH:
            raise self._too_much(
                "more levels", _("at most {max_depth} levels", max_depth=MAX_DEPTH)
            )
        if getattr(getattr(node, "tag", None), "value", None):
            raise self.refuse(key, str(node), _("text, a number, a list or keys"), "remove its tag")
        if isinstance(node, CommentedMap):
            for name in node:
                if not isinstance(name, str | int):
                    raise self.refuse(key, name, "a key of text", _("put the key in quotes"))
                self._lines[(*key, name)] = node.lc.key(name)[0] + 1
            return {name: self._plain(value, (*key, name)) for name, value in node.items()}
        if isinstance(node, CommentedSeq):
            for number in range(len(node)):
                self._lines[(*key, number)] = node.lc.item(number)[0] + 1
            return [self._plain(value, (*key, number)) for number, value in enumerate(node)]
        return self._scalar(node, key)

    def _scalar(self, node: Any, key: Key) -> str | int | float | None:
        if isinstance(node, str):
            return str(node)
        if isinstance(node, ScalarBoolean | bool):
            return bool(node)
        if isinstance(node, int | float):
            if not isfinite(node):
                raise self.refuse(key, float(node), "a finite number", "correct the value")
            if abs(node) > MAX_NUMBER:
                raise self.refuse(
                    key,
                    node,
                    _("at most {max_number:g}", max_number=MAX_NUMBER),
                    "correct the value",
                )
            return int(node) if isinstance(node, int) else float(node)
        if node is None:
            return None
        raise self.refuse(key, str(node), "text or a number", _("put it in quotes"))


def _slip(text: str, last: int) -> tuple[int, str, str, str] | None:
    """A slip of a person by which a text is no YAML: line from 0, found, expected, cure; or None.

    `last`: the line that could not be read; an open quotation mark stands some lines before.
    """
    lines = text.splitlines()
    odd = [number for number, line in enumerate(lines) if line.count('"') % 2]
    if len(odd) % 2 and odd[0] <= last:
        found = _("a quotation mark without the second one")
        return odd[0], found, _("text between two quotation marks"), _("add the second one")
    line = lines[last] if last < len(lines) else ""
    if "\t" in line[: len(line) - len(line.lstrip())]:
        return last, _("a tab before the key"), _("blanks"), _("write blanks in its place")
    if re.fullmatch(r"[\s-]*[\w-]+: +[^\"'{\[#]*: .*", line):
        found = _("a second colon in the line, in text without quotation marks")
        return last, found, 'key: "…: …"', _("put the text in quotes")
    return None


def _keys_near(unknown: str, allowed: Sequence[str], required: Sequence[str]) -> str:
    """The keys that may be meant: of many the near ones, and those that must be there."""
    near = difflib.get_close_matches(unknown, allowed, n=3)
    if len(allowed) <= MOST_KEYS or not (near or required):
        return _("one of {allowed}", allowed=", ".join(allowed))
    if not near:
        return _("other keys; required: {required}", required=", ".join(required))
    if not required:
        return _("near to it: {near}", near=", ".join(near))
    return _(
        "near to it: {near}; required: {required}",
        near=", ".join(near),
        required=", ".join(required),
    )


@cache
def schema_of(name: str) -> dict[str, Any]:
    """The JSON schema `inertial/tables/<name>.schema.yaml`."""
    content = YAML(typ="safe", pure=True).load(FOLDER / f"{name}.schema.yaml")
    return dict(content)


def shown(value: object) -> str:
    """A value as it is shown in an error, not longer than a line."""
    text = repr(value)
    return text if len(text) <= 100 else f"{text[:97]}…"
