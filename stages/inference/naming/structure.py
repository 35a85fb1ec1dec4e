"""Whether the residuals of a refit still have a structure, whatever its cause.

Each test asks whether functions of something (time, angle, rate, attitude, temperature) would
explain the residuals. Residuals of a fit are not independent: if the model is right their
covariance is I − H, H the projection of the fit, and so the functions T are judged by
T'e ~ N(0, T'(I − H)T), Rao's score test. What the fit has absorbed already counts nothing.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.stats import chi2
from scipy.stats import f as f_distribution

from stages.inference.naming.chance import chance
from stages.inference.naming.scan import SEEN, Candidates
from stages.inference.naming.sought import sought
from stages.inference.naming.structure_columns import TESTS, Question, Where

Array = NDArray[np.float64]
Integers = NDArray[np.int64]

LEVEL = 0.01  # accepted chance that any test fires where the model is right
DRAWS = 2000
FEWEST = 5  # readings of a channel that can have a structure


@dataclass(frozen=True)
class Residuals:
    """Residuals of a fit in units of their sigma, and where they were read.

    `values`: (n,), (observed − fitted)/sigma; `sigma`: (n,), in the unit of the readings;
    `channel`: (n,), which sensor axis; `design`: (n, p), columns of all that was fitted, in
    units of sigma; `prior_sigma`: (p,), in the unit of each parameter, infinite where nothing
    was known; `noise_degrees`: degrees of freedom from which sigma was estimated.
    """

    values: Array
    sigma: Array
    channel: Integers
    design: Array
    prior_sigma: Array
    read: Where
    noise_degrees: float = np.inf

    def where(self, rows: Integers) -> Where:
        """Where some rows were read."""
        r = self.read
        return Where(r.time[rows], r.angle[rows], r.rate[rows], r.up[rows], r.temperature[rows])

    def fitted_space(self) -> Array:
        """Q with H = QQ', (n, p)."""
        # What is known of a parameter is a reading of its own.
        stacked = np.vstack([self.design, np.diag(1 / self.prior_sigma)])
        size = np.sqrt(np.sum(stacked**2, axis=0))
        space, triangle = np.linalg.qr(stacked / np.where(size > 0, size, 1.0))
        turn, values, _ = np.linalg.svd(triangle)
        space = space @ turn[:, values > 1e-10 * values.max(initial=0.0)]
        return np.asarray(space[: len(self.values)])


@dataclass(frozen=True)
class Structure:
    """One test of structure.

    `kind`: time, angle, rate, attitude, temperature, or change; `channel` where it is clearest;
    `where`: the time of a change, the frequency of an oscillation, the order of a ripple, else
    NaN; `p_value`: its own search over channels and scan paid for; `fires`: at the level shared
    among all tests.
    """

    kind: str
    channel: int
    where: float
    statistic: float
    degrees: int
    p_value: float
    possible: bool
    fires: bool


def structures(fits: Sequence[Residuals], level: float = LEVEL, seed: int = 0) -> list[Structure]:
    """The six tests; together they fire in a share `level` of campaigns whose model is right.

    Parameters
    ----------
    fits : fits that have nothing in common, such as those of gyros and of accelerometers; each
        channel belongs to one of them
    """
    found: dict[str, list[Structure]] = {kind: [] for kind in TESTS}
    for fit in fits:
        space = fit.fitted_space()
        for channel in np.unique(fit.channel):
            rows = np.flatnonzero(fit.channel == channel)
            if len(rows) < FEWEST:
                continue
            one = Channel(fit, space, int(channel), rows)
            for kind, questions in TESTS.items():
                for question in questions(fit.where(rows)):
                    found[kind] += one.answers(kind, question, seed)
    possible = sum(bool(answers) for answers in found.values())
    return [_together(kind, answers, level / max(possible, 1)) for kind, answers in found.items()]


def _together(kind: str, answers: list[Structure], level: float) -> Structure:
    """The clearest of some answers, at a price for each of them."""
    if not answers:
        return Structure(kind, -1, np.nan, 0.0, 0, 1.0, False, False)
    best = min(answers, key=lambda answer: answer.p_value)
    p_value = min(best.p_value * len(answers), 1.0)
    return replace(best, p_value=p_value, fires=p_value < level)


@dataclass(frozen=True)
class Channel:
    """The residuals of one sensor axis, and the space of all that was fitted."""

    fit: Residuals
    space: Array
    number: int
    rows: Integers

    def answers(self, kind: str, question: Question, seed: int) -> Iterator[Structure]:
        """The answer to one question; none where its functions were all fitted."""
        functions = question.functions / self.fit.sigma[self.rows, None]
        values = self.fit.values[self.rows]
        own = self.space[self.rows]
        groups = question.groups
        law = None
        if question.independent:
            drops, degrees = _drops_of_each(functions, own, values, groups.shape)
        else:
            shadow = own.T @ functions
            information = functions.T @ functions - shadow.T @ shadow
            fitted = np.diag(information) < SEEN * np.sum(functions**2, axis=0)
            information[fitted] = 0.0
            information[:, fitted] = 0.0
            right = np.where(fitted, 0.0, functions.T @ values)
            one = sought(kind, *groups)
            drops, degrees = Candidates([one]).drops(information, right)
            if len(groups) > 1 and degrees.any():
                law = chance(information, [one], LEVEL, DRAWS, seed).tails[0]
        if not degrees.any():
            return
        best = int(np.argmax(drops))
        drop, count = float(drops[best]), int(degrees[best])
        left = len(self.rows) - float(np.sum(own**2)) - count
        alone = _alone(drop, count, float(values @ values) - drop, left, self.fit.noise_degrees)
        searched = min(alone * int(np.sum(degrees > 0)), 1.0)
        if law is not None:
            searched = float(law(chi2.isf(alone, law.degrees)))
        yield Structure(
            kind, self.number, float(question.where[best]), drop, count, searched, True, False
        )


def _alone(drop: float, count: int, rest: float, left: float, noise: float) -> float:
    """Chance of such a drop, the sigma known from `noise` degrees and from what is left over."""
    if np.isinf(noise):
        return float(chi2.sf(drop, count))
    degrees = max(left, 0.0) + noise
    variance = (max(rest, 0.0) + noise) / degrees
    return float(f_distribution.sf(drop / count / variance, count, degrees))


def _drops_of_each(
    functions: Array, own: Array, values: Array, shape: tuple[int, ...]
) -> tuple[Array, Integers]:
    """Drop and degrees of groups that stand one after the other, (g,), each on its own."""
    groups, width = shape
    size = np.sqrt(np.sum(functions**2, axis=0))
    unit = functions / np.where(size > 0, size, 1.0)
    each = unit.reshape(len(unit), groups, width).transpose(1, 0, 2)
    shade = (own.T @ unit).reshape(own.shape[1], groups, width).transpose(1, 0, 2)
    blocks = each.transpose(0, 2, 1) @ each - shade.transpose(0, 2, 1) @ shade
    eigenvalues, vectors = np.linalg.eigh(blocks)
    seen = eigenvalues > SEEN
    along = np.einsum("gij,gi->gj", vectors, (unit.T @ values).reshape(groups, width))
    drop = np.where(seen, along**2 / np.where(seen, eigenvalues, 1.0), 0.0)
    return drop.sum(axis=1), np.sum(seen, axis=1)
