"""The page of the drawn diagnoses, docs/diagnosis.md."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import chain
import jinja2
import numpy as np
from diagnosis_bars import bars, good, of, pulls, shares
from diagnosis_left import left
from diagnosis_outcomes import Outcome

PAGE = chain.ROOT / "docs/diagnosis.md"
TEMPLATE = Path(__file__).parent / "diagnosis.md.jinja"
SENSORS = ("accel", "gyro")

Row = Sequence[str]


def write(outcomes: Sequence[Outcome], page: Path = PAGE) -> str:
    """Write the page; the bars as text for the terminal."""
    told = list(bars(outcomes))
    figures = {
        "campaigns": len(outcomes),
        "code": ", ".join(sorted({one["code"] for one in outcomes})),
        "hours": f"{sum(one['seconds'] for one in outcomes) / 3600:.1f}",
        "bars": [(bar.words, bar.wanted, bar.measured, bar.verdict) for bar in told],
        "shares": list(shares(outcomes)),
        "left": list(left()),
        "effects": list(_by_size(of(outcomes, "effect"))),
        "faults": list(_by_size(of(outcomes, "fault"))),
        "absorbed": list(_by_size(of(outcomes, "absorbed"), sized=False)),
        "reported": list(_by_size(of(outcomes, "reported"))),
        "wrong": list(_wrong(outcomes)),
        "verdicts": list(_verdicts(outcomes)),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    return terminal(outcomes) + f"The page: {page}\n"


def terminal(outcomes: Sequence[Outcome]) -> str:
    """The demands, what is measured by size, and what is not right."""
    lines = [f"{bar.verdict.strip('*'):9} {bar.words}: {bar.measured}" for bar in bars(outcomes)]
    lines += [f"          {words}: {counts}" for words, counts in shares(outcomes)]
    lines += [" | ".join(row) for row in _wrong(outcomes)]
    return "".join(f"{line}\n" for line in lines)


def _by_size(outcomes: Sequence[Outcome], *, sized: bool = True) -> Iterator[Row]:
    """What was hidden, in which plan, and how many are right, by size."""
    for what, plan in sorted({(one["what"], one["plan"]) for one in outcomes}):
        own = [one for one in outcomes if (one["what"], one["plan"]) == (what, plan)]
        sizes = sorted({one["size"] for one in own if sized and one["size"] is not None})
        counts = [
            f"{sum(map(good, some))} of {len(some)}" + (f" at {size:g}" if size else "")
            for size in sizes or [None]
            for some in [[one for one in own if size in (None, one["size"])]]
        ]
        yield what, plan, ", ".join(counts)


def _wrong(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    """What is not right, one line each."""
    for one in outcomes:
        if one["part"] == "reported" or (good(one) and not one["flawed"]):
            continue
        hidden = " ".join([one["what"], *([f"{one['size']:g}"] if one["size"] else [])])
        if one.get("error"):
            yield one["part"], one["plan"], hidden, one["error"].replace("|", "/"), "", ""
            continue
        told = (", ".join(one[key]).replace("|", " or ") for key in ("missing", "extra", "flawed"))
        yield one["part"], one["plan"], hidden, *told


def _verdicts(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    """By part and verdict, how many sensors, and the errors of their parameters."""
    for part in dict.fromkeys(one["part"] for one in outcomes):
        own = [one for one in outcomes if one["part"] == part and "error" not in one]
        every = [one["verdicts"].get(sensor, "–") for one in own for sensor in SENSORS]
        counted = ", ".join(f"{verdict} {every.count(verdict)}" for verdict in sorted({*every}))
        errors = np.array(pulls(own))
        rms = f"{np.sqrt(np.mean(errors**2)):.3f}" if errors.size else "–"
        worst = f"{np.abs(errors).max():.1f}" if errors.size else "–"
        yield part, counted, rms, worst
