"""An effect of the catalogue as the report has it: how it was judged, and its parameters."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from inertial.text import numbers
from inertial.text.cause_names import in_words
from stages.reporting.rows import Record, records

LABORATORY, SI = "Laboratory", "SI"  # heads of columns


@dataclass(frozen=True)
class Sought:
    """An effect of the catalogue: how it was judged, and its parameters."""

    score: Record
    parameters: tuple[Record, ...]
    mount: str  # of which mount, where there are several

    @property
    def name(self) -> str:
        """The effect in words."""
        mount = f" (mount {numbers.shortened(self.mount, 60)})" if self.mount else ""
        return in_words(self.score["effect"]) + mount

    @property
    def finding(self) -> str:
        """The identifier of the finding that names it."""
        mount = f"@{self.mount}" if self.mount else ""
        return f"criticism/{self.score['effect']}{mount}"


def sought(scores: pd.DataFrame, effects: pd.DataFrame) -> list[Sought]:
    """Every effect with its parameters; of several mounts each by itself, as they come."""
    groups: dict[str, dict[str, list[Record]]] = {}
    for row in records(effects):
        mount = row["id"].split("/")[1].partition("@")[2]
        groups.setdefault(row["effect"], {}).setdefault(mount, []).append(row)
    found = []
    for score in records(scores):
        mounts = groups.get(score["effect"], {})
        mount = next(iter(mounts), "")
        found.append(Sought(score, tuple(mounts.pop(mount, ())), mount))
    return found


def capital(text: str) -> str:
    """A sentence with its first letter large."""
    return text[:1].upper() + text[1:]
