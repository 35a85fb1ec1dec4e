"""`make fleets`: simulated fleets and populations, in docs/fleet.md; can be resumed.

PYTHONPATH=tests:tests/hidden python -m fleet <folder> [<draws of each part>]
"""

import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import chain
import jinja2
import numpy as np
import resumable
from fleet_draws import (
    LEVELS,
    MAIN,
    MEAN_SPREADS,
    MEAN_TABLES,
    RATIOS,
    SPREAD,
    TOGETHER,
    drawn_means,
    drawn_population,
    mixed,
    single,
)
from fleet_plans import FALSE_DISCOVERIES, SHAPES, code, fleet

PAGE = chain.ROOT / "docs/fleet.md"
TEMPLATE = Path(__file__).with_name("fleet.md.jinja")
TRIALS, FLEETS, POPULATIONS, MEANS = 20, 1000, 400, 1000
WANTED_POWER, WANTED_FALSE = 0.05, 0.05
NORMAL = 1.96

Outcomes = Sequence[resumable.Outcome]


def page(singles: Outcomes, mixes: Outcomes, populations: Outcomes, means: Outcomes) -> str:
    """All figures."""
    first = [one for one in singles if one["ratio"] == RATIOS[0]]
    figures = {
        "shape": MAIN,
        "level": FALSE_DISCOVERIES,
        "trials": sum(one["trials"] for one in singles),
        "power": _total(first, "named"),
        "limit": _total(first, "limit"),
        "textbook": _total(first, "textbook"),
        "wanted_power": WANTED_POWER,
        "by_level": [_by_level(level, first) for level in LEVELS],
        "weakest": _weakest(first),
        "attribution": [_attribution(singles, level, r) for level in LEVELS for r in RATIOS],
        "fleets": len(mixes),
        "wanted_fleets": FLEETS,
        "wanted_false": 100 * WANTED_FALSE,
        "misnamed": _discoveries(mixes, "false"),
        "astray": _discoveries(mixes, "astray"),
        "by_shape": [_of_shape(name, [m for m in mixes if m["shape"] == name]) for name in SHAPES],
        "populations": len(populations),
        "cover": [_cover(n, [p for p in populations if p["tables"] == n]) for n in (2, 5)],
        "means": [_means(n, spread, means) for n in MEAN_TABLES for spread in MEAN_SPREADS],
        "outliers": _outliers(populations),
    }
    template = jinja2.Template(TEMPLATE.read_text(encoding="utf-8"), keep_trailing_newline=True)
    return template.render(figures)


def _total(own: Outcomes, key: str) -> float:
    """A rate over all trials."""
    return float(sum(one[key] for one in own) / max(sum(one["trials"] for one in own), 1))


def _by_level(level: str, first: Outcomes) -> tuple[str, ...]:
    own = [one for one in first if one["level"] == level]
    rates = (f"{_total(own, key):.3f}" for key in ("named", "limit", "textbook"))
    return level, str(sum(one["trials"] for one in own)), *rates


def _weakest(first: Outcomes) -> tuple[str, str, str]:
    """The effect whose power is furthest below its limit."""
    effects = dict.fromkeys(one["effect"] for one in first)
    rates = {
        name: tuple(
            _total([one for one in first if one["effect"] == name], key)
            for key in ("named", "limit")
        )
        for name in effects
    }
    name = min(rates, key=lambda one: rates[one][0] - rates[one][1])
    return name, f"{rates[name][0]:.2f}", f"{rates[name][1]:.2f}"


def _attribution(singles: Outcomes, level: str, ratio: float) -> tuple[str, ...]:
    """Of the named ones: the truth is among what it may belong to; it alone."""
    own = [one for one in singles if (one["level"], one["ratio"]) == (level, ratio)]
    named = max(sum(one["named"] for one in own), 1)
    rates = (f"{100 * sum(one[key] for one in own) / named:.1f}" for key in ("right", "only"))
    return level, f"{ratio:.0f}", f"{named:.0f}", *rates


def _discoveries(mixes: Outcomes, key: str) -> tuple[str, str]:
    """Mean over the fleets of the share of false findings, %, and its standard error."""
    shares = np.array([one[key] / max(one["found"], 1) for one in mixes])
    return f"{100 * shares.mean():.1f}", f"{100 * shares.std() / np.sqrt(len(shares)):.1f}"


def _of_shape(name: str, mixes: Outcomes) -> tuple[str, ...]:
    clean = [one for one in mixes if not one["hidden"]]
    noisy = sum(one["found"] > 0 for one in clean)
    return name, str(len(mixes)), _discoveries(mixes, "false")[0], f"{noisy} of {len(clean)}"


def _cover(tables: int, own: Outcomes) -> tuple[str, ...]:
    """How often 95 % intervals hold the truth: spread, a new IMU; the correlation."""
    spreads = np.array([abs(one["spread"] - SPREAD) < NORMAL * one["spread_sigma"] for one in own])
    new = np.array([one["new_inside"] for one in own])
    correlation = np.array([one["correlation"] for one in own])
    rates = (f"{100 * each.mean():.1f}" for each in (spreads, new))
    return str(tables), str(len(own)), *rates, f"{correlation.mean():.2f} ± {correlation.std():.2f}"


def _means(tables: int, spread: float, means: Outcomes) -> tuple[str, ...]:
    """How often 95 % intervals hold the mean, %, with its standard error; half of their width."""
    own = [one for one in means if (one["tables"], one["spread"]) == (tables, spread)]
    count = max(TOGETHER * len(own), 1)
    share = sum(one["held"] for one in own) / count
    error = np.sqrt(share * (1 - share) / count)
    width = np.median([one["half_width"] for one in own] or [np.nan])
    return (
        *(str(tables), f"{spread / SPREAD:.2f}", str(count)),
        *(f"{100 * share:.1f} ± {100 * error:.1f}", f"{width / SPREAD:.2f}"),
    )


def _outliers(populations: Outcomes) -> dict[str, str]:
    odd = [one for one in populations if one["odd"]]
    clean = [one for one in populations if not one["odd"]]
    return {
        "found": f"{sum('19' in one['outliers'] for one in odd)} of {len(odd)}",
        "others": f"{sum(bool(set(one['outliers']) - {'19'}) for one in odd)} of {len(odd)}",
        "clean": f"{sum(bool(one['outliers']) for one in clean)} of {len(clean)}",
    }


def _jobs(most: int) -> Iterator[tuple[str, str, float, int]]:
    evidence, _, _ = fleet(MAIN)
    for name in evidence.names:
        for level in LEVELS:
            for ratio in RATIOS:
                yield name, level, ratio, min(TRIALS if ratio == RATIOS[0] else TRIALS // 2, most)


def main(folder: Path, most: int) -> None:
    """Draw what is missing, then write the page of all."""
    resumable.with_all_stages()
    key = ("effect", "level", "ratio", "trials")
    singles = resumable.drawn(folder / "singles.jsonl", code(), key, single, list(_jobs(most)))
    numbered = (("mixed", mixed, FLEETS), ("populations", drawn_population, POPULATIONS))
    mixes, populations = (
        resumable.drawn(
            folder / f"{name}.jsonl",
            code(),
            ("number",),
            outcome,
            [(number,) for number in range(min(count, most))],
        )
        for name, outcome, count in numbered
    )
    batches = range(-(-min(MEANS, most) // TOGETHER))
    means = resumable.drawn(
        folder / "means.jsonl",
        code(),
        ("tables", "spread", "number"),
        drawn_means,
        [(n, spread, b) for n in MEAN_TABLES for spread in MEAN_SPREADS for b in batches],
    )
    PAGE.write_text(page(singles, mixes, populations, means), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else sys.maxsize)
