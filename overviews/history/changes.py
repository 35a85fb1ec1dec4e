"""What changed from one calibration of an IMU to the next, by more than chance."""

from __future__ import annotations

from dataclasses import dataclass
from math import hypot

from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.sensors import PLURAL
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.parameters import sign_of
from overviews.units import Imu
from stages.history.repeatability import LEAST_OWN, Observed


@dataclass(frozen=True)
class Change:
    """A parameter in two calibrations: `difference`, second less first, with its sigma."""

    sensor: str
    parameter: str
    difference: float
    sigma: float

    @property
    def sigmas(self) -> float:
        """The difference in units of its sigma."""
        return self.difference / self.sigma


def change(before: Observed, after: Observed) -> tuple[float, float]:
    """The difference of two values and its sigma: an error of a reference of both is in neither."""
    own = [one.sigma**2 - sum(size**2 for size in one.shared.values()) for one in (before, after)]
    names = {*before.shared, *after.shared}
    shared = [after.shared.get(name, 0.0) - before.shared.get(name, 0.0) for name in names]
    sigma = hypot(*(max(variance, 0.0) ** 0.5 for variance in own), *shared)
    return after.value - before.value, max(sigma, LEAST_OWN * hypot(before.sigma, after.sigma))


def changes(imu: Imu, first: str, second: str) -> tuple[list[Change], int]:
    """What differs by more than chance between two campaigns, the largest first; of how many.

    Only parameters with one value in each: several mounts are not told apart.
    """
    both: list[Change] = []
    for (sensor, parameter), values in imu.series.items():
        of = [[one for one in values if one.campaign == name] for name in (first, second)]
        if [len(own) for own in of] == [1, 1]:
            both.append(Change(sensor, parameter, *change(of[0][0], of[1][0])))
    if not both:
        return [], 0
    chances = [normal_p_value(one.sigmas) for one in both]
    beyond = holm_rejections(chances, imu.level)
    changed = [one for one, is_beyond in zip(both, beyond, strict=True) if is_beyond]
    return sorted(changed, key=lambda one: -abs(one.sigmas)), len(both)


def in_words(changed: list[Change], count: int) -> str:
    """How many changed, and the one that did most."""
    if not count:
        return "—"
    if not changed:
        return _("none")
    most = changed[0]
    return _(
        "{changed} of {count}, most {parameter} of the {sensor}, by {sigmas} σ",
        changed=len(changed),
        count=count,
        parameter=sign_of(most.parameter),
        sensor=PLURAL[most.sensor],
        sigmas=numbers.fixed(abs(most.sigmas), 1),
    )
