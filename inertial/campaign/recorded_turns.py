"""The turns of a plan as they were recorded, and why one cannot be used."""

from collections.abc import Hashable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees
from typing import TYPE_CHECKING

import numpy as np

from inertial.arrays import Array
from inertial.campaign.encoder import windows_of
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import TURNING, Manoeuvre, Performed
from inertial.campaign.static_positions import NO_BLOCKS, Blocks, by_manoeuvre
from inertial.estimation.gyroscope_observations import Gap
from inertial.estimation.noise_model import sigma_of_mean
from inertial.estimation.spectrum import rate_deviation
from inertial.tables import GYRO, STATIC_PHASES
from inertial.text.messages import _
from inertial.text.numbers import significant

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData


MIN_REST_SHARE = 0.1  # of the time of a turn, that its rests last to show the bias in it
MAX_RATE_SHARE = 0.5  # of what an angle lacks, by which the rate is less where samples are lost


@dataclass(frozen=True)
class Rotation:
    """A rotation of the plan, its record, its blocks in motion, and why it is refused.

    `begun`: whether the rest before it is in its record; one that is recorded in part and has
    none begins at another azimuth than that of the set position. `clock_sigma`: of the rate of the
    clock of its log, relative; `off_ratio`: to its stated rate or angle, where by the other turns
    it was another; `may_lack`: whether samples may be lacking of it instead.
    """

    plan: Manoeuvre
    done: Performed
    blocks: Blocks
    refusal: str  # empty where it can be used
    begun: bool = True
    clock_sigma: float = 0.0
    off_ratio: float | None = None
    may_lack: bool = False

    @property
    def steady(self) -> Blocks:
        """The blocks at the steady rate."""
        return self.blocks.those(self.blocks.steady)

    @property
    def in_part(self) -> bool:
        """Whether it is refused as a turn, but the encoder gives the angle of what is recorded."""
        lacks = self.done.found and not (self.done.complete or self.done.bridged)
        whole = self.plan.recorded == "whole" and self.done.angle is not None
        return bool(lacks and whole and windows_of(self.blocks, self.plan.axis))

    @property
    def by_encoder(self) -> bool:
        """Whether the encoder gives the angle of its steady part."""
        return bool(windows_of(self.steady, self.plan.axis))

    @property
    def weights(self) -> Array:
        """How often each block counts in the turn, (k,): with its share of what is missing."""
        return weights_of(self.blocks)


def recorded_turns(data: "CampaignData") -> list[Rotation]:
    """Every turn of the plan; refused, too, where by the others it was at another rate or angle."""
    rotations = list(_rotations(data))
    for place, refused in [*_off_rate(rotations, data.noise), *_off_angle(rotations, data)]:
        rotations[place] = refused
    return rotations


def _rotations(data: "CampaignData") -> Iterator[Rotation]:
    moving = by_manoeuvre(data.blocks[data.blocks["phase"].isin(TURNING)])
    begun = set(data.blocks.loc[data.blocks["phase"] == "rest-before", "manoeuvre"])
    for m in data.plan:
        if m.do == "turn":
            done, part = data.performed[m.name], moving.get(m.name, NO_BLOCKS)
            clock = data.clocks.get(m.log)
            timed = 0.0 if clock is None else clock.sigma
            yield Rotation(m, done, part, refusal_of(m, done, part), m.name in begun, timed)


def refusal_of(m: Manoeuvre, done: Performed, part: Blocks) -> str:
    """Why a turn cannot be used; empty where it can."""
    if not done.found:
        return _("not found in its log")
    if not len(part) or np.isnan(part.seconds).any() or bool((part.counts == 0).any()):
        return _("it has no time, so no angle can be summed")
    if m.recorded == "steady":
        return "" if part.steady.any() else _("no steady rate was found")
    if not (done.complete or done.bridged):
        return _("the angle method needs the whole turn, and {sentence}", sentence=done.sentence)
    if m.angle is None or m.angle_sigma is None:
        return _("its angle is not stated")
    if done.angle is None:
        return done.sentence
    if done.angle * m.angle < 0:
        return _("it turned by {degrees:.1f}°, against the plan", degrees=degrees(done.angle))
    return ""


def _off_rate(rotations: Sequence[Rotation], noise: NoiseLevels) -> Iterator[tuple[int, Rotation]]:
    """Which runs at a rate were at another one by the others about their axis, refused."""
    axes: dict[tuple[float, ...], list[int]] = {}
    for place, run in enumerate(rotations):
        if not run.refusal and run.plan.recorded == "steady" and not run.by_encoder:
            axes.setdefault(_line_of(run), []).append(place)
    for places in axes.values():
        stated, read, sigma = np.transpose([_rates(rotations[i], noise) for i in places])
        if (found := off_rate(stated, read, sigma)) is not None:
            number, rate = found
            run = rotations[places[number]]
            why = _("by the other runs it turned at {read} °/s, not at {stated} °/s")
            ratio = rate / float(stated[number])
            yield places[number], _refused(run, why, run.plan.rate, ratio)


def _off_angle(
    rotations: Sequence[Rotation], data: "CampaignData"
) -> Iterator[tuple[int, Rotation]]:
    """Which whole turn was by another angle by the others, refused."""
    whole = {
        place: turn
        for place, turn in enumerate(rotations)
        if not turn.refusal and turn.plan.recorded == "whole" and turn.done.complete
    }
    angles = [(turn.done.angle, turn.plan.angle) for turn in whole.values()]
    ratios = np.array([angle / planned for angle, planned in angles if angle and planned])
    lines = list(map(_line_of, whole.values()))
    if len(ratios) == len(whole) and (one := off_ratio(ratios, lines)) is not None:
        place, turn = list(whole.items())[one]
        others = [
            other for k, other in enumerate(whole.values()) if k != one and lines[k] == lines[one]
        ]
        rests = _rests_by_place(data)
        same = float(np.median([_above_rest(other, rests) for other in others]))
        ratio = _above_rest(turn, rests) / same
        may_lack = _may_lack(turn, others, ratio)
        why = (
            _(
                "by the other turns it turned by {read}°, not by {stated}°, or samples are lost in "
                "it that the stamps do not show"
            )
            if may_lack
            else _("by the other turns it turned by {read}°, not by {stated}°")
        )
        yield place, replace(_refused(turn, why, turn.plan.angle, ratio), may_lack=may_lack)


def _above_rest(turn: Rotation, rests: Mapping[str, Blocks]) -> float:
    """The angle of a whole turn over the stated one, without what its gyros read at rest there.

    Over whole rounds that is their bias and the earth's rate about the axis. Where these rests are
    too short to show it, without what they read at rest in all attitudes.
    """
    m, part, still = turn.plan, turn.blocks, rests.get(_place_of(turn.plan), NO_BLOCKS)
    assert m.angle and turn.done.angle  # else it has no ratio
    still = still.those(np.flatnonzero(np.isfinite(still.gyro[:, m.axis != 0]).all(axis=1)))
    if still.seconds.sum() < MIN_REST_SHARE * part.seconds.sum():
        return turn.done.angle / m.angle
    read = np.nansum(part.gyro * part.seconds[:, None], axis=0)
    at_rest = np.nan_to_num(mean_rate(still)) * part.seconds.sum()
    return float((read - at_rest) @ m.axis) / m.angle


def _may_lack(turn: Rotation, others: Sequence[Rotation], ratio: float) -> bool:
    """Whether a turn, short by a ratio, has the rate of the others about its axis, where known."""
    both = [(one.done.rate, one.plan.rate) for one in (turn, *others)]
    rates = [read / planned for read, planned in both if read and planned]
    known = len(rates) == 1 + len(others)
    slower = 1 - rates[0] / float(np.median(rates[1:])) if known else 0.0
    return ratio < 1 and slower < MAX_RATE_SHARE * (1 - ratio)


def _rests_by_place(data: "CampaignData") -> dict[str, Blocks]:
    """The blocks at rest, by log and position of the table."""
    rests = data.blocks[data.blocks["phase"].isin(STATIC_PHASES)]
    places = rests["manoeuvre"].map({m.name: _place_of(m) for m in data.plan})
    return by_manoeuvre(rests.assign(manoeuvre=places))


def _place_of(m: Manoeuvre) -> str:
    """Its log and the position of the table."""
    return f"{m.log}, {m.position}"


def _line_of(turn: Rotation) -> tuple[float, ...]:
    """Its axis, whichever way it points."""
    return tuple(np.abs(turn.plan.axis).round(3).tolist())


def _rates(run: Rotation, noise: NoiseLevels) -> tuple[float, float, float]:
    """Stated and read about the axis, without its sign, and the sigma, rad/s."""
    m, part = run.plan, run.steady
    sign = 1.0 if m.axis.sum() > 0 else -1.0
    white, ends = np.max([noise.of(m.name, "steady", GYRO), noise.quantisation("gyro")], axis=1)
    read = float(m.axis @ mean_rate(part))
    sigma = float(sigma_of_mean(white, ends, part.seconds.sum()))
    return sign * (m.rate or 0.0), sign * read, sigma


def mean_rate(part: Blocks) -> Array:
    """The mean reading of the gyros in some blocks, rad/s, (3,)."""
    return np.asarray(np.average(part.gyro, weights=part.counts, axis=0))


def _refused(one: Rotation, why: str, stated: float | None, ratio: float) -> Rotation:
    said = degrees(stated or 0.0)
    why = why.format(read=significant(ratio * said, 4), stated=significant(said, 4))
    return replace(one, refusal=why, off_ratio=ratio)


# ---- Interpolation of missing samples of a rotation, and the sigma of its angle.
#
# In the steady part the angle is the mean recorded rate times the missing time, in a ramp the
# integral of the straight line between the neighbouring blocks. Their noise is in the equations;
# the other errors of the angle are:
#
# - the mean rate while samples are missing differs from the recorded one: by the stated sigma of
#   the table's rate, or by the variation in the data, whichever is larger. It is the same
#   for all gaps of a rotation, and does not average out;
# - an oscillation of the case faster than a block appears in the scatter of samples only: the
#   recorded part may end at any phase of it;
# - in a ramp the acceleration may change between the neighbouring blocks: the straight line is
#   wrong by up to a quarter of the change of rate between them.


def gaps_of(part: Blocks) -> list[Gap]:
    """The gaps between the k blocks of a turn, interpolated from the neighbouring blocks."""
    seconds, steady = part.seconds, part.steady
    gaps = []
    for i in np.flatnonzero(part.missing).tolist():
        lost = float(part.missing[i])
        shares = np.zeros(len(part))
        if steady[i - 1] and steady[i]:
            shares[steady] = lost / seconds[steady].sum()
        else:
            # The straight line through the means of both blocks, at the middle of the gap.
            weight = (seconds[i - 1] + lost) / (seconds[i - 1] + 2 * lost + seconds[i])
            shares[i - 1 : i + 1] = lost * np.array([1 - weight, weight]) / seconds[i - 1 : i + 1]
        gaps.append(Gap(i, lost, shares))
    return gaps


def weights_of(part: Blocks) -> Array:
    """The weights of the k blocks of a turn in its sums, (k,), so that these have no gaps."""
    return np.ones(len(part)) + sum((gap.shares for gap in gaps_of(part)), np.zeros(1))


def sigma_of(
    part: Blocks,
    gaps: Sequence[Gap],
    about: Array,
    name: str,
    noise: NoiseLevels,
    rate_sigma: float,
) -> float:
    """The sigma of the interpolated angle of all gaps together, rad, without noise.

    Parameters
    ----------
    about : (3,), axis of the turn; `name` of its manoeuvre
    rate_sigma : relative, of the table's rate
    """
    if not gaps:
        return 0.0
    seconds, steady = part.seconds, part.steady
    rate = np.nan_to_num(part.gyro) @ about
    elapsed = np.cumsum(seconds + part.missing) - seconds / 2
    density = np.nan_to_num(noise.of(name, "steady", GYRO))
    oscillation = _oscillation(name, noise, about, float(seconds.sum() / part.counts.sum()))
    # An oscillation slower than one period in a block is visible in the blocks.
    longest = float(np.median(seconds)) / (2 * np.pi)
    variance = sum(2 * (oscillation * min(gap.seconds, longest)) ** 2 for gap in gaps)

    steady_gaps = [gap for gap in gaps if steady[gap.before - 1] and steady[gap.before]]
    if steady_gaps:
        longest_gap = max(steady_gaps, key=lambda gap: gap.seconds)
        deviation = rate_deviation(
            rate[steady],
            seconds[steady],
            elapsed[steady],
            np.flatnonzero(steady) < longest_gap.before,
            longest_gap.seconds,
            float(np.linalg.norm(about * density)),
        )
        stated = rate_sigma * abs(float(np.average(rate[steady], weights=seconds[steady])))
        variance += (max(deviation, stated) * sum(gap.seconds for gap in steady_gaps)) ** 2
    change = np.abs(np.diff(rate)) / np.diff(elapsed)  # rad/s², from block to block
    for gap in gaps:
        if not any(gap is other for other in steady_gaps):
            largest = change[max(gap.before - 2, 0) : gap.before + 1].max()
            interval = elapsed[gap.before] - elapsed[gap.before - 1]
            variance += (largest * interval / 4 * gap.seconds) ** 2
    return float(np.sqrt(variance))


def _oscillation(name: str, noise: NoiseLevels, about: Array, step: float) -> float:
    """Scatter of the samples of the steady part about the axis beyond white noise, rad/s."""
    white = noise.of(name, "steady", GYRO) ** 2 / step
    excess = np.maximum(np.nan_to_num(noise.of_samples(name, "steady", GYRO) ** 2 - white), 0.0)
    return float(np.sqrt(about**2 @ excess))


# ---- Turns of which one was not what is stated: at another rate, or by another angle.
#
# The runs at a steady rate about one axis lie on a line, reading = bias + (1 + s) rate. One is off
# where a line through the others passes it by far more than it passes any of them. A sensor that is
# not linear leaves its line at the ends, so of a run beyond all others nothing is said, unless one
# goes as fast the other way.
#
# Turns by an angle read as many times that as the scale factors are, which are alike or nearly so:
# one that reads otherwise, by far more than the others differ, was another turn. An asymmetry of a
# gyro would move two of them, each as far; a scale factor all turns about its axis.

MIN_OTHERS = 4  # of runs on the line two more than it has parameters
MIN_OFF = 0.003  # of what is stated: less a table may be off, and effects of gyros do
LEAST_SPREAD = 1e-4  # of ratios: less is no more alike
MIN_RATIO = 10.0  # of what it is off to the largest that another is


def off_rate(stated: Array, read: Array, sigma: Array) -> tuple[int, float] | None:
    """The number of the run that is off and the rate that it had; None where none is.

    stated, read, sigma : (n,), rates about the axis, and what the readings are uncertain by, rad/s
    """
    found: list[tuple[float, int, float]] = []
    for one in range(len(stated)):
        others = np.arange(len(stated)) != one
        if others.sum() < MIN_OTHERS or np.abs(stated[one]) > np.abs(stated[others]).max():
            continue
        design = np.column_stack([np.ones(others.sum()), stated[others]])
        (bias, slope), *_ = np.linalg.lstsq(design, read[others], rcond=None)
        rate = (read[one] - bias) / slope
        left = np.abs(read[others] - design @ [bias, slope]).max()
        off = abs(rate - stated[one])
        ratio = off / max(left, sigma[one], sigma[others].max())
        if ratio > MIN_RATIO and off > MIN_OFF * abs(stated[one]):
            found.append((float(ratio), one, float(rate)))
    return max(found)[1:] if found else None


def off_ratio(ratios: Array, axes: Sequence[Hashable]) -> int | None:
    """The number of the turn whose recorded over stated angle is off; None where none is.

    ratios, axes : of the n turns
    """
    if len(ratios) <= MIN_OTHERS:
        return None
    one = int(np.argmax(np.abs(ratios - np.median(ratios))))
    if list(axes).count(axes[one]) < 2:
        return None
    others = np.delete(ratios, one)
    off = abs(ratios[one] - np.median(others))
    spread = max(float(np.abs(others - np.median(others)).max()), LEAST_SPREAD)
    return one if off > max(MIN_OFF, MIN_RATIO * spread) else None
