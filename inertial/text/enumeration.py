"""Enumerations in a sentence."""

from __future__ import annotations

from collections.abc import Sequence

from inertial.text.messages import _


def listed(names: Sequence[str], last: str = "and") -> str:
    """Names as part of a sentence: a, b and c."""
    if len(names) < 2:
        return "".join(names)
    return _(", ").join(names[:-1]) + (_(" and ") if last == "and" else _(" or ")) + names[-1]
