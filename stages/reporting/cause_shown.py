"""What shows a cause: its parameters as a table, and a picture."""

from __future__ import annotations

from collections.abc import Iterator

from stages.reporting import before_after, effect_parameters, oscillation, ripple, structures
from stages.reporting.certainty import kind_of, name_of
from stages.reporting.criticised import Criticised
from stages.reporting.mounts import mount_of
from stages.reporting.outline import Figure, Table
from stages.reporting.rows import Record, records

OSCILLATION = "oscillation"
LINES = frozenset({OSCILLATION, "table_ripple", "table_eccentricity"})  # heard in turns


def parameters(row: Record, model: Criticised) -> Iterator[Table]:
    """Its parameters; of a walk none, for its only number is in the sentence."""
    one = model.effect(row)
    known = one.parameters if one else ()
    if not any(each["value"] is not None for each in known):
        known = tuple(effect_parameters.told(row["parameters"], known))
    if known and kind_of(row) != "walk":
        yield effect_parameters.table(name_of(row), known)


def residuals(row: Record, key: str, model: Criticised) -> Figure | None:
    """What is left of its sensor, manoeuvre by manoeuvre; none of what is heard in turns."""
    if row["cause"] in LINES:
        return None
    plan = records(model.manoeuvres)
    return before_after.figure(row, mount_of(row["id"]), model.left, plan, model.gain, key)


def own(row: Record, key: str, model: Criticised) -> Iterator[Figure]:
    """What shows this one alone: an oscillation over time or angle, or a structure."""
    one = model.effect(row) if row["cause"] in LINES else None
    if one and row["cause"] == OSCILLATION:
        turns = model.simulated, model.lines, model.manoeuvres
        if ringing := oscillation.figure(*turns, row["cause"], key):
            yield ringing
    elif one:
        orders = [each["value"] for each in one.parameters if each["parameter"] == "n"]
        order = next((value for value in orders if value is not None), 1.0)
        if rippling := ripple.figure(model.simulated, records(model.manoeuvres), order, key):
            yield rippling
    if kind_of(row) == "structure":
        mount = mount_of(row["id"])
        yield from structures.figures(row, mount, model.structures, model.points, key)
