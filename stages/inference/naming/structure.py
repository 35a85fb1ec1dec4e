"""Whether the residuals of a refit still have a structure, whatever its cause.

Each test asks whether functions of something (time, angle, rate, attitude, temperature) would
explain the residuals. Residuals of a fit are not independent: if the model is right their
covariance is I − H, H the projection of the fit, and so the functions T are judged by
T'e ~ N(0, T'(I − H)T), Rao's score test. What the fit has absorbed already counts nothing.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from stages.inference.naming.chance import chance
from stages.inference.naming.scan import SEEN, Candidates
from stages.inference.naming.sought import sought
from stages.inference.naming.structure_columns import TESTS, Question
from stages.inference.tails import chi_squared_beyond, chi_squared_bound, ratio_beyond

Array = NDArray[np.float64]

LEVEL = 0.01  # accepted chance that any test fires where the model is right
DRAWS = 2000


@dataclass(frozen=True)
class Answer:
    """What the residuals of one sensor say of the functions of a question, on one of its axes.

    `kind`: of the test; `channel`: such as gyro x; `information`: T'(I − H)T, (k, k), zero of
    what was fitted; `right`: T'e, (k,); `chi_squared` of `degrees`: the residuals themselves;
    `noise_degrees`: from which their sigma was estimated.
    """

    kind: str
    channel: str
    question: Question
    information: Array
    right: Array
    chi_squared: float
    degrees: int
    noise_degrees: float = np.inf


@dataclass(frozen=True)
class Structure:
    """One test of structure.

    `kind`: time, angle, rate, attitude, temperature, or change; `channel` where it is clearest;
    `where`: the time of a change, the frequency of an oscillation, the order of a ripple, else
    NaN; `p_value`: its own search over channels and scan paid for; `fires`: at the level shared
    among all tests; `answer`, `group`: the functions that explain the residuals best.
    """

    kind: str
    channel: str
    where: float
    statistic: float
    degrees: int
    p_value: float
    possible: bool
    fires: bool
    answer: Answer | None = None
    group: int = 0

    @property
    def values(self) -> tuple[list[int], Array]:
        """The functions that explain the residuals best, and how much of each."""
        if self.answer is None:
            return [], np.zeros(0)
        chosen = self.answer.question.groups[self.group].tolist()
        block = self.answer.information[np.ix_(chosen, chosen)]
        return chosen, np.linalg.pinv(block, rcond=SEEN, hermitian=True) @ self.answer.right[chosen]


def structures(answers: Sequence[Answer], level: float = LEVEL, seed: int = 0) -> list[Structure]:
    """The six tests; together they fire in a share `level` of campaigns whose model is right."""
    found: dict[str, list[Structure]] = {kind: [] for kind in TESTS}
    for answer in answers:
        told = _tested(answer, seed)
        if told is not None:
            found[answer.kind].append(told)
    possible = sum(bool(some) for some in found.values())
    return [_together(kind, some, level / max(possible, 1)) for kind, some in found.items()]


def _together(kind: str, some: list[Structure], level: float) -> Structure:
    """The clearest of some answers, at a price for each of them."""
    if not some:
        return Structure(kind, "", np.nan, 0.0, 0, 1.0, False, False)
    best = min(some, key=lambda one: one.p_value)
    p_value = min(best.p_value * len(some), 1.0)
    return replace(best, p_value=p_value, fires=p_value < level)


def _tested(answer: Answer, seed: int) -> Structure | None:
    """The group of functions that explains most; none where all of them were fitted."""
    question = answer.question
    one = sought(answer.kind, *question.groups)
    drops, degrees = Candidates([one]).drops(answer.information, answer.right)
    if not degrees.any():
        return None
    best = int(np.argmax(drops))
    drop, count = float(drops[best]), int(degrees[best])
    alone = _alone(drop, count, answer)
    searched = min(alone * int(np.sum(degrees > 0)), 1.0)
    if len(question.groups) > 1 and not question.independent:
        law = chance(answer.information, [one], LEVEL, DRAWS, seed).tails[0]
        searched = float(law(chi_squared_bound(alone, law.degrees)))
    where = float(question.where[best])
    return Structure(
        answer.kind, answer.channel, where, drop, count, searched, True, False, answer, best
    )


def _alone(drop: float, count: int, answer: Answer) -> float:
    """Chance of such a drop, the sigma known beforehand and from what is left over."""
    if np.isinf(answer.noise_degrees):
        return float(chi_squared_beyond(drop, count))
    left = max(answer.degrees - count, 0)
    degrees = left + answer.noise_degrees
    rest = max(answer.chi_squared - drop, 0.0)
    # Residuals that are larger than the noise all over are no structure.
    variance = max((rest + answer.noise_degrees) / degrees, rest / left if left else 0.0)
    return float(ratio_beyond(drop / count / variance, count, degrees))
