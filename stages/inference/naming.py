"""Which effects the data ask for: one after another, as long as chance does not explain them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import reduce
from operator import add

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2
from scipy.stats import f as f_distribution

from stages.inference.least_squares import INCONSISTENT, Reduced

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Score:
    """An effect before the data: the drop of chi-squared that it brings, and its chance.

    `statistic` and `p_value` are beyond what was named before it; `named`: chosen at the
    family-wise level.
    """

    effect: str
    statistic: float
    degrees: int
    p_value: float
    named: bool


@dataclass(frozen=True)
class Evidence:
    """What each sensor says of the effects, and all together.

    `sensors`: independent equations about the same effects; `labels`: their names.
    """

    sensors: tuple[Reduced, ...]
    labels: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """The parameters of the effects."""
        return self.sensors[0].names if self.sensors else ()

    @property
    def total(self) -> Reduced:
        """All sensors together."""
        return reduce(add, self.sensors)

    def left_over(self, sensor: Reduced, chosen: Sequence[int]) -> tuple[float, int, float]:
        """What the chosen columns leave of a sensor: chi-squared, degrees, and its chance."""
        dropped, used = sensor.drop(chosen) if len(chosen) else (0.0, 0)
        rest, degrees = sensor.chi_squared - dropped, max(sensor.degrees - used, 1)
        return rest, degrees, float(chi2.sf(rest, degrees))

    def misfit(self, chosen: Sequence[int], of: Sequence[int]) -> tuple[float, int]:
        """By how much the residuals exceed the noise where the columns `of` are seen best.

        1 where the model with the chosen columns describes that sensor within its noise; else
        chi-squared per degree, and the degrees.
        """
        share = [float(np.trace(s.information[np.ix_(of, of)])) for s in self.sensors]
        sensor = self.sensors[int(np.argmax(share))]
        rest, degrees, p_value = self.left_over(sensor, chosen)
        return (1.0, degrees) if p_value >= INCONSISTENT else (rest / degrees, degrees)


def name(evidence: Evidence, columns: Mapping[str, Sequence[int]], level: float) -> list[Score]:
    """Name the effects that the data ask for, the most wanted first, then the others.

    Rao's score test of each effect, all other unknowns fitted; then again beside what was
    named, as long as the smallest p-value is below the level shared among the effects that
    are left (Holm). Where the residuals exceed the noise also with the effect, something
    else is wrong: there the effect must stand out of the residuals, not of the noise (F test),
    else any effect would be named that happens to lie along what is not understood.

    Parameters
    ----------
    columns : for each effect its columns in the evidence
    """
    if not evidence.sensors:
        return [Score(effect, 0.0, 0, 1.0, False) for effect in columns]
    total = evidence.total
    named: list[Score] = []
    taken: list[int] = []
    while True:
        base, base_degrees = total.drop(taken) if taken else (0.0, 0)
        left = [effect for effect in columns if effect not in {score.effect for score in named}]
        scores = []
        for effect in left:
            with_it = [*taken, *columns[effect]]
            whole, degrees = total.drop(with_it)
            more, statistic = degrees - base_degrees, max(whole - base, 0.0)
            p_value = 1.0
            if more > 0:
                excess, rest = evidence.misfit(with_it, columns[effect])
                p_value = float(chi2.sf(statistic, more))
                if excess > 1:
                    p_value = float(f_distribution.sf(statistic / more / excess, more, rest))
            scores.append(Score(effect, statistic, more, p_value, False))
        scores.sort(key=lambda score: (score.p_value, -score.statistic))
        if not scores or scores[0].p_value >= level / len(left):
            return [*named, *scores]
        best = scores[0]
        named.append(Score(best.effect, best.statistic, best.degrees, best.p_value, True))
        taken += columns[best.effect]
