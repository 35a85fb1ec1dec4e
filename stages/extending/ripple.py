"""What a ripple of the table explains of the full-rate residuals of the turns."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from stages.estimation.steady_turns import SteadyTurn
from stages.extending.folds import fold, snr_squared
from stages.extending.gain import best_of, row_of
from stages.inference.least_squares import Reduced

Row = dict[str, Any]

ORDERS = {"table_eccentricity": 1.0}  # the order of an effect that has none to scan


def gain_of_ripple(
    turns: Sequence[SteadyTurn], effect: str, values: dict[str, float], mount: str
) -> Iterator[Row]:
    """What one sine and one cosine of the table's angle explain about its axis, in all turns.

    Bias and slope are each turn's own, and the noise is white. Held-out: each turn with the ripple
    of the others; only the order is that of all. `values`: of the effect's parameters, with n.
    """
    order = ORDERS.get(effect, values.get("n"))
    courses = {t.name: t.course(t.about) for t in turns if np.isfinite(t.rate)}
    if order is None or not courses:
        return
    said = {name: course.says(order) for name, course in courses.items()}
    squares = {n: float(np.sum(c.rest**2)) / c.sigma**2 for n, c in courses.items()}
    degrees = {n: len(c.record) - c.slow.shape[1] for n, c in courses.items()}

    def told(names: Sequence[str]) -> Reduced:
        return Reduced(
            ("a", "b"),
            sum((said[name][0] for name in names), np.zeros((2, 2))),
            sum((said[name][1] for name in names), np.zeros(2)),
            sum(squares[name] for name in names),
            sum(degrees[name] for name in names),
        )

    whole = told(list(said))
    folds = [fold([name], whole, told([o for o in said if o != name])) for name in said]
    counted = [one for one in folds if one.counts]
    shared = {"sensor": "gyro", "mount": mount, "effects": effect}
    fitted = float(best_of(whole) @ whole.right)
    yield (
        shared
        | row_of("fitted", whole.chi_squared, fitted, whole.degrees)
        | {"snr_squared": snr_squared(whole)}
    )
    names = [name for one in counted for name in one.manoeuvres]
    foretold = told(names)
    drop = sum(one.drop for one in counted)
    yield (
        shared
        | row_of("held-out", foretold.chi_squared, drop, foretold.degrees)
        | {
            "snr_squared": sum(one.at_stake for one in counted),
            "folds": len(folds),
            "counted": len(counted),
            "taken_away": ", ".join(names),
            "left_out": ", ".join(name for name in said if name not in names),
        }
    )
