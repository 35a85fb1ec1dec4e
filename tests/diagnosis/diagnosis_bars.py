"""What is demanded of the diagnosis, what was measured, and whether it is met."""

from collections.abc import Iterator, Sequence

import numpy as np
from diagnosis_draws import BETWEEN, CLEAN, PAIRS, RATIOS, SIGMAS
from diagnosis_outcomes import Outcome
from hidden_bars import Bar, no_errors

RIGHT = 0.97
BOTH = 54  # of PAIRS
ROWS = 6  # of CLEAN
MOST_SIGMA = 4.5
PULLS = (0.9, 1.1)


def bars(outcomes: Sequence[Outcome]) -> Iterator[Bar]:
    """Every demand."""
    yield no_errors(outcomes)
    every = [*of(outcomes, "effect"), *of(outcomes, "fault")]
    right = sum(map(good, every))
    yield Bar(
        "effects and faults of every size: exactly one row, the right one or its class",
        f"≥ {RIGHT}",
        _counts(right, len(every)),
        right >= RIGHT * len(every) if every else None,
    )
    silent = of(outcomes, "absorbed")
    quiet = [one for one in silent if not one.get("rows", 1)]
    yield Bar(
        "effects that every calibration absorbs: no row",
        "all",
        _counts(len(quiet), len(silent)),
        len(quiet) == len(silent) if silent else None,
    )
    pairs = of(outcomes, "pair")
    both = sum(good(one) for one in pairs)
    yield Bar(
        f"a fault, and an effect at SNR {BETWEEN[0]:g} to {BETWEEN[1]:g} in what it leaves:"
        " both, and nothing else",
        f"≥ {BOTH} of {PAIRS}",
        _counts(both, len(pairs)),
        both * PAIRS >= BOTH * len(pairs) if pairs else None,
    )
    clean = of(outcomes, "clean")
    loud = sum(one.get("rows", 1) > 0 for one in clean)
    yield Bar(
        "clean campaigns with a row",
        f"≤ {ROWS} of {CLEAN}",
        _counts(loud, len(clean)),
        loud * CLEAN <= ROWS * len(clean) if clean else None,
    )
    yield from _of_results(outcomes)


def shares(outcomes: Sequence[Outcome]) -> Iterator[tuple[str, str]]:
    """The same by size, in words and counts."""
    for ratio in RATIOS:
        yield f"effects at SNR {ratio:g}", _right(of(outcomes, "effect", ratio))
    faults = of(outcomes, "fault")
    for sigma in SIGMAS:
        own = [one for one in faults if one["size"] == sigma]
        yield f"faults that move a result by {sigma:g} sigma", _right(own)
    yield "faults without a size", _right([one for one in faults if one["size"] is None])


def of(outcomes: Sequence[Outcome], part: str, size: float | None = None) -> list[Outcome]:
    """The outcomes of a part, at one size where it is told."""
    return [o for o in outcomes if o["part"] == part and size in (None, o["size"])]


def good(one: Outcome) -> bool:
    """Whether exactly the right rows are there."""
    return not (one.get("error") or one["missing"] or one["extra"])


def pulls(outcomes: Sequence[Outcome]) -> list[float]:
    """All errors of the results that may be used, in sigma."""
    return [pull for one in outcomes for pull in one.get("pulls", {}).values()]


def _of_results(outcomes: Sequence[Outcome]) -> Iterator[Bar]:
    every = np.array(pulls(outcomes))
    far = [o for o in outcomes if any(abs(p) > MOST_SIGMA for p in o.get("pulls", {}).values())]
    worst = float(np.abs(every).max()) if every.size else np.nan
    yield Bar(
        "the 24 parameters where the verdict is not “not usable”",
        f"within {MOST_SIGMA} sigma",
        f"{len(far)} of {len(outcomes)} campaigns beyond, the worst {worst:.1f}",
        not far if every.size else None,
    )
    rms = float(np.sqrt(np.mean(every**2))) if every.size else np.nan
    yield Bar(
        "their errors in sigma, root mean square",
        "0.9 to 1.1",
        f"{rms:.3f} of {every.size}",
        PULLS[0] <= rms <= PULLS[1] if every.size else None,
    )


def _right(own: Sequence[Outcome]) -> str:
    return _counts(sum(map(good, own)), len(own))


def _counts(count: int, number: int) -> str:
    return f"{count / number:.3f} ({count} of {number})" if number else "–"
