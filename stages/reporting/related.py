"""Which findings speak of the same thing, so that each can refer to the other."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import combinations

from stages.reporting.rows import Record

MOST = 4  # others that a finding refers to
DRIFT = "temperature_drift"  # as the quality of the logs calls what goes with the temperature
TEMPERATURE = "/temperature/"  # in the identifiers of what criticism found in sweeps
POSITION = "table_position_error"  # what an effect of the accelerometers may have been taken for
NAMED = ("found", "one_of_class")
LINES = {"oscillation", "table_ripple", "table_eccentricity"}  # all are heard in turns
Span = tuple[float, float]


def related(rows: Sequence[Record], segments: Sequence[Record]) -> dict[str, list[Record]]:
    """For each finding, by its identifier, those of other stages that speak of the same thing.

    They have the same cause in the same sensor, or one may be what the other is; or what the one
    found lies, for at least half of its time, in the stretch of the same log that the other is
    about, or in its manoeuvre.
    """
    spans = {row["id"]: _span(row, segments) for row in rows}
    found: dict[str, list[Record]] = {}
    for one, other in combinations(rows, 2):
        same_log = one["log"] is not None and one["log"] == other["log"]
        same_place = same_log and _lies_in(spans[one["id"]], spans[other["id"]], one, other)
        same_cause = _same_sensor(one, other) and not _causes(one).isdisjoint(_causes(other))
        if _stage(one) != _stage(other) and (same_cause or same_place):
            found.setdefault(one["id"], []).append(other)
            found.setdefault(other["id"], []).append(one)
    return {identifier: others[:MOST] for identifier, others in found.items()}


def _same_sensor(one: Record, other: Record) -> bool:
    """A thermometer may drift for both sensors."""
    either = (one["sensor"], other["sensor"])
    return either[0] == either[1] or (None in either and DRIFT in (one["cause"], other["cause"]))


def _causes(row: Record) -> set[str]:
    """What a finding speaks of: its cause, those that it may be, and what both look like."""
    members = [name for name in (row.get("members") or "").split(", ") if name]
    found = {row["cause"], *members}
    if any(name.endswith("_temperature") for name in found) or TEMPERATURE in row["id"]:
        found.add(DRIFT)
    if row["sensor"] == "accel" and (row.get("verdict") or "") in NAMED:
        found.add(POSITION)
    return found | (LINES if found & LINES else set())


def _stage(row: Record) -> str:
    return str(row["id"]).partition("/")[0]


def _span(row: Record, segments: Sequence[Record]) -> Span | None:
    if row["from_s"] is not None:
        return row["from_s"], row["from_s"] if row["to_s"] is None else row["to_s"]
    own = [
        part
        for part in segments
        if part["manoeuvre"] == row["manoeuvre"]
        and part["log"] == row["log"]
        and part["from_s"] is not None
        and part["to_s"] is not None
    ]
    if not own:
        return None
    return min(part["from_s"] for part in own), max(part["to_s"] for part in own)


def _lies_in(a: Span | None, b: Span | None, one: Record, other: Record) -> bool:
    """Whether the one without a manoeuvre lies in the one with it; either way if both are alike."""
    if a is None or b is None:
        return False
    ways = [(a, b)] if other["manoeuvre"] else []
    ways += [(b, a)] if one["manoeuvre"] else []
    return any(_within(inner, outer) for inner, outer in ways or [(a, b), (b, a)])


def _within(inner: Span, outer: Span) -> bool:
    shared = min(inner[1], outer[1]) - max(inner[0], outer[0])
    return shared >= 0 and shared >= (inner[1] - inner[0]) / 2
