"""The page of simulated noise, docs/noise.md."""

from collections.abc import Iterator, Sequence
from pathlib import Path

import jinja2
import numpy as np
from noise_draws import INTERVAL, NULL_SAMPLES, PARTS, SAMPLES, Row, code
from noise_pictures import navigation_picture, terms_picture

from inertial.estimation.noise_model import TERMS
from inertial.estimation.noise_terms import LEVEL

DOCS = Path(__file__).parents[2] / "docs"
TEMPLATE = Path(__file__).parent / "noise.md.jinja"
BAR = (0.93, 0.97)

Cells = Sequence[str]


def write(outcomes: Sequence[Row], docs: Path = DOCS) -> str:
    """Write page and pictures; the bars as text for the terminal."""
    coverage = list(_coverage(outcomes))
    figures = {
        "code": code(),
        "drawn": {part: sum(1 for row in outcomes if row["part"] == part) for part in PARTS},
        "wanted": PARTS,
        "minutes": f"{SAMPLES * INTERVAL / 60:.0f}",
        "null_minutes": f"{NULL_SAMPLES * INTERVAL / 60:.0f}",
        "rate": f"{1 / INTERVAL:g}",
        "milliseconds": f"{1e3 * np.mean([row['seconds'] for row in outcomes]):.0f}",
        "level": f"{LEVEL:g}",
        "coverage": coverage,
        "absent": list(_absent(outcomes)),
        "misfit": f"{np.mean([row['misfit'] for row in outcomes]):.3f}",
        "lines": sum(row["lines"] > 0 for row in outcomes),
        "reduced": sum(row["highest"] < 0.45 / INTERVAL for row in outcomes),
        "all": len(outcomes),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page = jinja2.Template(text, keep_trailing_newline=True).render(figures)
    (docs / "noise.md").write_text(page, "utf-8")
    terms_picture(docs / "noise-terms.png")
    navigation_picture(docs / "noise-navigation.png")
    lines = (f"{row[-1].strip('*'):9} {row[0]}: {row[2]}\n" for row in coverage)
    return "".join([*lines, f"The page: {docs / 'noise.md'}\n"])


def _coverage(outcomes: Sequence[Row]) -> Iterator[Cells]:
    """Of each term, in the recordings with all five."""
    for name in TERMS:
        every = [row["terms"][name] for row in outcomes if row["part"] == "all"]
        found = [term for term in every if term["detected"]]
        if not found:
            continue
        pulls = np.array([(term["value"] - term["true"]) / term["sigma"] for term in found])
        covered = [term["low"] <= term["true"] <= term["high"] for term in found]
        share = float(np.mean(covered))
        one_sigma = float(np.mean(np.abs(pulls) < 1))
        error = np.sqrt(share * (1 - share) / len(found))
        yield (
            name.replace("_", " "),
            f"{len(found)} of {len(every)}",
            f"{share:.3f} ± {error:.3f}",
            f"{one_sigma:.3f}",
            f"{pulls.mean():+.2f}",
            f"{pulls.std():.2f}",
            f"{100 * np.median([term['sigma'] / term['value'] for term in found]):.1f} %",
            _verdict(share, len(every)),
        )


def _verdict(share: float, drawn: int) -> str:
    if drawn < PARTS["all"]:
        return "to be drawn"
    return "met" if BAR[0] <= share <= BAR[1] else "**not met**"


def _absent(outcomes: Sequence[Row]) -> Iterator[Cells]:
    """Of each term, in recordings that have none of it, or too little."""
    for name in TERMS:
        none = [
            row["terms"][name]
            for row in outcomes
            if row["part"] == "null" and not row["terms"][name]["true"]
        ]
        limited = [
            row["terms"][name]
            for row in outcomes
            if row["part"] == "small" and not row["terms"][name]["detected"]
        ]
        if not none or not limited:
            continue
        named = sum(term["detected"] for term in none)
        asked = sum(term["p_value"] < LEVEL for term in none)
        holds = float(np.mean([term["upper"] >= term["true"] for term in limited]))
        yield (
            name.replace("_", " "),
            f"{named} of {len(none)}",
            f"{asked / len(none):.4f}",
            f"{sum(bool(term['alternatives']) for term in none)}",
            f"{holds:.3f} of {len(limited)}",
        )
