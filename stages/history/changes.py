"""What changed from one calibration of an IMU to the next, by more than chance."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import hypot

from inertial.campaign.records import Row
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.sensors import unit_of
from stages.history.repeatability import LEAST_OWN, Observed, Series


@dataclass(frozen=True)
class Change:
    """A parameter in two calibrations: `size`, second less first, with its sigma.

    `p_value`: chance of one so large, either way, if the two are equal; `beyond`: more than chance,
    of all parameters of the two (Holm 1979).
    """

    sensor: str
    quantity: str
    size: float
    sigma: float
    p_value: float
    beyond: bool


def change(before: Observed, after: Observed) -> tuple[float, float]:
    """The difference of two values and its sigma: an error of a reference of both is in neither."""
    own = [one.sigma**2 - sum(size**2 for size in one.shared.values()) for one in (before, after)]
    names = {*before.shared, *after.shared}
    shared = [after.shared.get(name, 0.0) - before.shared.get(name, 0.0) for name in names]
    sigma = hypot(*(max(variance, 0.0) ** 0.5 for variance in own), *shared)
    return after.value - before.value, max(sigma, LEAST_OWN * hypot(before.sigma, after.sigma))


def changes(series: Series, first: str, second: str, level: float) -> list[Change]:
    """All parameters with one value in each of two campaigns: several mounts are not told apart."""
    compared = []
    for key, values in series.items():
        of = [[one for one in values if one.campaign == name] for name in (first, second)]
        if [len(own) for own in of] == [1, 1]:
            size, sigma = change(of[0][0], of[1][0])
            compared.append((*key, size, sigma, normal_p_value(size / sigma)))
    if not compared:
        return []
    beyond = holm_rejections([one[-1] for one in compared], level)
    return [Change(*one, bool(is_beyond)) for one, is_beyond in zip(compared, beyond, strict=True)]


def change_rows(changed: list[Change], before: Row) -> Iterator[Row]:
    """The rows of the table of changes since the calibration `before`, its facts."""
    for one in changed:
        yield {
            "sensor": one.sensor,
            "quantity": one.quantity,
            "unit": unit_of(one.sensor, one.quantity),
            "since": before["date"],
            "since_campaign": before["campaign"],
            "size": one.size,
            "sigma": one.sigma,
            "p_value": one.p_value,
            "beyond": one.beyond,
        }
