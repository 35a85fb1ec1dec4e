"""The runs of an alignment: the rest itself, and the turns and rests over which it is followed."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.measurement import Measurement
from inertial.campaign.records import Manoeuvre, Performed
from inertial.campaign.sample_stretches import Samples
from inertial.physics.motion import stretches
from inertial.tables import ACCEL, GYRO

BIN_S = 0.05  # s, over which readings are averaged: 4° at 80 °/s, of which a mean lacks 2·10⁻⁴
LEVEL = 0.5  # of up along an axis, below which the axis counts as level
ALIGNMENT, MODULATION = "alignment", "modulation"


@dataclass(frozen=True)
class Group:
    """An alignment, and the turns and rests that follow it in its log with the same end up."""

    alignment: Manoeuvre
    followed: Sequence[tuple[Manoeuvre, bool]]  # whether it is modulated


def groups(
    plan: Sequence[Manoeuvre], performed: Mapping[str, Performed], purposes: Mapping[str, str]
) -> Iterator[Group]:
    """The alignments of a plan that were recorded."""
    found = [m for m in plan if performed[m.name].found]
    for log in dict.fromkeys(m.log for m in found):
        own = [m for m in found if m.log == log]
        starts = [i for i, m in enumerate(own) if purposes.get(m.name) == ALIGNMENT]
        for start, end in pairwise([*starts, len(own)]):
            first = own[start]
            followed = [
                (m, purposes.get(m.name) == MODULATION)
                for m in own[start + 1 : end]
                if purposes.get(m.name) == MODULATION or m.do == "rest"
            ]
            yield Group(first, [each for each in followed if _alike(first, each[0])])


def _alike(first: Manoeuvre, other: Manoeuvre) -> bool:
    """Whether another manoeuvre has the same end up, and turns about it if it does."""
    if first.up is None or other.up is None or first.up @ other.up < 1 - 1e-9:
        return False
    return other.do == "rest" or abs(float(other.axis @ first.up)) > 1 - 1e-9


@dataclass(frozen=True)
class Run:
    """A manoeuvre in k short stretches.

    `force`, `rate`: (k, 3), means of the readings; `time` of the middle, `seconds`, `temperature`:
    (k,); `angle`, `speed`: (k,), of the table at the middle, rad and rad/s, by its encoder or else
    about up since the start; `end`: rad, the angle at its end; `density`: rad/√s and m/s/√s, white
    noise of a level gyro and of a level accelerometer.
    """

    manoeuvre: Manoeuvre
    force: Array
    rate: Array
    time: Array
    seconds: Array
    temperature: Array
    angle: Array
    speed: Array
    end: float
    encoder: bool
    density: tuple[float, float]

    def compensated(self, measurement: Measurement) -> "Run":
        """The same without the errors of the result; linear, so of means."""
        motion = stretches(self.time, self.seconds, self.temperature)
        force = measurement.force(self.force, motion)
        return replace(self, force=force, rate=measurement.rate(self.rate, motion, force))

    def mean(self, values: Array) -> Array:
        """The mean of force or rate over the run, (3,)."""
        return np.asarray(np.average(values, axis=0, weights=self.seconds))


def run_of(data: CampaignData, m: Manoeuvre, samples: Samples) -> Run | None:
    """A manoeuvre from its samples, without those in which a channel is masked.

    None where it has not all six channels for a tenth of a second, or their noise is not known.
    """
    assert m.up is not None  # the plan refuses an alignment without
    step = data.clocks[m.log].step
    kept = np.isfinite(samples.values).all(axis=1)
    values, time = samples.values[kept], samples.time[kept]
    length = max(round(BIN_S / step), 1)
    if len(values) < 2 * length:
        return None
    starts = np.arange(0, len(values) - length + 1, length)
    count = np.diff(starts, append=len(values))
    if np.isfinite(time).all():  # a gap lengthens the stretch in which it lies
        seconds = np.diff(time[starts], append=time[-1] + step)
    else:
        seconds = step * count
    recorded = samples.table_angle[kept]
    encoder = bool(np.isfinite(recorded).all())
    angle = recorded if encoder else _by_gyro(m, values[:, 3:], step)

    def means(of: Array) -> Array:
        return np.asarray((np.add.reduceat(of, starts).T / count).T)

    middle, turned = time[starts] + seconds / 2, means(angle)
    level = np.abs(m.up) < LEVEL
    density = tuple(
        float(np.sqrt(np.mean(data.noise.of(m.name, "rest", channels)[level] ** 2)))
        for channels in (GYRO, ACCEL)
    )
    if not np.isfinite(density).all():
        return None
    return Run(
        m,
        means(values[:, :3]),
        means(values[:, 3:]),
        middle,
        seconds,
        means(samples.temperature[kept]),
        turned,
        np.gradient(turned) / seconds if m.do == "turn" else np.zeros(len(turned)),
        float(angle[-1]),
        encoder,
        (density[0], density[1]),
    )


def _by_gyro(m: Manoeuvre, rates: Array, step: float) -> Array:
    """The angle about up since the start, (n,), rad, which ends at the known one of the turn.

    The gyro tells its course, the plan its size.
    """
    if m.do != "turn" or m.angle is None or m.up is None:
        return np.zeros(len(rates))
    bias = float(np.mean(rates[: max(round(1 / step), 1)] @ m.axis))
    course = np.cumsum(rates @ m.axis - bias)
    return np.asarray(np.sign(m.axis @ m.up) * m.angle * course / course[-1])


def since_alignment(alignment: Run, runs: Sequence[Run]) -> list[Run]:
    """The runs with the angle of the table about up since the alignment.

    By the encoder where it is recorded in all of them, its sense by the gyros; else each begins
    where the one before ended.
    """
    if alignment.encoder and all(run.encoder for run in runs):
        up = alignment.manoeuvre.up
        assert up is not None  # the plan refuses an alignment without
        sense = float(np.sign(sum(float(run.speed @ (run.rate @ up)) for run in runs))) or 1.0
        return [
            replace(run, angle=sense * (run.angle - alignment.end), speed=sense * run.speed)
            for run in runs
        ]
    start, result = 0.0, []
    for run in runs:
        first = run.angle[0] if run.encoder else 0.0
        result.append(replace(run, angle=start + run.angle - first))
        start += run.end - first
    return result
