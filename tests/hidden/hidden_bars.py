"""What is demanded, what was measured, and whether it is met: by the figures, never by hand."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from hidden_campaigns import Outcome
from hidden_draws import EACH_FROM
from hidden_named_sizes import FIRST, MATE, WAYS_OF_ESTIMATING, coverage, mean_ratio, summed
from hidden_scores import (
    Tally,
    class_right,
    consistent,
    curses,
    detected,
    false_names,
    gains,
    of,
    pulls,
    seconds,
    sets,
    tally,
    truly_named,
    unknown_or_true,
    warned,
)

FALSE_NAMES, CLEAN = 8, 300
SHORT = 0.05  # of its limit a power may be
RIGHT = 0.95  # of what is named, the class
RIGHT_AT = (6.0, 8.0, 10.0, 15.0)
TOGETHER = {
    "2 at 12 to 40": 0.95,
    "3 at 12 to 40": 0.92,
    "2 at 6 to 12": 0.90,
    "3 at 6 to 12": 0.85,
}
NAMED_FALSELY = 0.02  # decoys, and physical sizes of each grade
RATIOS = (5.0, 6.0, 8.0)
LEAST_NAMED = 1000  # draws, of which the size of what is named is judged
SIZE = (0.98, 1.02)  # of the true one, given that it is named
COVERAGE = (0.93, 0.97)  # of 95 % intervals
SHIFT = 0.5  # sigma
TIME = 10.0  # s
# Sought elsewhere than in the blocks of means: in the samples, in the spectrum, or with a width.
ELSEWHERE = ("gyro_dead_band", "gyro_saturation", "accel_saturation", "table_ripple")


@dataclass(frozen=True)
class Bar:
    """A demand: in words, what is wanted, what was measured, and whether that is enough.

    `met`: None where nothing was drawn that could tell.
    """

    words: str
    wanted: str
    measured: str
    met: bool | None

    @property
    def verdict(self) -> str:
        """In words."""
        return "not drawn" if self.met is None else "met" if self.met else "**not met**"


def bars(outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]]) -> Iterator[Bar]:
    """Every demand."""
    yield from _of_clean(outcomes)
    yield from _of_power(outcomes, statistics)
    for ratio in RIGHT_AT:
        named = [one for one in of(outcomes, "single", "ratio", ratio) if one["named"]]
        yield _right(f"class right where anything is named, SNR {ratio:g}", named, RIGHT)
    for ratio in (6.0, 8.0):
        rows = [row for row in statistics if row["ratio"] == ratio]
        right, all_named = (sum(row[key] for row in rows) for key in ("in_class", "power"))
        words = f"class right where anything is named, SNR {ratio:g}, sufficient statistics"
        yield _least(words, (right, all_named), RIGHT)
    for sort, wanted in TOGETHER.items():
        number, _, band = sort.partition(" at ")
        own = of(outcomes, "several", sort)
        limit = f" (limit {np.mean([one['limit'] for one in own]):.3f})" if own else ""
        words = f"{number} effects at once at SNR {band} each, all classes right{limit}"
        yield _told_apart(_right(words, own, wanted), outcomes, sort)
    yield _most("decoys with a false name", of(outcomes, "decoy"))
    physical = of(outcomes, "single", "physical")
    for grade in dict.fromkeys(one["grade"] for one in physical):
        own = [one for one in physical if one["grade"] == grade]
        yield _most(f"physical sizes with a false name, {grade}", own)
    for name in ELSEWHERE:
        own = [
            one
            for one in of(outcomes, "single", "elsewhere")
            if any(hidden.startswith(name) for hidden in one["hidden"])
        ]
        yield _least(f"{name}: found, and nothing else named", tally(own, truly_named), 0.9)
    yield from _of_estimates(outcomes, statistics)
    outside = of(outcomes, "outside")
    yield _least("outside the catalogue: a warning", tally(outside, warned), 0.95)
    yield _least("the same: “unknown” or the true class", tally(outside, unknown_or_true), 0.80)
    yield from _of_gain(outcomes)
    times = seconds(outcomes)
    yield Bar(
        "CPU time of a campaign of at most 214,800 samples, from the bytes to the extension",
        f"≤ {TIME:g} s",
        ", ".join(f"{plan} {time:.1f} s" for plan, time in times.items()) or "–",
        max(times.values()) <= TIME if times else None,
    )


def no_errors(outcomes: Sequence[Mapping[str, Any]]) -> Bar:
    """Every campaign is analysed to its end."""
    errors = sum("error" in one for one in outcomes)
    measured = f"{errors} of {len(outcomes)}"
    return Bar(
        "campaigns that end with an error", "none", measured, not errors if outcomes else None
    )


def _of_clean(outcomes: Sequence[Outcome]) -> Iterator[Bar]:
    yield no_errors(outcomes)
    clean = of(outcomes, "clean")
    count, number = tally(clean, lambda one: bool(false_names(one)))
    allowed = FALSE_NAMES if number >= CLEAN else FALSE_NAMES * number / CLEAN
    yield Bar(
        "clean campaigns with a false name",
        f"≤ {FALSE_NAMES} of {CLEAN}",
        f"{count} of {number}",
        count <= allowed if number else None,
    )
    rung = [one for one in clean if "shift" in one]
    most = max((one["shift"] for one in rung), default=np.nan)
    counted = tally(rung, lambda one: detected(one, "oscillation"))
    yield Bar(
        "oscillation at 20 Hz: reported, and the 24 parameters moved by less than half a sigma",
        f"all, < {SHIFT} sigma",
        f"{counted[0]} of {counted[1]}, at most {most:.4f} sigma" if rung else "–",
        counted[0] == counted[1] and most < SHIFT if rung else None,
    )


def _of_power(outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]]) -> Iterator[Bar]:
    for ratio in RATIOS:
        own = of(outcomes, "single", "ratio", ratio)
        limit = float(np.mean([one["limits"]["limit"] for one in own])) if own else np.nan
        counted = tally(own, lambda one: bool(one["named"]))
        yield _least(
            f"power at SNR {ratio:g}, campaigns, all effects (limit {limit:.3f})",
            counted,
            limit - SHORT,
        )
    yield _of_each(outcomes)
    for ratio in RATIOS:
        rows = [row for row in statistics if row["ratio"] == ratio]
        short = [short_by(row) for row in rows]
        scatter = [2 * scatter_of(row) for row in rows]
        below = sum(s > SHORT + e for s, e in zip(short, scatter, strict=True))
        yield Bar(
            f"power at SNR {ratio:g} of each effect, sufficient statistics",
            f"no effect below its limit by more than {SHORT} and twice the scatter of the draws",
            f"{below} of {len(rows)} effects; the worst is {max(short):+.3f} below"
            if rows
            else "–",
            below == 0 if rows else None,
        )


def _of_each(outcomes: Sequence[Outcome]) -> Bar:
    """Power of each effect in the campaigns that it has of its own, at all ratios together."""
    by_effect: dict[str, list[Outcome]] = {}
    for one in outcomes:
        if one["number"] >= EACH_FROM:
            by_effect.setdefault(one["hidden"][0], []).append(one)
    below, worst = [], 0.0
    for name, own in by_effect.items():
        limits = np.array([one["limits"]["limit"] for one in own])
        short = float(np.mean(limits) - np.mean([bool(one["named"]) for one in own]))
        scatter = float(np.sqrt(np.sum(limits * (1 - limits)))) / len(own)
        worst = max(worst, short)
        if short > SHORT + 2 * scatter:
            below.append(name)
    number = sum(map(len, by_effect.values()))
    named = f": {', '.join(below)}" if below else ""
    return Bar(
        f"power of each effect in {number / max(len(by_effect), 1):.0f} campaigns of its own, from "
        "bytes, at SNR 5, 6 and 8 in turn",
        f"no effect below its limit by more than {SHORT} and twice the scatter of so many",
        f"{len(below)} of {len(by_effect)} effects{named}; the worst is {worst:+.3f} below"
        if by_effect
        else "–",
        not below if by_effect else None,
    )


def scatter_of(row: dict[str, Any]) -> float:
    """Standard deviation of a share of so many trials, were it the limit."""
    return float(np.sqrt(row["limit"] * (1 - row["limit"]) / row["trials"]))


def short_by(row: dict[str, Any]) -> float:
    """By how much the power of an effect falls short of its limit."""
    return float(row["limit"] - row["power"] / row["trials"])


def _of_estimates(
    outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]]
) -> Iterator[Bar]:
    inside, number = pulls(outcomes)
    yield Bar(
        "95 % intervals of rightly named effects that hold the truth",
        "0.92 to 0.98",
        _share((inside, number)),
        0.92 <= inside / number <= 0.98 if number else None,
    )
    for ratio in RATIOS:
        yield from _of_sizes(ratio, outcomes, statistics)
    held, size = sets(of(outcomes, "single", "ratio"))
    yield Bar(
        "95 % set of causes: holds the truth, mean size (design study)",
        "≥ 0.95, ≤ 4",
        f"{_share(held)}, {size:.1f}" if held[1] else "–",
        held[0] >= 0.95 * held[1] and size <= 4 if held[1] else None,
    )


def _of_sizes(
    ratio: float, outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]]
) -> Iterator[Bar]:
    """The size of what is named, and its intervals, on sufficient statistics."""
    rows = [row["sizes"] for row in statistics if row["ratio"] == ratio]
    counts = summed(sizes[sort] for sizes in rows for sort in (FIRST, MATE))
    enough = counts["draws"] >= LEAST_NAMED
    plain, reported = WAYS_OF_ESTIMATING
    in_campaigns = curses(of(outcomes, "single", "ratio", ratio))
    said = said_covered = "–"
    size = share = np.nan
    if counts["draws"]:
        (before, _), (size, sigma) = mean_ratio(counts, plain), mean_ratio(counts, reported)
        said = f"{size:.3f} ± {sigma:.3f} of {counts['draws']:.0f}, by least squares {before:.3f}"
        if in_campaigns:
            said += f"; in campaigns {np.mean(in_campaigns):.3f} of {len(in_campaigns)}"
        share = coverage(counts, reported)
        said_covered = f"{share:.3f} of {counts['parameters']:.0f} parameters"
    yield Bar(
        f"size of what is named at SNR {ratio:g}, along the true direction, over the true size",
        f"{SIZE[0]} to {SIZE[1]}, of {LEAST_NAMED} or more",
        said,
        enough and SIZE[0] <= size <= SIZE[1] if counts["draws"] else None,
    )
    yield Bar(
        f"95 % intervals of what is named at SNR {ratio:g} that hold the truth",
        f"{COVERAGE[0]} to {COVERAGE[1]}",
        said_covered,
        enough and COVERAGE[0] <= share <= COVERAGE[1] if counts["draws"] else None,
    )


def _of_gain(outcomes: Sequence[Outcome]) -> Iterator[Bar]:
    every, untested = gains(of(outcomes, "single", "ratio"))
    median = float(np.median(every)) if every else np.nan
    yield Bar(
        "held-out gain over SNR², median",
        "≥ 0.8",
        f"{median:.2f} of {len(every)}; {untested} cannot be tested so" if every else "–",
        median >= 0.8 if every else None,
    )
    for least, most, wanted in ((6.0, 6.0, 0.85), (10.0, 15.0, 0.95)):
        own = [
            gain
            for ratio in (5.0, 6.0, 8.0, 10.0, 15.0)
            if least <= ratio <= most
            for gain in gains(of(outcomes, "single", "ratio", ratio))[0]
        ]
        words = f"SNR {least:g}" if least == most else f"SNR {least:g} and more"
        above = sum(gain > 0 for gain in own)
        yield _least(f"held-out gain above 0 at {words} (design study)", (above, len(own)), wanted)


def _right(words: str, outcomes: Sequence[Outcome], wanted: float) -> Bar:
    """How often all classes are right; and with those that the data are said to allow no more."""
    bar = _least(words, tally(outcomes, class_right), wanted)
    allowed = tally(outcomes, consistent)[0]
    more = f"; {allowed} with classes that are called uncertain" if outcomes else ""
    return replace(bar, measured=bar.measured + more)


def _told_apart(bar: Bar, outcomes: Sequence[Outcome], sort: str) -> Bar:
    """And where no effect accounts for another one, so that all are needed."""
    own = [one for one in of(outcomes, "several", sort) if one["apart"]]
    count, number = tally(own, class_right)
    apart = f"{count} of {number} where none accounts for another"
    return replace(bar, measured=f"{bar.measured}; {apart}")


def _most(words: str, outcomes: Sequence[Outcome]) -> Bar:
    """That no more than the share allowed has a false name."""
    counted = tally(outcomes, lambda one: bool(false_names(one)))
    met = counted[0] <= NAMED_FALSELY * counted[1] if counted[1] else None
    return Bar(words, f"≤ {NAMED_FALSELY:g}", _share(counted), met)


def _least(words: str, counted: Tally, wanted: float) -> Bar:
    count, number = counted
    told = f"≥ {wanted:.3g}" if np.isfinite(wanted) else "–"
    return Bar(words, told, _share(counted), count >= wanted * number if number else None)


def _share(counted: Tally) -> str:
    count, number = counted
    return f"{count / number:.3f} ({count} of {number})" if number else "–"
