"""Counts that are coarser than stated, or than the noise."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array
from inertial.sensors import CHANNELS
from inertial.signal.detector import Description, Detector, Event, Log, Piece, read_in
from inertial.signal.scatter import (
    BLOCK,
    in_blocks,
    noise_before_rounding,
    roughness,
    smallest_step,
)
from inertial.text.messages import _
from inertial.text.numbers import significant

MAX_CHANCE = 1e-6  # chance that all changes are multiples of k counts, in the channels of 12 logs
TESTS = 6 * 12
MIN_BLOCK_SHARE = 0.5  # of the blocks
MIN_LARGE_CHANGE = 1.5  # steps: a change by two steps or more
MAX_MULTIPLE_ERROR = 0.01  # counts: by how much a multiple of a count may be off


@dataclass(frozen=True)
class Steps:
    """The steps of some axes of a sensor.

    noise: in steps, the least of them; stated: one count, unit of the channel, NaN if it is not.
    """

    axes: str
    noise: float
    stated: float
    increments: bool


class Quantisation(Detector):
    """A channel whose readings go in steps larger than they should.

    Larger than the stated count: all changes are multiples of k counts, which M changes in steps
    of one count are with the chance k^−M. Or larger than the noise: in most blocks of 64 readings
    no change is of two steps, that is for noise σ of less than 0.37 steps q, of increments 0.2.
    Then many readings are no better than one: their mean is off by up to (q/π) exp(−2π² σ²/q²),
    0.02 q for σ = 0.37 q, 0.14 q for 0.2 q. Increments that carry over what a count leaves lose
    nothing: a sum of them is good to one count.

    Cause: the converter, its range, or the format of the log has fewer digits than needed.
    """

    name = "quantisation"
    source = "Widrow & Kollár, Quantization Noise, 2008: the mean of a rounded Gaussian"
    severity = 1
    alike = "sensor"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        events: dict[tuple[str, float], list[Event]] = {}
        for i in range(6):
            event = _of_channel(piece, log, i)
            if event is not None:
                events.setdefault((CHANNELS[i][:-2], float(f"{event.size:.6g}")), []).append(event)
        for own in events.values():
            yield _together(own)

    def describe(self, event: Event, name: str) -> Description:
        assert event.channel is not None
        facts, (scale, unit) = event.facts, read_in(event.channel)
        sensor = "accelerometer" if event.channel < 3 else "gyro"
        step, times = significant(scale * event.size, 4), event.size / facts.stated
        off = event.size / np.pi * float(np.exp(-2 * (np.pi * facts.noise) ** 2))
        of_stated = _(", {times:.0f} times the stated count", times=times) if times > 1.5 else ""
        if facts.increments:
            consequence = _(
                "None for sums: what a count leaves over goes into the next increment, so a sum "
                "of any number of them is good to one step, {step} {unit} for one interval.",
                step=step,
                unit=unit,
            )
        elif off < event.size / 1000:
            consequence = _(
                "None for means: the noise is {noise} steps, which averages them out. But what "
                "is stated of the counts is not what the log has.",
                noise=significant(facts.noise, 2),
            )
        else:
            consequence = _(
                "The noise is {noise} steps, so a mean of any length may be off by {off} "
                "{unit}; the sigmas include it.",
                noise=significant(facts.noise, 2),
                off=significant(scale * off, 2),
                unit=unit,
            )
        return Description(
            _(
                "{name}: the steps of {sensor} {axes} are {step} {unit}{of_stated}.",
                name=name,
                sensor=sensor,
                axes=", ".join(facts.axes),
                step=step,
                unit=unit,
                of_stated=of_stated,
            ),
            consequence,
            _("Nothing is changed. ")
            + (
                _("Compare the count size with the data sheet and the range that was set.")
                if of_stated
                else _("Choose a smaller range, or a format with more digits.")
            ),
        )


def _of_channel(piece: Piece, log: Log, i: int) -> Event | None:
    """The event of one channel, if there is one."""
    places, values = piece.channel(i)
    step = smallest_step(values)
    if len(values) <= BLOCK or not np.isfinite(step):
        return None
    stated = float(log.count[i])
    changes = np.abs(np.diff(values))
    times, chance = _coarser(changes[changes > step / 2], stated)
    step = stated * times if times > 1 else step
    blocks = in_blocks(np.abs(np.diff(values)) / step)
    fine = (blocks > MIN_LARGE_CHANGE).any(axis=1)
    coarse = fine.mean() < MIN_BLOCK_SHARE
    if times == 1 and not coarse:
        return None
    variance = float(np.mean(blocks[~fine] ** 2) / 2) if coarse else (roughness(values) / step) ** 2
    noise = float(noise_before_rounding(variance)) if coarse else float(np.sqrt(variance))
    return piece.event(
        int(places[0]),
        int(places[-1]) + 1,
        step,
        channel=i,
        p_value=chance if times > 1 else None,
        severity=2 if coarse and not log.increments else 1,
        facts=Steps(CHANNELS[i][-1], noise, stated, log.increments),
    )


def _together(events: list[Event]) -> Event:
    """Axes of a sensor with the same steps as one event, under the first of them."""
    least = min(events, key=lambda event: float(event.facts.noise))
    axes = "".join(event.facts.axes for event in events)
    return replace(
        events[0],
        facts=replace(least.facts, axes=axes),
        severity=max(event.severity or 1 for event in events),
    )


def _coarser(changes: Array, count: float) -> tuple[int, float]:
    """How many counts all changes are multiples of, and the chance of that; 1 if of one."""
    counts = changes / count
    if not np.isfinite(count) or (np.abs(counts - np.rint(counts)) > MAX_MULTIPLE_ERROR).any():
        return 1, 1.0
    times = int(np.gcd.reduce(np.rint(counts).astype(np.int64)))
    chance = min(TESTS * float(times) ** -len(counts), 1.0) if times > 1 else 1.0
    return (times, chance) if chance < MAX_CHANCE else (1, 1.0)
