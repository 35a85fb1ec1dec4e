"""Rows with what link tables list of them: members of a class, effects, manoeuvres."""

from __future__ import annotations

from collections.abc import Sequence

from inertial.text.messages import _
from inertial.text.parameters import EXTENDED
from stages.report.tables import Record, Tables, once

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
