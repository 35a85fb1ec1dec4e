"""The page of the drawn chamber campaigns, docs/temperature.md, and its figure."""

from collections import Counter
from collections.abc import Iterator, Sequence
from pathlib import Path

import chain
import jinja2
import numpy as np
from matplotlib.figure import Figure
from temperature_bars import (
    Outcome,
    attainable,
    bars,
    clear,
    constant,
    coverage,
    curves_of,
    demanded,
    given,
    right,
    rms,
    straight,
)
from temperature_draws import CURVES, PLANS, SHAPES

PAGE = chain.ROOT / "docs/temperature.md"
TEMPLATE = Path(__file__).parent / "temperature.md.jinja"
EXPECTED = ("accel_temperature", "gyro_temperature")
ICE_POINT = 273.15

Row = Sequence[str]


def write(outcomes: Sequence[Outcome], page: Path = PAGE) -> str:
    """Write the page; the bars as text for the terminal."""
    told = list(bars(outcomes))
    figures = {
        "campaigns": len(outcomes),
        "code": ", ".join(sorted({one["code"] for one in outcomes})),
        "hours": f"{sum(one['seconds'] for one in outcomes) / 3600:.1f}",
        "number": CURVES,
        "bars": [(bar.words, bar.wanted, bar.measured, bar.verdict) for bar in told],
        "attainable": f"{attainable(demanded(outcomes)):.3f}",
        "plans": list(_plans(outcomes)),
        "shapes": list(_shapes(outcomes)),
        "constants": list(_constants(outcomes)),
        "causes": list(_causes(outcomes)),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    picture(outcomes, page.with_suffix(".png"))
    lines = [f"{bar.verdict.strip('*'):9} {bar.words}: {bar.measured}\n" for bar in told]
    return "".join([*lines, f"The page: {page}\n"])


def _plans(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for plan in PLANS:
        own = clear(curves_of(outcomes, plan))
        count = sum(one["plan"] == plan for one in outcomes)
        measured = (f"{rms(own):.3f}", f"{attainable(own):.3f}", f"{coverage(own):.3f}")
        counts = (count, len(own), len(own) - len(given(own)))
        shapes = (right(own), len(straight(own)))
        yield plan, *map(str, counts), *measured, *map(str, shapes)


def _shapes(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    every = demanded(outcomes)
    for shape in SHAPES:
        own = [curve for curve in every if curve["true"] == shape]
        counts = Counter(curve["found"] for curve in own)
        good = [curve for curve in own if curve["found"] == shape]
        bad = [curve for curve in own if curve["found"] != shape]
        found = ", ".join(f"{name}: {counts[name]}" for name in sorted(counts))
        measured = (f"{rms(good):.3f}", f"{rms(bad):.3f}", f"{attainable(own):.3f}")
        yield shape, f"{len(own)}", found, *measured


def _constants(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for plan in PLANS:
        own = constant(curves_of(outcomes, plan))
        curved = sum(curve["found"] != "0" for curve in given(own))
        yield plan, f"{len(own)}", f"{curved}", f"{rms(own):.3f}", f"{coverage(own):.3f}"


def _causes(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    counts = Counter(
        cause for one in outcomes for cause in one.get("causes", ()) if cause not in EXPECTED
    )
    for cause, count in counts.most_common():
        yield cause, f"{count}"


def picture(outcomes: Sequence[Outcome], file: Path) -> None:
    """Left: rms of error by bound along the range, by plan; right: errors of one plan's curves."""
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    left, last = figure.subplots(1, 2)
    for plan, colour in zip(PLANS, ("#0072B2", "#D55E00", "#009E73", "#999999"), strict=True):
        own = clear(curves_of(outcomes, plan))
        if own:
            ratio = np.array([np.divide(c["error"], c["bound"]) for c in own])
            at = np.array(own[0]["at"]) - ICE_POINT
            left.plot(at, np.sqrt(np.nanmean(ratio**2, axis=0)), color=colour, label=plan)
    left.axhspan(0.95, 1.05, color="0.85")
    left.set(xlabel="Temperature, °C", ylabel="rms of error by bound", ylim=(0, None))
    left.legend(frameon=False)
    every = demanded(outcomes)
    ratios = [curve["ratio"] for curve in every]
    hit = [curve["found"] == curve["true"] for curve in every]
    shapes = [SHAPES.index(curve["true"]) for curve in every]
    for good, mark in ((True, "o"), (False, "x")):
        own = [i for i, one in enumerate(hit) if one is good]
        shift = 0.12 if good else -0.12
        last.scatter(
            [ratios[i] for i in own],
            [shapes[i] + shift for i in own],
            marker=mark,
            s=18,
            color="#0072B2" if good else "#D55E00",
            label="right" if good else "another shape",
        )
    last.set(xscale="log", xlabel="Ratio of the highest coefficient, or bend, to its least sigma")
    last.set_yticks(range(len(SHAPES)), [f"degree {s}" if s != "knee" else s for s in SHAPES])
    last.legend(frameon=False)
    figure.savefig(file, dpi=120)
