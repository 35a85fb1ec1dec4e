"""Which effects the data ask for: one after another, as long as chance does not explain them."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from scipy.stats import chi2
from scipy.stats import f as f_distribution

from stages.inference.naming.evidence import Evidence


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
