"""The tables of a campaign as every section gets them: by name, with what made each."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import wraps
from typing import Any, TypeVar

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.records import Row, rows_of
from inertial.tables.parquet import Stream
from inertial.text.messages import _
from inertial.text.parameters import EXTENDED

Record = Row
Result = TypeVar("Result")


class Tables:
    """The tables by name, as frames, as rows or as streams, and what made each of them."""

    def __init__(
        self, tables: Mapping[str, Any], provenance: Mapping[str, Mapping[str, Any]]
    ) -> None:
        self._tables, self._provenance = tables, provenance
        self._rows: dict[str, list[Record]] = {}
        self._results: dict[Callable[[Tables], Any], Any] = {}

    def frame(self, name: str) -> pd.DataFrame:
        """A whole table."""
        frame: pd.DataFrame = self._tables[name]
        return frame

    def stream(self, name: str) -> Stream:
        """A table that is too long for memory, batch by batch."""
        stream: Stream = self._tables[name]
        return stream

    def rows(self, name: str) -> list[Record]:
        """The rows of a table as plain values, its gaps as None."""
        if name not in self._rows:
            self._rows[name] = rows_of(self.frame(name))
        return self._rows[name]

    def row(self, name: str) -> Record:
        """The single row of a table that has one; an empty table gives an empty row."""
        rows = self.rows(name)
        return rows[0] if rows else dict.fromkeys(map(str, self.frame(name).columns))

    def maker(self, name: str) -> Mapping[str, Any]:
        """What made a table, or a stage that makes none: stage, settings and code."""
        return self._provenance[name]

    def once(self, function: Callable[[Tables], Result]) -> Result:
        """The result of `function`, computed at its first use."""
        if function not in self._results:
            self._results[function] = function(self)
        result: Result = self._results[function]
        return result


def once(function: Callable[[Tables], Result]) -> Callable[[Tables], Result]:
    """What several sections need of the same tables, computed once for all of them."""

    @wraps(function)
    def cached(tables: Tables) -> Result:
        return tables.once(function)

    return cached


def arrays(rows: Sequence[Record], *keys: str) -> list[NDArray[np.float64]]:
    """Columns of rows of numbers, a gap as NaN."""
    return [np.array([row[key] for row in rows], np.float64) for key in keys]


# ---- Rows with what link tables list of them: members of a class, effects, manoeuvres.

CAUSE_TABLES = ("criticism_findings", "members", "cause_positions", "effects")
GAIN_TABLES = ("gain", "gain_effects", "held_out")
DECISION_TABLES = ("verdict", "candidate_effects")
OF_SENSOR = ("mount", "sensor")
OF_MODEL = (*OF_SENSOR, "model")


def _listed(rows: Sequence[Record], keys: Sequence[str], of: Sequence[object]) -> list[Record]:
    """The rows of a link table that belong to one row."""
    return [row for row in rows if [row[key] for key in keys] == list(of)]


@once
def effect_causes(tables: Tables) -> list[Record]:
    """The findings of criticism with members, parameters and positions."""
    members = sorted(tables.rows("members"), key=lambda row: int(row["rank"]))
    positions = sorted(tables.rows("cause_positions"), key=lambda row: int(row["rank"]))
    parameters = [row for row in tables.rows("effects") if row["value"] is not None]
    causes = []
    for row in tables.rows("criticism_findings"):
        of = [row["id"]]
        places = [one["position"] for one in _listed(positions, ["finding"], of)]
        causes.append(
            row
            | {
                "members": [one["effect"] for one in _listed(members, ["finding"], of)],
                "parameters": _listed(parameters, ["finding"], of),
                "manoeuvre": row["manoeuvre"] or _(" or ").join(places) or None,
            }
        )
    return causes


@once
def gains(tables: Tables) -> list[Record]:
    """The rows of the gain with the effects of the model and the manoeuvres not counted."""
    effects, held_out = tables.rows("gain_effects"), tables.rows("held_out")
    rows = []
    for row in tables.rows("gain"):
        of = [row[key] for key in OF_MODEL]
        predicted = [] if row["axis"] else _listed(held_out, OF_MODEL, of)
        rows.append(
            row
            | {
                "effects": [one["effect"] for one in _listed(effects, OF_MODEL, of)],
                "not_counted": [one["manoeuvre"] for one in predicted if not one["counted"]],
            }
        )
    return rows


@once
def decisions(tables: Tables) -> list[Record]:
    """The verdicts with the effects of the extended model."""
    effects = [row for row in tables.rows("candidate_effects") if row["method"] == EXTENDED]
    return [
        row
        | {
            "effects": [
                one["effect"]
                for one in _listed(effects, OF_SENSOR, [row[key] for key in OF_SENSOR])
            ]
        }
        for row in tables.rows("verdict")
    ]
