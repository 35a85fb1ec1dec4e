"""What the sentence of a cause says of its consequences: one event that several stages see.

And, of an IMU that shifts in its fixture, to which of two mountings the cross-axis terms belong.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.hypotheses import (
    MOUNTINGS,
    OF_ATTITUDES,
    STEP_IN_TURN,
    TABLE_MOVING,
    Hypothesis,
)
from inertial.campaign.records import Row, clocks_of, rows_of
from inertial.campaign.where_causes_act import JUMP_IN_REST, JUMPS, RESTARTS
from inertial.sensors import PLURAL
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import MIXTURE
from stages.diagnosis.causes import Cause
from stages.diagnosis.sensor_results import SensorResult

MAX_TURNED_COSINE = 0.7  # of an attitude and the axis of a rotation that changes it
TIME_SIGMAS = 2.0  # of a time, before and after which a manoeuvre is

ONE_EVENT = _("It is one event with this: {sentence}")
AND_THIS = _("And with this: {sentence}")
OTHER_GAPS = _("The log has {count} gaps in all; after the others no bias is another.")
NO_MANOEUVRE_LACKS = _(
    "No manoeuvre of the plan lacks these samples, so none need be recorded again. Find what loses "
    "samples, such as a buffer, a cable or a disk."
)
BEFORE = _("The parameters of the {sensors} are those of the mounting before it.")
AFTER = _("The parameters of the {sensors} are those of the mounting after it.")
BETWEEN = _(
    "The cross-axis terms of the {sensors} are of neither mounting: {before} of their manoeuvres "
    "are before it and {after} after it."
)
UNKNOWN = _("To which of the two mountings the parameters of the {sensors} belong is not known.")


def with_consequences(row: Row, cause: Cause, sentences: Mapping[str, str]) -> Row:
    """The row of a cause, whose sentence says the sizes of one event once from each side.

    And of a gap between manoeuvres, of which the log alone does not tell that it is, the action.
    """
    if cause.main.cause == "gap" and not any(each.cause.manoeuvres for each in cause.members):
        row |= {"action": NO_MANOEUVRE_LACKS}
    # The gap last: it is where the others are.
    same = sorted(_same_event(cause), key=lambda each: each.cause == "gap")

    def said(number: int, each: Hypothesis) -> str:
        count = each.row["count"]
        if cause.main.cause in RESTARTS and each.cause == "gap" and count > cause.main.row["count"]:
            return OTHER_GAPS.format(count=count)  # that which is described may be one of these
        sentence = sentences.get(each.id) or each.row["sentence"]
        return (AND_THIS if number else ONE_EVENT).format(sentence=sentence)

    others = [said(number, each) for number, each in enumerate(same)]
    return {**row, "sentence": " ".join([row["sentence"], *others])}


def _same_event(cause: Cause) -> Iterator[Hypothesis]:
    for member in cause.members:
        for each in member.consequences:
            alike = {each.cause, cause.main.cause} in (JUMPS, RESTARTS)
            moved = cause.main.cause in MOUNTINGS and each.cause == TABLE_MOVING
            moved |= each.cause == JUMP_IN_REST and not cause.main.causes.isdisjoint(OF_ATTITUDES)
            gap = each.cause == "gap" and cause.main.cause in JUMPS | RESTARTS
            alike = alike or gap
            if each.id != cause.main.id and (alike or moved or each.cause == STEP_IN_TURN):
                yield each


@dataclass(frozen=True)
class Mountings:
    """Before and after a shift of the IMU in its fixture: manoeuvres with their times.

    sensor : of `results`, which has the twelve parameters of a sensor and a mount
    spans : by manoeuvre, s since the first sample of all logs; directions : by manoeuvre, up of a
    rest, or the axis of a turn, in the case
    """

    results: Sequence[SensorResult]
    spans: Mapping[str, tuple[float, float]]
    directions: Mapping[str, Array]
    turns: frozenset[str]

    def described(self, row: Row, cause: Cause, rotation: Array) -> Row:
        """The row of a cause, whose consequence says to which mounting the parameters belong.

        `rotation`: of the case, (3,), rad, zero about axes that do not show it.
        """
        if cause.main.cause not in MOUNTINGS:
            return row
        own = [each for each in self.results if cause.main.mount in ("", each.mount)]
        # Of a class that is mixed they are of no one mounting, and its spread is in the sigmas.
        alone = [result for result in own if result.chosen.method != MIXTURE]
        said = [self._of_sensor(result, cause, rotation) for result in alone]
        return row | {"consequence": " ".join([row["consequence"], *dict.fromkeys(said)])}

    def _of_sensor(self, result: SensorResult, cause: Cause, rotation: Array) -> str:
        """A sentence about one sensor."""
        sensors = PLURAL[result.sensor]
        if result.models(MOUNTINGS):  # the effect is what is there from then on
            return BEFORE.format(sensors=sensors)
        known = [one for one in (cause.main, *_same_event(cause)) if one.time is not None]
        at = min((one.time for one in known if one.time), key=lambda t: t[1], default=None)
        if at is None:
            return UNKNOWN.format(sensors=sensors)
        names = [name for name in self.spans if (name in self.turns) == (result.sensor == "gyro")]
        names = [name for name in names if self._is_turned(name, rotation)]
        before = sum(self.spans[name][1] < at[0] - TIME_SIGMAS * at[1] for name in names)
        after = sum(self.spans[name][0] > at[0] + TIME_SIGMAS * at[1] for name in names)
        if before and after:
            return BETWEEN.format(sensors=sensors, before=before, after=after)
        if before or after:
            return (BEFORE if before else AFTER).format(sensors=sensors)
        return UNKNOWN.format(sensors=sensors)

    def _is_turned(self, name: str, rotation: Array) -> bool:
        """Whether the rotation changes what is sensed in a manoeuvre by most of its angle."""
        size = float(np.linalg.norm(rotation))
        along = abs(float(self.directions[name] @ rotation))
        return not size or along < MAX_TURNED_COSINE * size


def mountings_of(
    results: Sequence[SensorResult],
    manoeuvres: pd.DataFrame,
    segments: pd.DataFrame,
    clocks: pd.DataFrame,
) -> Mountings:
    """From the plan, and what was recorded of it."""
    spans: dict[str, tuple[float, float]] = {}
    known = clocks_of(clocks)
    for row in rows_of(segments):
        if row["log"] in known and row["from_s"] is not None and row["to_s"] is not None:
            if row["manoeuvre"] in spans and "rest-" in row["phase"]:
                continue
            offset = known[row["log"]].offset
            first, last = row["from_s"] + offset, row["to_s"] + offset
            begun, ended = spans.get(row["manoeuvre"], (first, last))
            spans[row["manoeuvre"]] = min(begun, first), max(ended, last)
    plan = {row["manoeuvre"]: row for row in rows_of(manoeuvres)}
    turns = frozenset(name for name, row in plan.items() if row["do"] == "turn")
    directions = {}
    for name, row in plan.items():
        what = "about" if name in turns else "up"
        direction = [row[f"{what}_{axis}"] for axis in AXES]
        if name in spans and None not in direction:
            directions[name] = np.array(direction, dtype=np.float64)
    return Mountings(results, {n: spans[n] for n in directions}, directions, turns)


def rotations(effects: Sequence[Row], clear: float) -> dict[str, Array]:
    """By finding the rotation of the case that an effect has, (3,), rad, where it is clear."""
    found: dict[str, Array] = {}
    for row in effects:
        if row["finding"] and row["effect"] in MOUNTINGS and row["unit"] == "rad" and row["sigma"]:
            rotation = found.setdefault(row["finding"], np.zeros(3))
            if abs(row["value"]) > clear * row["sigma"]:
                rotation[AXES.index(row["parameter"][-1])] = row["value"]
    return found
