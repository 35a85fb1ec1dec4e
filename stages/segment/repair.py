"""What is wrong with readings and plan as a whole, set right before blocks are made of them.

Each repair is decided once: by what explains clearly more of the plan than the recording as it
is, and than anything else. Where others explain as much, none is applied.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Manoeuvre, Row
from inertial.sensors import PLURAL
from inertial.signal.axis_permutations import AS_NAMED, Permutation, composed
from inertial.signal.detector import Given
from inertial.signal.gravity_turned import Turned
from inertial.signal.misread_axes import determinant
from inertial.signal.plan_detector import (
    Misread,
    Rescaled,
    Reversed,
    SpansOff,
    Undone,
)
from inertial.text.messages import _
from inertial.text.numbers import counted, significant
from stages.segment.located import AS_PLANNED
from stages.segment.recording_explanations import (
    ExplainedRecording,
    by_mounting,
    explained_of,
    in_order,
    misread_in,
    unlike,
)
from stages.segment.repair_readings import (
    axes_by_gravity,
    misread_by_gravity,
    rates_of,
    scales_of,
    step_of,
)
from stages.segment.reversed_parts import reversals, sign_changes
from stages.segment.stated_spans import marks_off, with_marks
from stages.segment.steps import (
    APPLIED,
    BY_GRAVITY,
    Step,
    at_other_rate,
    axes_in_words,
    axes_step,
    channel_row,
    count_size_step,
    exchange_in_words,
    exchange_step,
    exchanged_back,
    marks_in_words,
    place_of,
    row_of,
    sense_in_words,
    sense_step,
    spans_in_words,
    spans_step,
    turned_back,
    where,
)
from stages.segment.windows import Binned

MOUNTING = _("the IMU may be mounted turned against the plan, which reads the same")
UPENDED = _("or the IMU stood the other way up than planned wherever this axis was vertical")


@dataclass(frozen=True)
class Basis:
    """What the repairs rest on beside the recording.

    earth_rate : rad/s, its part upwards; given : of the campaign; counts : by sensor and log, m/s
    and rad, what a count is; logs : all of them; tolerance : of rates and angles, 1; refused:
    whether none is to be applied; accepted : ids of those that the laboratory confirms; heading :
    rad, azimuth of the table's zero mark, None where it is not known.
    """

    earth_rate: float
    given: Given
    counts: Mapping[str, Mapping[str, float]]
    logs: Sequence[str]
    tolerance: float
    refused: bool
    accepted: Collection[str]
    heading: float | None = None

    def state(self, step: Step, *, rival: bool = False) -> str:
        """Whether a repair is applied, confirmed, refused, or the rival of another."""
        if self.refused:
            return "refused"
        if step.id in self.accepted:
            return "confirmed"
        return "rival" if rival else "applied"


@dataclass(frozen=True)
class SetRight:
    """The campaign with its repairs: plan, where it is found, and what was set right.

    `level`: (3,), rad/s, the gyros at rest; `rows`: of the table of repairs, where `finding` is
    the id of the repair whose finding tells of it; `masks`: of that of masks, likewise.
    """

    plan: Sequence[Manoeuvre]
    level: Array
    explained: ExplainedRecording
    rows: Sequence[Row]
    channels: Sequence[Row]
    masks: Sequence[Row]
    undone: Undone


def set_right(
    binned: Sequence[Binned],
    plan: Sequence[Manoeuvre],
    basis: Basis,
    spans_off: Sequence[SpansOff] = (),
) -> SetRight:
    """Decide the repairs of a campaign, one kind after another, and apply them.

    `spans_off`: what was found of the stated spans; where it is applied, the plan has them moved.
    """
    campaign = _Campaign(list(binned), list(plan), basis)
    campaign.tell_spans(spans_off)
    campaign.set_counts()
    campaign.set_axes_and_names()
    campaign.set_axes_by_gravity()
    campaign.set_rates()
    campaign.set_marks()
    return campaign.result()


class _Campaign:
    """A campaign while it is set right."""

    def __init__(self, binned: list[Binned], plan: list[Manoeuvre], basis: Basis) -> None:
        self._binned, self._plan, self._basis = binned, plan, basis
        self._rows: list[Row] = []
        self._channels: list[Row] = []
        self._masks: list[Row] = []
        self._undone = Undone()
        self._by_gravity = False  # whether gravity shows the gyros to be as they are named
        self._gravity_turns = False  # whether it shows what they are named by at all
        self._explain()

    def _explain(self) -> None:
        self._level, self._explained = explained_of(
            self._binned, self._plan, self._basis.earth_rate
        )

    def result(self) -> SetRight:
        found = (self._plan, self._level, self._explained)
        return SetRight(*found, self._rows, self._channels, self._masks, self._undone)

    @property
    def _applied(self) -> set[str]:
        """The repairs that were applied so far."""
        return {row["id"] for row in self._rows if row["state"] in APPLIED}

    def _decide(
        self,
        step: Step,
        condition: str,
        fitting: tuple[int, int, int] | None = None,
        log: str = "",
        *,
        rival: bool = False,
        **more: Any,
    ) -> bool:
        """State a repair in the table, with `more` columns of it; whether it is applied."""
        state = self._basis.state(step, rival=rival)
        self._rows.append(row_of(step, state, condition, fitting, log) | more)
        return state in APPLIED

    def _logs(self, log: str) -> Sequence[str]:
        return [log] if log else self._basis.logs

    def _read_again(self, channels: Sequence[Row]) -> None:
        """Apply repairs of channels to the windows."""
        repairs = Repairs(tables.CHANNEL_REPAIRS.frame(channels))
        self._channels += channels
        for k, one in enumerate(self._binned):
            log, cut_off, unread = one.window.log, one.censored, one.unread
            six = repairs.readings(log, np.hstack([one.forces, one.rates]))
            if cut_off is not None:
                cut_off = repairs.channel_masks(log, cut_off)
            if unread is not None:
                unread = repairs.channel_masks(log, unread)
            self._binned[k] = replace(
                one,
                forces=six[:, :3],
                rates=six[:, 3:],
                censored=cut_off,
                unread=unread,
                quantum=np.abs(repairs.readings(log, one.quantum[None])[0]),
            )

    def _plan_again(self, plan: Sequence[Manoeuvre]) -> None:
        """Take another plan, whose manoeuvres may stand in other windows."""
        self._plan = list(plan)
        for k, one in enumerate(self._binned):
            place = place_of(one.window.manoeuvres[0])
            names = {m.name for m in one.window.manoeuvres}
            there = [m for m in plan if place_of(m) == place]
            # Two may be planned in one stretch: each has a window of its own.
            own = [m for m in there if m.name in names] or there
            self._binned[k] = replace(one, window=replace(one.window, manoeuvres=own))

    # ---- spans of the plan

    def tell_spans(self, off: Sequence[SpansOff]) -> None:
        """Spans by another clock than that of their log, which the plan has moved by now."""
        for each in off:
            step = spans_step(each.log)
            words = spans_in_words(each)
            self._decide(step, words, log=each.log, value=0.0, stated=each.late, unit="s")
            self._undone.spans_off.append(replace(each, repair=step.id))

    # ---- sizes of counts

    def set_counts(self) -> None:
        """Readings that are a known multiple of what they should be."""
        basis = self._basis
        channels: list[Row] = []
        for scale in scales_of(self._explained, self._level, basis.given, basis.counts):
            step = count_size_step(scale.sensor, scale.log)
            condition = _(
                "the {sensor} read {ratio} times what they should, {where}: {why}",
                sensor=PLURAL[scale.sensor],
                ratio=significant(scale.factor, 6),
                where=where(scale.log),
                why=scale.why,
            )
            by, rival = 1 / scale.factor, bool(scale.others)
            found = (scale.fitting, scale.log)
            if not self._decide(step, condition, *found, rival=rival, value=by, stated=1.0):
                continue
            channels += [
                channel_row(step.id, log, scale.sensor, axis, axis, by)
                for log in self._logs(scale.log)
                for axis in tables.AXES
            ]
            if scale.sensor == "gyro":
                names = [one.name for one in scale.seen]
                self._undone.rescaled.append(
                    Rescaled(scale.factor, scale.why, scale.log, names, step.id)
                )
        if channels:
            self._read_again(channels)
            self._explain()

    # ---- axes, signs, names and the sense of the table

    def set_axes_and_names(self) -> None:
        """What explains that the plan is not found as it is."""
        right, _after, total = self._explained.fitting
        if right == total and not self._explained.exchanged:
            return
        seen = axes_by_gravity(self._binned, self._level)
        self._gravity_turns = seen is not None and seen.axes is not None
        self._by_gravity = seen is not None and seen.axes == AS_NAMED
        explained = explained_of(
            self._binned,
            self._plan,
            self._basis.earth_rate,
            self._basis.accepted,
            with_sense=True,
            gyros_confirmed=self._by_gravity,
        )[1]
        first = len(self._rows)
        channels = [*self._axes_everywhere(explained), *self._axes_of_logs(explained)]
        plan = self._plan_as_found(explained)
        for taken, steps in explained.rivals.items():
            self._undone.rivals[taken] = [(step.id, self._in_words(step)) for step in steps]
            for step in steps:
                self._decide(step, self._in_words(step), rival=True, finding=taken)
        moved = any(a is not b for a, b in zip(plan, self._plan, strict=True))
        if channels or moved:
            self._read_again(channels)
            self._plan_again(plan)
            self._explain()
            right = sum(located.agreeing[0] for located in self._explained.located)
            for row in self._rows[first:]:
                if row["state"] in APPLIED:
                    row["fitting_after"] = right

    def _in_words(self, step: Step) -> str:
        """What would have to be true for a repair to be right."""
        if step.axes is not None and step.sensor is not None:
            return axes_in_words(Misread(step.sensor, step.axes, "", ()))
        if step.exchanged is not None:
            return exchange_in_words(in_order(step.exchanged, self._plan))
        assert step.turns is not None  # the last kind of step
        own = [m for m in self._plan if m.name in step.turns.names]
        return sense_in_words(step.turns, own)

    def _axes_everywhere(self, explained: ExplainedRecording) -> Iterator[Row]:
        """Axes that are others in all logs."""
        axes = explained.everywhere
        turned = by_mounting(explained)
        rivals = {
            sensor
            for sensor, own in unlike(axes, AS_PLANNED)
            if axes_step(sensor, own).id in explained.rivals
        }
        alike = axes.accel == axes.gyro
        both = alike and bool(rivals)
        for each in misread_in(self._plan, replace(explained, misread={})):
            step = axes_step(each.sensor, each.axes)
            condition = axes_in_words(each) + (f"; {MOUNTING}" if turned else "")
            if alike and not turned and each.axes.in_place and not self._gravity_turns:
                condition += f"; {UPENDED}"
            rival = turned or both or each.sensor in rivals
            logs = self._basis.logs
            if each.sensor == "gyro" and not rival:
                found = (self._plan, self._level, each.axes, self._basis.earth_rate)
                for change in sign_changes(explained.located, *found):
                    self._undone.changes[step.id] = change
                    logs = [] if change.parted or each.axes.moved > 1 else change.logs
            if not logs:
                continue  # it is both in one log: no repair of that is right
            if step.id in self._undone.changes:
                each = replace(each, change=self._undone.changes[step.id])
                condition = axes_in_words(each)
            if self._decide(step, condition, explained.fitting, rival=rival):
                self._undone.misread.append(replace(each, undone=True))
                yield from self._axes(step, each, each.axes, logs)

    def _axes_of_logs(self, explained: ExplainedRecording) -> Iterator[Row]:
        """Axes that are others in single logs."""
        for each in misread_in(self._plan, explained):
            if not each.log:
                continue
            step = axes_step(each.sensor, each.axes, each.log)
            own = explained.misread[each.log]
            turned = own.accel == own.gyro and determinant(own.accel) > 0
            common = getattr(explained.everywhere, each.sensor)
            unsure = common != AS_NAMED and axes_step(each.sensor, common).id not in self._applied
            condition = axes_in_words(each) + (f"; {MOUNTING}" if turned else "")
            if self._decide(step, condition, explained.fitting, each.log, rival=turned or unsure):
                self._undone.misread.append(replace(each, undone=True))
                logs = self._logs(each.log)
                yield from self._axes(step, each, composed(each.axes, common.inverse), logs)

    def _axes(
        self, step: Step, misread: Misread, axes: Permutation, logs: Sequence[str]
    ) -> Iterator[Row]:
        for log in logs:
            for i, axis in enumerate(tables.AXES):
                source, sign = tables.AXES[axes.sources[i]], float(axes.signs[i])
                yield channel_row(step.id, log, misread.sensor, axis, source, sign)

    def _plan_as_found(self, explained: ExplainedRecording) -> list[Manoeuvre]:
        """The plan with exchanged manoeuvres in their places, and turns the other way."""
        plan, fitting = list(self._plan), explained.fitting
        for exchanged in explained.exchanged:
            step, swapped = exchange_step(exchanged), in_order(exchanged, self._plan)
            place, rival = {"manoeuvre": swapped.names[0]}, step.id in explained.rivals
            if self._decide(step, exchange_in_words(swapped), fitting, rival=rival, **place):
                self._undone.swapped.append(replace(swapped, undone=True))
                plan = exchanged_back(plan, exchanged)
        for turns in explained.other_sense:
            step = sense_step(turns)
            why = self._in_words(step)
            if self._decide(step, why, fitting, rival=step.id in explained.rivals):
                told = (turns.about, why, self._by_gravity, turns.upended)
                self._undone.reversed.append(Reversed(step.id, turns.names, *told))
                plan = turned_back(plan, turns)
        return plan

    def set_axes_by_gravity(self) -> None:
        """Axes of one sensor that the other one contradicts, whatever the plan says."""
        others = (row["state"] for row in self._rows if row["repair"] != "count_size")
        if self._undone.changes or any(state not in APPLIED for state in others):
            return
        seen = axes_by_gravity(self._binned, self._level)
        if seen is None or self._in_part(seen):
            return
        found = misread_by_gravity(self._binned, seen)
        words = {each.repair: axes_in_words(each) for each in found}
        chosen = [each for each in found if each.repair in self._basis.accepted] or found
        channels: list[Row] = []
        for each in chosen:
            step = step_of(each)
            rows = list(self._axes(step, each, each.axes, self._logs(each.log)))
            fitting = self._fitting_with(rows)
            rival = len(chosen) > 1 or fitting[1] < fitting[0]
            if self._decide(step, words[step.id], fitting, rival=rival, finding=chosen[0].repair):
                channels += rows
        if chosen:
            rivals = [(other.repair, words[other.repair]) for other in chosen[1:]]
            self._undone.misread.append(replace(chosen[0], undone=bool(channels), rivals=rivals))
        if channels:
            self._read_again(channels)
            self._explain()

    def _fitting_with(self, channels: Sequence[Row]) -> tuple[int, int, int]:
        """How many observations agree with the plan, with a repair of channels too, and all."""
        now = (self._binned, self._channels, self._level, self._explained)
        before, _with_more, total = self._explained.fitting
        self._binned = list(self._binned)
        self._channels = list(self._channels)
        self._read_again(channels)
        self._explain()
        after = self._explained.fitting[0]
        self._binned, self._channels, self._level, self._explained = now
        return before, after, total

    def _in_part(self, seen: Turned) -> bool:
        """Whether gyros are reversed in a part: set right by logs, or left out within one."""
        earth = (self._basis.earth_rate, self._basis.heading)
        found = (self._explained.located, self._plan, self._level, seen, earth)
        channels: list[Row] = []
        parts = list(reversals(*found))
        for each in parts:
            step = axes_step("gyro", each.axes)
            step = replace(step, id=f"{step.id}/{BY_GRAVITY}/{tables.AXES[each.part.axis]}")
            misread = Misread("gyro", each.axes, "", (), step.id, spans=each.spans, part=each.part)
            undone = not each.part.parted and self._decide(step, axes_in_words(misread))
            if undone:
                channels += self._axes(step, misread, each.axes, each.part.logs)
            else:
                self._masks += [row | {"finding": step.id} for row in each.masks]
            self._undone.misread.append(replace(misread, undone=undone))
        if channels:
            self._read_again(channels)
            self._explain()
        return bool(parts)

    # ---- rates of the plan

    def set_rates(self) -> None:
        """Rates that the plan misstates, while the angles are as planned."""
        restated = rates_of(self._explained, self._level, self._basis.tolerance)
        if restated is None:
            return
        step = Step("stated_rate", "stated_rate", "gyro")
        number = len(restated.names)
        turns = [m for m in self._plan if m.do == "turn" and m.rate]
        condition = _(
            "the table turned at {ratio} times the planned rate in {turns}",
            ratio=significant(restated.ratio, 4),
            turns=counted(number, "turn"),
        )
        fitting = (len(turns) - number, len(turns), len(turns))
        if self._decide(step, condition, fitting, value=restated.ratio, stated=1.0):
            why = _("the plan states another rate than the table was set to")
            self._undone.restated.append(Rescaled(restated.ratio, why, "", restated.names, step.id))
            self._plan_again(at_other_rate(self._plan, restated.ratio, restated.names))
            self._explain()

    # ---- marks of the plan

    def set_marks(self) -> None:
        """Marks that the plan states, and its own turns contradict."""
        basis, step = self._basis, Step("stated_marks", "stated_marks", "gyro")
        found = (self._explained.located, self._plan, basis.heading, basis.earth_rate)
        off, marks = marks_off(*found)
        if off is None:
            return
        undone = self._decide(step, marks_in_words(off), rival=off.undecided)
        self._undone.marks_off.append(replace(off, repair=step.id, undone=undone))
        if undone:
            self._plan_again(with_marks(self._plan, marks))
            self._explain()
