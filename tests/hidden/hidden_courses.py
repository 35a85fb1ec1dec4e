"""What the laboratory adds to the readings, as an effect whose course is known but for its sizes.

Two recordings with the same noise, one with an effect and one without, differ by what the
laboratory's own physics make of it. Reduced to the blocks of a campaign, that is the signal which
is hidden.
"""

from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import numpy as np
from hidden_plans import PLANS, SPANS
from hidden_ways import WAYS, Way

import laboratory
from inertial.arrays import Array
from inertial.effects import CATALOGUE
from inertial.physics.effect import Effect, Parameter, Reading
from inertial.physics.motion import Motion
from laboratory import LogTruth, Recording

RATE = 20  # Hz, of these recordings: all plans move in steps of it, and integrals are exact
SCANNED = 3  # values of what an effect scans, evenly between the first and the last that is drawn


class Course(Effect):
    """Reading += Σ s_k times the k-th of p known courses.

    `gyro`, `accel`: integrals of the courses up to `time`, s: (n, 3, p), rad and m/s. A size s_k is
    1 in the recording from which its course was taken.
    """

    cause = "what the laboratory did"
    source = "the simulated laboratory"
    sizes: ClassVar[Mapping[str, float]] = {"usual": 1e12}

    def __init__(self, name: str, time: Array, gyro: Array, accel: Array) -> None:
        self.time, self.gyro, self.accel = time, gyro, accel
        self.name = name  # type: ignore[misc]  # two courses are two effects
        self.parameters = tuple(  # type: ignore[misc]
            Parameter(f"s{k}", "1", 1.0, "size") for k in range(gyro.shape[2])
        )

    def signature(self, motion: Motion) -> Reading:
        """The means over the stretches of a motion."""
        return Reading(self._means(self.gyro, motion), self._means(self.accel, motion))

    def _means(self, integral: Array, motion: Motion) -> Array:
        flat = integral.reshape(len(self.time), -1)
        half = motion.seconds / 2
        ends = [
            np.column_stack([np.interp(at, self.time, one) for one in flat.T])
            for at in (motion.time - half, motion.time + half)
        ]
        mean = (ends[1] - ends[0]) / motion.seconds[:, None]
        return np.asarray(mean.reshape(len(mean), *integral.shape[1:]))


def known_course(
    name: str,
    ones: Sequence[Recording],
    other: Recording,
    started: Mapping[str, float] | None = None,
) -> Course:
    """By what the sensors of recordings of one campaign read more than in another one.

    `started`: when the first sample of each log began, where the campaign has another rate, s.
    """
    times, gyros, accels = [], [], []
    reached = np.zeros((2, 3, len(ones)))
    for log, plain in other.truth.items():
        noisy = [one.truth[log].noisy for one in ones]
        gyro = np.stack([x.gyro - plain.noisy.gyro for x in noisy], axis=-1)
        accel = np.stack([x.accelerometer - plain.noisy.accelerometer for x in noisy], axis=-1)
        gyros += [reached[:1], reached[0] + gyro]
        accels += [reached[1:], reached[1] + accel]
        reached = np.stack([gyros[-1][-1], accels[-1][-1]])
        start = _start(plain)
        later = 0.0 if started is None else started[log] - start
        times += [np.array([start + later]), plain.time + later]
    return Course(name, *map(np.concatenate, (times, gyros, accels)))


def scanned(way: Way, plan: str) -> list[float | None]:
    """The values of what the laboratory is told to scan; one, None, where there is nothing."""
    if way.scan is None:
        return [None]
    scale = SPANS[plan] if way.share else 1.0
    return (scale * np.linspace(*way.scan[1:], SCANNED)).tolist()


def told(name: str, values: Array, at: float | None) -> dict[str, Any]:
    """What the laboratory is told of an effect with values in the model's units."""
    way = WAYS[name]
    return way.told(values) | ({} if way.scan is None else {way.scan[0]: at})


def _start(log: LogTruth) -> float:
    """When the interval of the first sample began, s."""
    return float(2 * log.time[0] - log.time[1])


def courses(plan: str, seed: int) -> dict[str, list[Course]]:
    """Of each effect that a plan shows one for each value of its scan, of typical sizes.

    The k-th size of a course is the k-th parameter of the model in its typical size. `seed`: of
    the campaign in which they are sought: azimuths that the plan does not state are drawn by it.
    """
    document = PLANS[plan](seed=seed)
    campaign = laboratory.perform(laboratory.specify(document))
    started = {log: _start(truth) for log, truth in campaign.truth.items()}
    document["receiver"]["rate_hz"] = RATE

    def recorded(effects: dict[str, Any]) -> Recording:
        return laboratory.perform(laboratory.specify(document | {"effects": effects}))

    plain = recorded({})
    found: dict[str, list[Course]] = {}
    for name, way in WAYS.items():
        if plan not in way.plans:
            continue
        units = np.diag([one.typical for one in CATALOGUE[name].parameters])
        found[name] = [
            known_course(
                f"{name} of the laboratory, {number}",
                [recorded({name: told(name, unit, at)}) for unit in units],
                plain,
                started,
            )
            for number, at in enumerate(scanned(way, plan))
        ]
    return found
