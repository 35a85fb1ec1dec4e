"""What many draws say: false names, power, classes, coverage, time."""

from collections.abc import Sequence
from typing import Any

import numpy as np

Outcome = dict[str, Any]
CLEAR = ("found", "one_of_class")


def false_names(outcome: Outcome) -> list[str]:
    """Causes that are named and were not put in, by themselves or as a member of the class."""
    hidden = set(outcome["hidden"])
    return [
        one["cause"]
        for one in outcome["named"]
        if one["verdict"] in CLEAR and not hidden & set(one["members"])
    ]


def detected(outcome: Outcome, effect: str) -> bool:
    """Whether an effect is in the class of something that was named."""
    return any(effect in one["members"] for one in outcome["named"])


def share(outcomes: Sequence[Outcome]) -> dict[str, Any]:
    """The figures of all outcomes together."""
    clean = [one for one in outcomes if one["kind"] == "clean"]
    single = [one for one in outcomes if one["kind"] == "single"]
    two = [one for one in outcomes if one["kind"] == "two"]
    outside = [one for one in outcomes if one["kind"] == "outside"]
    pulls = np.array([pull for one in outcomes for pull in one["pulls"]])
    ratios = sorted({one["ratio"] for one in single})

    def of(ratio: float) -> list[Outcome]:
        return [one for one in single if one["ratio"] == ratio]

    return {
        "clean": len(clean),
        "false names in clean campaigns": sum(bool(false_names(one)) for one in clean),
        "false names beside what is hidden": sum(
            len(false_names(one)) for one in outcomes if one["kind"] in ("single", "two")
        ),
        "named at all, by ratio": {
            ratio: (sum(bool(one["named"]) for one in of(ratio)), len(of(ratio)))
            for ratio in ratios
        },
        "in its class, by ratio": {
            ratio: (sum(detected(one, one["hidden"][0]) for one in of(ratio)), len(of(ratio)))
            for ratio in ratios
        },
        "both of two": (sum(all(detected(o, e) for e in o["hidden"]) for o in two), len(two)),
        "outside the catalogue, warned": (
            sum(bool(one["named"]) or one["unexplained"] for one in outside),
            len(outside),
        ),
        "outside the catalogue, not named": (
            sum(all(n["verdict"] not in CLEAR for n in one["named"]) for one in outside),
            len(outside),
        ),
        "within 95 %": float(np.mean(np.abs(pulls) < 1.96)) if len(pulls) else None,
        "seconds": float(np.median([one["seconds"] for one in outcomes])),
    }
