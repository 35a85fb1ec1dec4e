"""The motion of the table in each rate segment, from its gyro and its whole angle."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pandas as pd

from inertial.arrays import Array, Booleans, nearest_axis
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import position_of
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Manoeuvre
from inertial.campaign.sample_stretches import Samples
from inertial.campaign.solution import joint_rows
from inertial.estimation.encoder_angle import corrected
from inertial.estimation.gyroscope_formulas import paired
from inertial.estimation.periodic_in_time import strongest
from inertial.estimation.time_angle import (
    Errors,
    TimeAngle,
    ripple_angle,
    ripple_window,
    time_angle,
)
from inertial.estimation.triad import linear_names, triad_of_errors
from inertial.physics.forward import Triad, measured_angles
from inertial.physics.motion import cross
from inertial.tables import AXES, GYRO
from inertial.text.messages import _

# ---- Rotations recorded whole, sample by sample: gyro increments, and the angle of the table.

UNKNOWN_CROSS = 0.01  # rad, half a degree: assumed for a cross term that is not determined
MIN_LINE_HZ = 2.0  # Hz, above which a line is an oscillation; slower is the motion of the table
MAX_LINE_P = 1e-4  # chance below which it is significant
MAX_UNLIKE = 0.02  # relative, by which the angles of a pair by the encoder may differ
MAX_DELAY_STEPS = 0.5  # of a step by which a sample may be late; more, and one is missing


@dataclass(frozen=True)
class Gyros:
    """The joint result of one mount: M and bias, with the terms that are not determined.

    `sigma`: (3,), rad/s, of the biases, infinite where there is none; `unknown`: (3, 3), which
    cross terms are not determined.
    """

    triad: Triad
    sigma: Array
    unknown: Booleans

    @property
    def remaining_cross(self) -> Array:
        """Size of the cross terms of each gyro that remain after correction by M, (3,)."""
        return np.asarray(UNKNOWN_CROSS * np.sqrt(self.unknown.sum(axis=1)))

    def cross(self, i: int) -> float:
        """Size of the cross terms of a gyro as it reads."""
        terms = np.where(self.unknown, UNKNOWN_CROSS, self.triad.matrix)[i]
        return float(np.linalg.norm(np.delete(terms, i)))

    def along(self, about: Array) -> float:
        """Sigma of the bias along an axis, rad/s."""
        finite = about != 0
        return float(np.linalg.norm(about[finite] * self.sigma[finite]))


def gyros_of(parameters: pd.DataFrame, mount: str) -> Gyros:
    """The joint result of a mount, by the table of parameters."""
    rows = {row["parameter"]: row for row in joint_rows(parameters, mount)}
    names = linear_names()
    determined = {n: rows[n] for n in names if n in rows and rows[n]["value"] is not None}
    values = [determined[n]["value"] if n in determined else 0.0 for n in names]
    sigma = [determined[n]["sigma"] if n in determined else np.inf for n in names]
    unknown = np.array([n not in determined for n in names[:9]]).reshape(3, 3)
    unknown &= ~np.eye(3, dtype=bool)
    return Gyros(triad_of_errors(values), np.array(sigma[9:], dtype=np.float64), unknown)


class Ringing(NamedTuple):
    """An oscillation of a gyro reading: rad/s, corrected for the averaging of a sample, and Hz."""

    amplitude: float
    frequency: float


@dataclass(frozen=True)
class WholeMotion:
    """One turn from the first motion to the last.

    `increments`: (n, 3), rad, of the gyros; `first`, `after`: edges of the steady part; `angle`:
    the table's angle at the edges; `lines`: (3,) oscillations of the gyros, None where none;
    `encoder`: (n + 1,), rad, about the manoeuvre's axis, by the encoder less its harmonics; None
    where it is not recorded. Its latency counts as none: in a steady part it shifts both ends of a
    window alike.
    """

    recorded: Rotation
    step: float
    increments: Array
    first: int
    after: int
    table: TimeAngle
    lines: Sequence[Ringing | None]
    encoder: Array | None = None

    @property
    def plan(self) -> Manoeuvre:
        """The manoeuvre."""
        return self.recorded.plan

    @cached_property
    def signed(self) -> Array:
        """The angle about the manoeuvre's axis at the edges, (n + 1,), rad."""
        assert self.plan.angle is not None
        return self.table.angle * float(np.sign(self.plan.angle))

    def ripple(self, gyro: int, seconds: Array | None) -> Array:
        """Rms angle that an oscillation leaves of a gyro in windows of `seconds`, rad.

        Without `seconds` the window ends at any phase.
        """
        line = self.lines[gyro]
        if line is None:
            return np.zeros(())
        if seconds is None:
            return np.asarray(ripple_angle(line.amplitude, line.frequency))
        return ripple_window(line.amplitude, line.frequency, seconds)


def steady_times(rotation: Rotation, segments: pd.DataFrame) -> tuple[float, float]:
    """Times of the first and the last sample of the steady part, s."""
    rows = segments[(segments["manoeuvre"] == rotation.plan.name) & (segments["phase"] == "steady")]
    return float(rows["from_s"].min()), float(rows["to_s"].max())


def exclusion_reason(rotation: Rotation) -> str:
    """Why a turn is not studied; empty where it is."""
    if rotation.refusal:
        return rotation.refusal
    if rotation.plan.up is None:
        return _("which way is up is not known")
    if rotation.plan.recorded != "whole":
        return _("only its steady part was planned, so no whole angle ties it")
    if not rotation.done.complete:
        return rotation.done.sentence
    return "" if rotation.blocks.steady.any() else _("it has no steady part")


def motion_of(
    data: CampaignData,
    rotation: Rotation,
    samples: Samples,
    steady: tuple[float, float],
    gyros: Gyros,
    scatter: float,
    harmonics: Mapping[int, tuple[float, float]],
) -> WholeMotion | str:
    """A turn, or why there is none.

    Parameters
    ----------
    steady : s, time of the first and of the last sample of the steady part
    scatter : rad/s, between manoeuvres, that the joint fit allows for
    harmonics : of the encoder's error, sine and cosine, rad, by order
    """
    m, step = rotation.plan, data.clocks[rotation.plan.log].step
    assert m.up is not None and m.angle is not None and m.angle_sigma is not None  # else refused
    rates, time = samples.values[:, 3:], samples.time
    finite = np.isfinite(rates) | ~np.isfinite(rates).any(axis=0)
    kept = finite.all(axis=1)
    rates, time, encoder = rates[kept], time[kept], samples.table_angle[kept]
    even = np.abs(np.diff(time) / step - 1) < MAX_DELAY_STEPS
    about = m.axis
    if not even.all() or len(time) < 2:
        return _("its samples do not follow each other step by step")
    if not np.isfinite(rates[:, about != 0]).all() or not np.isfinite(gyros.along(about)):
        return _("the gyro along its axis is not recorded, or has no bias ({name})", name=m.name)
    increments = rates * step
    first = int(np.argmin(np.abs(time - steady[0])))
    after = int(np.argmin(np.abs(time - steady[1]))) + 1

    earth = data.earth
    north = position_of(m, data.heading).north
    horizontal = float(np.linalg.norm(cross(m.up, about)))  # 0 where the axis is upright
    measured = measured_angles(
        increments,
        np.full(len(time), step),
        about,
        earth.up * m.up + (0.0 if north is None else earth.level * north),
        gyros.triad,
        lambda angle: np.asarray(np.cumsum(angle) - angle / 2),
    )
    lines = [_line(increments[first:after, i], step) for i in range(3)]
    unknown_level = 0.0 if north is not None else earth.level * horizontal / np.sqrt(2)
    density = (about * data.noise.of(m.name, "steady", GYRO))[about != 0]
    ringing = lines[nearest_axis(about)]
    offset = [gyros.along(about), scatter, earth.up_sigma * float(about @ m.up), unknown_level]
    if not np.isfinite(density).all():
        return _("its white noise is not known")
    errors = Errors(
        density=float(np.linalg.norm(density)),
        offset=float(np.linalg.norm(np.array(offset))),
        whole=m.angle_sigma,
        level=float(np.abs(about) @ gyros.remaining_cross) * earth.level / np.sqrt(2),
        ripple=0.0 if ringing is None else ripple_angle(*ringing) / np.sqrt(2),
    )
    angle = np.sign(m.angle) * measured
    return WholeMotion(
        rotation,
        step,
        increments,
        first,
        after,
        time_angle(angle, step, abs(m.angle), errors),
        lines,
        _encoder(corrected(encoder, harmonics), float(np.sign(m.angle))),
    )


def _encoder(read: Array, sense: float) -> Array | None:
    """The angle of the encoder at the edges of n samples, (n + 1,), growing with the turn's."""
    if not np.isfinite(read).all():
        return None
    edges = np.append(read[0], read)
    return np.asarray(sense * np.sign((read[-1] - read[0]) or 1.0) * edges)


def _line(increments: Array, step: float) -> Ringing | None:
    """The significant oscillation in the steady part of a gyro.

    A sample is the mean over its interval, which lessens a line by sin(πfT)/(πfT); with that
    undone, its angle is A/(2πf), for an alias as well.
    """
    if not np.isfinite(increments).all():
        return None
    line = strongest(increments / step, 1 / step, MIN_LINE_HZ)
    if line is None or line.p_value > MAX_LINE_P:
        return None
    return Ringing(line.amplitude / float(np.sinc(line.frequency * step)), line.frequency)


def axis_of(m: Manoeuvre) -> int | None:
    """The body axis that a turn is about while it points up or down; none where there is none."""
    for i in range(len(AXES)):
        if m.up is not None and min(abs(float(m.up[i])), abs(float(m.axis[i]))) > 1 - 1e-9:
            return i
    return None


def pairs_of(motions: Mapping[str, WholeMotion]) -> list[tuple[int, WholeMotion, WholeMotion]]:
    """Turns forward, each with one backward: same axis, same end up, same angle, same rate.

    Forward and backward are about the body axis, whose number comes first.
    """
    forward: list[tuple[int, WholeMotion]] = []
    backward: list[tuple[int, WholeMotion]] = []
    for motion in motions.values():
        i = axis_of(motion.plan)
        if i is None or motion.plan.rate is None or motion.plan.angle is None:
            continue
        way = forward if motion.plan.angle * motion.plan.axis[i] > 0 else backward
        way.append((i, motion))
    pairs = paired(forward, backward, lambda a, b: a[0] == b[0] and _same(a[1], b[1], a[0]))
    return [(i, motion, back) for (i, motion), (_, back) in pairs]


def _same(first: WholeMotion, second: WholeMotion, i: int) -> bool:
    """Whether two turns about body axis i are alike but for their direction."""
    ups = [motion.plan.up for motion in (first, second)]
    if ups[0] is None or ups[1] is None or ups[0][i] * ups[1][i] < 0:
        return False
    sizes, others = (np.array([abs(m.plan.rate or 0.0), m.step]) for m in (first, second))
    one, other = (abs(m.plan.angle or 0.0) for m in (first, second))
    # By the encoder each has its own angle.
    unlike = MAX_UNLIKE if first.encoder is not None and second.encoder is not None else 1e-6
    alike = bool(np.isclose(one, other, rtol=unlike))
    return alike and bool(np.allclose(sizes, others, rtol=1e-6))
