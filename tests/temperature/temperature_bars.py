"""What is demanded of curves of the temperature, what was measured, and whether it is met."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from hidden_bars import Bar, no_errors
from temperature_draws import REPORTED

MIN_RATIO = 8.0  # signal-to-noise ratio of the highest coefficient, from which shapes are judged
RMS, COVERAGE, RIGHT = (0.95, 1.05), (0.93, 0.97), 0.95
NORMAL_95 = 1.959964
BENT = ("2", "3", "knee")

Outcome = dict[str, Any]
Curve = dict[str, Any]


def curves_of(outcomes: Sequence[Outcome], plan: str = "") -> list[Curve]:
    """All parameters of all campaigns without an error, each with what its campaign says."""
    return [
        {**curve, "between": one["between"], "at": one["at"]}
        for one in outcomes
        if "error" not in one and plan in ("", one["plan"])
        for curve in one["curves"]
    ]


def clear(curves: Sequence[Curve]) -> list[Curve]:
    """Those that are curves at a ratio from which shapes are judged."""
    return [curve for curve in curves if curve["ratio"] >= MIN_RATIO]


def demanded(outcomes: Sequence[Outcome]) -> list[Curve]:
    """These in the plans that determine every curve."""
    return clear(curves_of([one for one in outcomes if one["plan"] != REPORTED]))


def constant(curves: Sequence[Curve]) -> list[Curve]:
    """Those that are none."""
    return [curve for curve in curves if curve["true"] == "0"]


def rms(curves: Sequence[Curve]) -> float:
    """Root mean square over the range of error by bound."""
    ratios = [np.divide(curve["error"], curve["bound"]) for curve in curves]
    return float(np.sqrt(np.nanmean(np.square(ratios)))) if np.isfinite(ratios).any() else np.nan


def attainable(curves: Sequence[Curve]) -> float:
    """The same of the ideal estimator, which knows how the curves were drawn."""
    ratios = [np.divide(curve["ideal"], curve["bound"]) for curve in curves if curve["ideal"]]
    return float(np.sqrt(np.mean(np.square(np.concatenate(ratios))))) if ratios else np.nan


def coverage(curves: Sequence[Curve]) -> float:
    """Share of temperatures between nodes at which the truth is within the 95 % interval."""
    inside = [
        np.abs(np.array(c["error"])[c["between"]]) <= NORMAL_95 * np.array(c["sigma"])[c["between"]]
        for c in given(curves)
    ]
    return float(np.mean(np.concatenate(inside))) if inside else np.nan


def given(curves: Sequence[Curve]) -> list[Curve]:
    """Those that have a result: a sensor that is not usable has none."""
    return [curve for curve in curves if np.isfinite(curve["error"]).all()]


def right(curves: Sequence[Curve]) -> int:
    """How many have the shape that was hidden."""
    return sum(curve["found"] == curve["true"] for curve in curves)


def straight(curves: Sequence[Curve]) -> list[Curve]:
    """The bends that are constant or a straight line in the result."""
    return [c for c in given(curves) if c["true"] in BENT and c["found"] in ("0", "1")]


def bars(outcomes: Sequence[Outcome]) -> Iterator[Bar]:
    """Every demand."""
    yield no_errors(outcomes)
    judged = demanded(outcomes)
    value = rms(judged)
    yield Bar(
        "rms over the range of error by bound",
        f"{RMS[0]} to {RMS[1]}",
        f"{value:.3f} of {len(given(judged))} curves",
        RMS[0] <= value <= RMS[1] if judged else None,
    )
    value = coverage(judged)
    yield Bar(
        "coverage of 95 % intervals between nodes",
        f"{COVERAGE[0]} to {COVERAGE[1]}",
        f"{value:.3f}",
        COVERAGE[0] <= value <= COVERAGE[1] if judged else None,
    )
    yield Bar(
        f"right order, or knee, at a ratio of {MIN_RATIO:g} or more",
        f"≥ {RIGHT}",
        f"{right(judged) / max(len(judged), 1):.3f} ({right(judged)} of {len(judged)})",
        right(judged) >= RIGHT * len(judged) if judged else None,
    )
    bent = [curve for curve in judged if curve["true"] in BENT]
    yield Bar(
        f"a straight line in place of a bend at a ratio of {MIN_RATIO:g} or more",
        "never",
        f"{len(straight(bent))} of {len(bent)}",
        not straight(bent) if bent else None,
    )
