"""Values as a campaign file has them: YAML on one line."""

import json
import re
from collections.abc import Mapping
from typing import Any

PLAIN = re.compile(r"^[A-Za-z][\w-]*$")
WORDS = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


def flow(**keys: Any) -> str:
    """Keys and values on one line, in braces."""
    return "{" + ", ".join(f"{key}: {in_flow(value)}" for key, value in keys.items()) + "}"


def in_flow(value: Any) -> str:
    """A value, however nested, on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{scalar(k)}: {in_flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(scalar, value)) + "]"
    return scalar(value)


def scalar(value: Any) -> str:
    """Text, a number or nothing, in quotes where it would be read as something else."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.10g}"
    if (
        isinstance(value, str)
        and not (
            (PLAIN.match(value) or re.fullmatch(r"[+-][xyz]", value)) and value.lower() not in WORDS
        )
        and value not in ("m/s2", "rad/s", "deg/s", "by hand", "not known")
    ):
        return json.dumps(value, ensure_ascii=False)
    return str(value)
