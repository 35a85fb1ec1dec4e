"""The page of what was put into real recordings, docs/injections.md."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import chain
import jinja2
import numpy as np

from injections.injected import FAULTS, HIDDEN, INTO, RATIOS, THERE, code

PAGE = chain.ROOT / "docs/injections.md"
TEMPLATE = Path(__file__).parent / "injections.md.jinja"
WANTED = 400  # injections
MAX_BELOW = 0.1  # of the power, pooled, below its limit
MISSED_LIMIT = 0.99  # power from which a miss is listed

Outcome = dict[str, Any]
Row = tuple[str, ...]


def write(outcomes: Sequence[Outcome], count: int, page: Path = PAGE) -> str:
    """Write the page; its first sentence for the terminal."""
    plain = [one for one in outcomes if one["number"] < 0]
    faults = [one for one in outcomes if one.get("name") in FAULTS]
    effects = [one for one in outcomes if one.get("name") in HIDDEN and one["shown"]]
    hidden = [one for one in outcomes if one.get("name") in HIDDEN and not one["shown"]]
    found, limit = _power(effects)
    figures = {
        "code": code(),
        "wanted": WANTED,
        "count": len(faults) + len(effects) + len(hidden),
        "effects": len(effects),
        "found": f"{found:.3f}",
        "limit": f"{limit:.3f}",
        "shown": f"{np.mean([one['shows'] for one in effects]):.3f}",
        "unseen": f"{sum(one['shows'] and not one['found'] for one in effects)}",
        "known": f"{np.mean([one['known'] for one in effects]):.3f}",
        "hidden": len(hidden),
        "verdict": "met" if found >= limit - MAX_BELOW else "**not met**",
        "beside": sum(bool(one["beside"]) for one in effects),
        "by_ratio": [_row(f"{ratio:g}", _of(effects, "ratio", ratio)) for ratio in RATIOS],
        "by_name": [_row(name, _of(effects, "name", name)) for name in HIDDEN],
        "by_recording": [_row(name, _of(effects, "recording", name)) for name in INTO],
        "faults": list(_of_faults(faults)),
        "plain": [
            (one["recording"], ", ".join(sorted(THERE[one["recording"]])), ", ".join(one["false"]))
            for one in plain
        ],
        "missed": [
            (
                *(one["recording"], one["name"], f"{one['ratio']:g}", f"{one['limit']:.2f}"),
                "yes" if one["shows"] else "no",
            )
            for one in effects
            if not one["found"] and one["limit"] > MISSED_LIMIT
        ],
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    return f"{found:.3f} of {len(effects)} effects found, {limit:.3f} possible: {page}\n"


def _of(outcomes: Sequence[Outcome], key: str, value: Any) -> list[Outcome]:
    return [one for one in outcomes if one[key] == value]


def _power(effects: Sequence[Outcome]) -> tuple[float, float]:
    """The share that is found, and what could be."""
    if not effects:
        return np.nan, np.nan
    return (
        float(np.mean([one["found"] for one in effects])),
        float(np.mean([one["limit"] for one in effects])),
    )


def _row(name: str, effects: Sequence[Outcome]) -> Row:
    found, limit = _power(effects)
    right = sum(one["found"] for one in effects)
    shown = np.mean([one["shows"] for one in effects]) if effects else np.nan
    numbers = (f"{found:.2f}", f"{limit:.2f}", f"{shown:.2f}") if effects else ("–",) * 3
    beside = ", ".join(sorted({name for one in effects for name in one["beside"]}))
    return name, f"{right} of {len(effects)}", *numbers, beside


def _of_faults(faults: Sequence[Outcome]) -> Iterator[Row]:
    for name in FAULTS:
        own = _of(faults, "name", name)
        beside = ", ".join(sorted({cause for one in own for cause in one["beside"]}))
        missed = ", ".join(sorted({one["recording"] for one in own if not one["found"]}))
        yield name, f"{sum(one['found'] for one in own)} of {len(own)}", missed, beside
