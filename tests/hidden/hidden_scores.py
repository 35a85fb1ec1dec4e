"""What many draws say: false names, power, classes, coverage, gain, time."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from hidden_campaigns import CLEAR, Outcome

NOTHING, UNKNOWN = "nothing", "unknown"
TRUE_ANYWAY = {"temperature_drift"}  # what quality rightly says of a plan in which it changes
AT_STAKE = 0.5  # of SNR², for a gain on what is held out
LEAST_AT_STAKE = 9.0
OF_ALL = {"table_position_error": "position_scatter"}  # hidden in all positions of a campaign
Tally = tuple[int, int]  # how many of how many


def false_names(outcome: Outcome) -> list[str]:
    """Causes that were not put in, and that have no member in their class that was."""
    hidden = {*outcome["hidden"], *(OF_ALL[one] for one in outcome["hidden"] if one in OF_ALL)}
    return [
        one["cause"]
        for one in outcome["named"]
        if one["verdict"] in CLEAR and not hidden & {one["cause"], *one["members"]}
    ]


def detected(outcome: Outcome, effect: str) -> bool:
    """Whether an effect is named, or is in the class of what is.

    That a bias walks is the truth of a random walk, though its cause be unknown. What the samples
    show at once (an oscillation, the end of the range) quality says.
    """
    for one in outcome["named"]:
        told = {effect, OF_ALL.get(effect)} & {one["cause"], *one["members"]}
        if told and (one["verdict"] in CLEAR or effect.endswith("_random_walk")):
            return True
    return any(effect == cause or effect.endswith(f"_{cause}") for cause in outcome["quality"])


def consistent(outcome: Outcome) -> bool:
    """Whether all that is hidden is among the members of what is named, however certain that is."""
    said = {member for one in outcome["named"] for member in (one["cause"], *one["members"])}
    return {*outcome["hidden"]} <= said and not false_names(outcome)


def class_right(outcome: Outcome) -> bool:
    """Whether all that is hidden is in the classes that are named, and nothing else is named."""
    every = all(detected(outcome, effect) for effect in outcome["hidden"])
    return every and not false_names(outcome)


def truly_named(outcome: Outcome) -> bool:
    """The same where the hidden names are several for one thing."""
    any_of_it = any(detected(outcome, effect) for effect in outcome["hidden"])
    return any_of_it and not false_names(outcome)


def warned(outcome: Outcome) -> bool:
    """Whether anything at all is said to be wrong."""
    said = set(outcome["quality"]) - TRUE_ANYWAY
    return bool(outcome["named"] or outcome["unexplained"] or said)


def unknown_or_true(outcome: Outcome) -> bool:
    """Whether something is said to be wrong, and no name is given that is false."""
    return warned(outcome) and not false_names(outcome)


def first_name(outcome: Outcome) -> str:
    """The most significant cause; that it is unknown; or nothing."""
    clear = [one for one in outcome["named"] if one["verdict"] in CLEAR]
    if clear:
        return str(max(clear, key=lambda one: one["snr"] or 0.0)["cause"])
    return UNKNOWN if outcome["named"] or outcome["unexplained"] else NOTHING


def tally(outcomes: Sequence[Outcome], true: Callable[[Outcome], bool]) -> Tally:
    """Of how many of so many outcomes it is true."""
    return sum(true(one) for one in outcomes), len(outcomes)


def of(outcomes: Sequence[Outcome], kind: str, sort: str = "", ratio: float = 0.0) -> list[Outcome]:
    """The outcomes of a kind; of a sort; of a single effect at a ratio."""
    return [
        one
        for one in outcomes
        if one["kind"] == kind
        and sort in ("", one["sort"])
        and (not ratio or abs(next(iter(one["ratios"].values()), 0.0) - ratio) < 1e-6)
    ]


def pulls(outcomes: Sequence[Outcome]) -> Tally:
    """How many of the parameters of rightly named effects lie within their 95 % interval."""
    every = np.array([pull for one in outcomes for pull in one["pulls"]])
    return int(np.sum(np.abs(every) < 1.96)), len(every)


def curses(outcomes: Sequence[Outcome]) -> list[float]:
    """The size of rightly named effects along the true direction, in units of the true one."""
    return [value for one in outcomes for value in one["curse"].values()]


def sets(outcomes: Sequence[Outcome]) -> tuple[Tally, float]:
    """How often the class of the only cause that is named holds the truth, and its mean size."""
    own = [
        next(n for n in one["named"] if n["verdict"] in CLEAR)
        for one in outcomes
        if sum(n["verdict"] in CLEAR for n in one["named"]) == 1
    ]
    hidden = [
        one["hidden"] for one in outcomes if sum(n["verdict"] in CLEAR for n in one["named"]) == 1
    ]
    held = sum(bool(set(n["members"]) & set(h)) for n, h in zip(own, hidden, strict=True))
    mean = float(np.mean([len(n["members"]) for n in own])) if own else np.nan
    return (held, len(own)), mean


def gains(outcomes: Sequence[Outcome]) -> tuple[list[float], int]:
    """Held-out drop of chi-squared over the square of the ratio, of rightly named effects.

    And of how many there is none, for the effect was not half at stake in what was held out: an
    effect that one manoeuvre shows is foretold by no other.
    """
    named = [one for one in outcomes if class_right(one) and one["gain"]]
    tested = [one for one in named if _tested(one["gain"])]
    found = [
        sum(row["drop"] for row in one["gain"]) / next(iter(one["ratios"].values())) ** 2
        for one in tested
    ]
    return found, len(named) - len(tested)


def _tested(rows: Sequence[Mapping[str, Any]]) -> bool:
    at_stake, whole = (sum(row[key] for row in rows) for key in ("at_stake", "whole"))
    return bool(at_stake >= max(AT_STAKE * whole, LEAST_AT_STAKE))


def seconds(outcomes: Sequence[Outcome]) -> dict[str, float]:
    """Median time of a campaign of each plan from the bytes on; s of one core."""
    on_disk = [one for one in outcomes if one["on_disk"] and "seconds" in one]
    return {
        plan: float(np.median([one["seconds"] for one in on_disk if one["plan"] == plan]))
        for plan in sorted({one["plan"] for one in on_disk})
    }
