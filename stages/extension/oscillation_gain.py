"""What modelling an oscillation gains."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.least_squares import Reduced
from inertial.estimation.periodic_in_time import without_line
from inertial.physics.forward import Triad
from stages.extension.folds import fold, snr_squared
from stages.extension.gain import best_of, row_of

# ---- What an oscillation explains of the full-rate residuals of the turns.

Array = NDArray[np.float64]
Row = dict[str, Any]


def gain_of_line(
    turns: Sequence[tuple[str, Array]],
    step_of: Mapping[str, float],
    frequency: float,
    gyro: Triad,
    mount: str,
) -> Iterator[Row]:
    """What it explains about its axis, the axis that is the loudest.

    Held-out: the frequency is that of all turns and the amplitude that of the other turns; only
    the phase is the turn's own, for nothing could foretell it.

    Parameters
    ----------
    turns : name and residuals of the gyros, (n, 3), rad/s; `step_of`: s, of a sample of each
    frequency : Hz
    """
    inverse = np.linalg.inv(gyro.matrix)
    truths = {name: residuals @ inverse.T for name, residuals in turns}
    if not truths:
        return
    spread = np.mean([truth.std(axis=0) for truth in truths.values()], axis=0)
    axis = int(np.argmax(spread))
    parts = {
        name: without_line(truth[:, axis], 1 / step_of[name], frequency)
        for name, truth in truths.items()
    }
    amplitudes = {name: part.amplitude for name, part in parts.items()}
    samples = sum(len(truth) for truth in truths.values())
    before = sum(float(np.sum(part.record**2)) for part in parts.values())
    for scope in ("fitted", "held-out"):
        after = 0.0
        for name, part in parts.items():
            rest = [a for other, a in amplitudes.items() if other != name]
            size = amplitudes[name] if scope == "fitted" or not rest else float(np.mean(rest))
            after += float(np.sum(part.less(size) ** 2))
        yield {
            "sensor": f"gyro {'xyz'[axis]}",
            "mount": mount,
            "effects": "oscillation",
            "scope": scope,
            "rows": samples,
            "before": before / samples,
            "after": after / samples,
            "drop": (before - after) / samples,
            "rms_before": float(np.sqrt(before / samples)),
            "rms_after": float(np.sqrt(after / samples)),
            "unit": "rad/s",
        }


# ---- What a ripple of the table explains of the full-rate residuals of the turns.

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
