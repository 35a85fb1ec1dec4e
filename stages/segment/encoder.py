"""The angle of the table's encoder in place of the stated angles and rates of turns."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees, hypot

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.encoder import Jump, JumpsOver
from inertial.campaign.records import Manoeuvre
from inertial.campaign.static_positions import ENCODER
from inertial.physics.motion import component
from inertial.tables import GYRO, STATIC_PHASES
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant
from stages.segment.matching import Part

STEADY = "steady"  # the phase of a turn in which its rate does not change
MIN_JUMP_SIGMAS = 5.0  # of a difference of two angles, from which a jump counts


@dataclass(frozen=True)
class ByEncoder:
    """A turn as its encoder has it, and what the report says of that, empty without an encoder.

    `used`: whether its readings count; `on_record`: rad, by what it turned in the recorded motion
    where its own blocks hold no rest before or after it; that is the whole turn if all of the
    motion is recorded, with a rest of the plan before and after it.
    """

    manoeuvre: Manoeuvre
    remark: str = ""
    used: bool = True
    on_record: float | None = None

    @property
    def from_rest_to_rest(self) -> "ByEncoder":
        """The same of a turn that is recorded from a rest to a rest."""
        return self if self.on_record is None else _whole(self.manoeuvre, self.on_record)


def by_encoder(
    m: Manoeuvre, blocks: pd.DataFrame, angle_sigma: float, tolerance: float
) -> ByEncoder:
    """A turn with the angle, or of a steady part the rate, that the encoder reads.

    From the mean angle at rest before it to the one after; of a steady part from its beginning to
    its end; of a turn that is recorded in part, what it has turned by while it is recorded. The
    sigma of an angle stays the stated one of the table, which is that of its encoder. Readings that
    differ from the gyros' by more than `tolerance`, relative, belong to another axis or have
    another unit, and are not used. `blocks`: all of the turn; `angle_sigma`: of the table, rad.
    """
    steady = m.recorded == "steady"
    moving = blocks[~blocks["phase"].isin(STATIC_PHASES)]
    value = _rate(moving) if steady else _angle(blocks)
    in_part = not (steady or np.isfinite(value))
    value = _in_motion(moving) if in_part else value
    seconds = moving["seconds"].to_numpy(np.float64)
    about = component(moving[GYRO].to_numpy(np.float64), m.axis)
    read = float(np.nansum(about * seconds))
    if not np.isfinite(value) or read == 0:
        return ByEncoder(m, used=False)
    value = float(np.copysign(value, read))
    by_gyro = read / float(np.nansum(seconds)) if steady else read
    if (blocks["missing_s"] > 0).any() and m.angle is not None and not (steady or in_part):
        by_gyro = m.angle  # what the gyros lack lies in a gap
    if abs(value - by_gyro) > tolerance * abs(by_gyro):
        return ByEncoder(
            m,
            _(
                "The encoder's {value}° contradict the gyros' {by_gyro}° and are not used.",
                value=significant(degrees(value), 4),
                by_gyro=significant(degrees(by_gyro), 4),
            ),
            used=False,
        )
    if in_part:
        angle = fixed(degrees(value), 4)
        remark = _("By the encoder it turned by {angle}° on record.", angle=angle)
        return ByEncoder(m, remark, on_record=value)
    if steady:
        sigma = np.sqrt(2) * angle_sigma / float(np.sum(seconds))
        return ByEncoder(
            replace(m, rate=value, rate_sigma=sigma),
            _("The rate is the encoder's, {rate} °/s.", rate=fixed(degrees(value), 5)),
        )
    return _whole(m, value)


def _whole(m: Manoeuvre, angle: float) -> ByEncoder:
    remark = _("The angle is the encoder's, {angle}°.", angle=fixed(degrees(angle), 4))
    return ByEncoder(replace(m, angle=angle), remark)


def _angle(blocks: pd.DataFrame) -> float:
    """The angle from rest to rest, rad; NaN where one of them is not recorded."""
    before, after = (
        _mean(blocks[blocks["phase"] == phase]) for phase in ("rest-before", "rest-after")
    )
    return after - before


def _mean(blocks: pd.DataFrame) -> float:
    angle, count = (blocks[name].to_numpy(np.float64) for name in ("table_angle", "count"))
    known = np.isfinite(angle) & (count > 0)
    return float(np.average(angle[known], weights=count[known])) if known.any() else np.nan


def _rate(moving: pd.DataFrame) -> float:
    """The rate of the steady part, rad/s."""
    own = moving[moving["phase"] == "steady"]
    if len(own) < 2:
        return np.nan
    start, end = own["angle_from"].iloc[0], own["angle_to"].iloc[-1]
    return float((end - start) / (own["seconds"].sum() + own["missing_s"].iloc[1:].sum()))


def _in_motion(moving: pd.DataFrame) -> float:
    """The angle of the recorded motion, rad; NaN where the encoder does not know all of it.

    From its beginning to its end, less what lies in gaps: the edges of blocks between them are
    fitted through few readings, which a jump of the encoder spoils.
    """
    begin, end = (moving[f"angle_{at}"].to_numpy(np.float64) for at in ("from", "to"))
    if not len(moving) or not np.isfinite([begin, end]).all():
        return np.nan
    hole = moving["missing_s"].to_numpy(np.float64)[1:] != 0
    return float(end[-1] - begin[0] - (begin[1:] - end[:-1])[hole].sum())


def without_unused(blocks: pd.DataFrame, turned: Mapping[str, ByEncoder]) -> pd.DataFrame:
    """The blocks without what the encoder reads in turns in which it is not used."""
    used = [name for name, turn in turned.items() if turn.used]
    return blocks.assign(
        **{name: blocks[name].where(blocks["manoeuvre"].isin(used)) for name in ENCODER}
    )


class EncoderJumps:
    """The jumps of the encoder in the steady part of each turn, added up batch by batch."""

    def __init__(
        self, parts: Sequence[Part], plan: Sequence[Manoeuvre], angle_sigma: float
    ) -> None:
        axes = {m.name: m.about for m in plan if m.do == "turn" and m.about is not None}
        steady = [part for part in parts if part.phase == STEADY and part.manoeuvre in axes]
        self._least = MIN_JUMP_SIGMAS * np.sqrt(2) * angle_sigma
        self._parts: dict[str, list[Part]] = {}
        for part in sorted(steady, key=lambda part: part.first):
            self._parts.setdefault(part.log, []).append(part)
        edges = {
            log: (np.array([p.first for p in own]), np.array([p.after for p in own]))
            for log, own in self._parts.items()
        }
        about: dict[str, Array] = {
            log: np.array([axes[p.manoeuvre] for p in own]) for log, own in self._parts.items()
        }
        self.sums = JumpsOver(edges, about)

    def result(self) -> dict[str, list[Jump]]:
        """By manoeuvre, of those that have any."""
        jumps: dict[str, list[Jump]] = {}
        for log, each in self.sums.result().items():
            for part, own in zip(self._parts[log], each, strict=True):
                if large := [jump for jump in own if abs(jump.size) > self._least]:
                    jumps.setdefault(part.manoeuvre, []).extend(large)
        return jumps

    def by_log(self) -> dict[str, list[Jump]]:
        """The same by log."""
        result, logs = self.result(), dict[str, list[Jump]]()
        for log, parts in self._parts.items():
            own = dict.fromkeys(part.manoeuvre for part in parts)
            logs[log] = [jump for name in own for jump in result.get(name, ())]
        return logs


def with_jumps(
    turned: Mapping[str, ByEncoder], jumps: Mapping[str, Sequence[Jump]]
) -> dict[str, ByEncoder]:
    """The turns whose angles are taken without jumps, with the sigmas of these."""
    made = dict(turned)
    for name, own in jumps.items():
        if name not in made:
            continue
        m = made[name].manoeuvre
        sigma = hypot(m.angle_sigma or 0.0, *(jump.sigma for jump in own))
        made[name] = replace(made[name], manoeuvre=replace(m, angle_sigma=sigma))
    return made


def plan_by_encoder(
    plan: Sequence[Manoeuvre], blocks: pd.DataFrame, angle_sigma: float, tolerance: float
) -> dict[str, ByEncoder]:
    """The turns of a plan of which the encoder was recorded, by name."""
    recorded = blocks[np.isfinite(blocks["table_angle"].to_numpy(np.float64))]["manoeuvre"]
    named = set(recorded)
    own = dict(list(blocks[blocks["manoeuvre"].isin(named)].groupby("manoeuvre")))
    turns = (m for m in plan if m.do == "turn" and m.name in own)
    return {m.name: by_encoder(m, own[m.name], angle_sigma, tolerance) for m in turns}
