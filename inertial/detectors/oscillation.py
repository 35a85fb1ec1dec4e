"""A case that rings."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.signal.detector import Description, Detector, Event, Log, Piece, channel_name, read_in
from inertial.signal.tones import Tone, tones
from inertial.text.messages import _
from inertial.text.numbers import significant

MIN_TURN_RATE = 0.03  # rad/s, which no table does at rest
MAX_GYRO_BIAS = 0.1  # rad/s, which no gyro reads at rest
BLOCK_READINGS = 128  # readings whose mean rate is taken
MIN_MAJORITY = 0.9  # of the time of an oscillation
MIN_REST_BLOCKS = 3  # blocks at rest without it, for it to be absent at rest
MIN_WINDOWS = 3  # at rest, or in turns, by which its amplitude there is known
MAX_ABSENT_SHARE = 0.2  # of its amplitude elsewhere: where it has less it is absent
MAX_EQUAL_SHARE = 0.8  # the same: where it has more it is as large there
MIN_PRESENT_SIGMAS = 3.0  # of its square, by noise
MAX_TREMOR_HZ = 15.0  # of a hand; physiological tremor has 4 to 12 Hz (Elble & Koller 1990)
MEAN_S = 0.3  # s, of whole periods, after which the mean rate is compared with that before
MAX_STEADY_CHANGE = 0.1  # of it from one mean to the next: no table's steady turn changes by more

WHILE_TURNING = _(
    "Nothing is changed: over many periods it averages out. On a table look for a loose screw, and "
    "for a drive, fan or pump nearby, and switch that off to see whether it is that; where a hand "
    "turns the IMU, it may be the hand that shakes."
)
AT_REST_TOO = _(
    "Nothing is changed: over many periods it averages out. Look for a loose screw, and for a "
    "drive, fan or pump nearby, and switch that off to see whether it is that."
)


@dataclass(frozen=True)
class Ringing:
    """What the description of an oscillation needs.

    tone: the largest; others: the same in other channels; besides: Hz, what its channel has at the
    same time; turning: share of its time in which the IMU turned, NaN without gyros; not_at_rest:
    the IMU was at rest without it, not_turning: it turned without it.
    at_rest, in_turns: its amplitudes, where it has both and they differ.
    """

    tone: Tone
    besides: tuple[float, ...]
    turning: float
    not_at_rest: bool
    not_turning: bool = False
    at_rest: float = np.nan
    in_turns: float = np.nan


class Oscillation(Detector):
    """A significant line in the spectra of a channel that keeps its phase.

    It is seen in windows of 256 readings, from 8 periods a window on and in four windows at least;
    its frequency is that by which the phase stays the same from window to window, its edges are
    those that are most likely reading by reading. A log of 24 to 64 readings is examined as a
    whole. Where several channels have it, the finding names the one with the largest amplitude, of
    the sensor with the best signal-to-noise ratio; coherent lines of others may be coupling.
    Motion by hand, ramps and coloured noise rise above their own spectrum on one side only, or
    keep no phase. The tremor of a hand may keep it over one motion: what has its frequency, and is
    there only while the IMU turns at rates that change, as no table's do, is the motion itself.

    Cause: the case, a loose screw, the drive of the table or the electronics ring. Angles and means
    over part of a turn are off, and the noise level, if it counts as noise.
    """

    name = "oscillation"
    source = "S0, figures 5-14 to 5-16: 20 Hz, 0.01 rad/s about x while the table turns"
    severity = 1

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        detected = sorted(tones(piece, log), key=lambda tone: -tone.clear)
        if not detected:
            return
        turning = _turning(piece, log)
        for tone, besides in sorted(_apart(detected), key=lambda one: one[0].start):
            alike = [one for one in detected if abs(one.frequency - tone.frequency) < one.resolved]
            without = turning.copy()
            for one in alike:
                without[one.start : one.end] = np.nan
            inside = turning[tone.start : tone.end]
            known = inside[np.isfinite(inside)]
            of_its_time = Ringing(
                tone,
                besides,
                float(known.mean()) if len(known) else np.nan,
                int(np.count_nonzero(without == 0)) >= MIN_REST_BLOCKS * BLOCK_READINGS,
            )
            ringing = _by_circumstance(of_its_time, turning)
            in_motion = MIN_MAJORITY if ringing is not of_its_time else 1 - MIN_MAJORITY
            if ringing.turning > in_motion and _is_tremor(tone, piece.values[:, 3:]):
                continue
            yield piece.event(
                tone.start,
                tone.end,
                ringing.tone.amplitude,
                channel=tone.channel,
                p_value=tone.p_value,
                facts=ringing,
            )

    def describe(self, event: Event, name: str) -> Description:
        ringing: Ringing = event.facts
        tone = ringing.tone
        (scale, unit), rate = read_in(tone.channel), tone.rate
        others = _(" and ").join(
            _(
                "{channel_name} by {significant} {value}",
                channel_name=channel_name(i),
                significant=significant(read_in(i)[0] * size, 2),
                value=read_in(i)[1],
            )
            for i, size in tone.others
        )
        besides = _(" and ").join(f"{frequency:.2f} Hz" for frequency in ringing.besides)
        return Description(
            _(
                "{name}: {channel} oscillates at {frequency:.2f} Hz by {size} {unit}, from "
                "{from_s:.2f} s to {to_s:.2f} s{ringing}.",
                name=name,
                channel=channel_name(tone.channel),
                frequency=tone.frequency,
                size=significant(scale * event.size, 2),
                unit=unit,
                from_s=event.from_s,
                to_s=event.to_s,
                ringing=_when(ringing),
            )
            + (
                _(" In step with it {others}, which may be coupling.", others=others)
                if others
                else ""
            )
            + (_(" It has {besides} as well.", besides=besides) if besides else "")
            + _(
                " At {rate:.4g} samples per second {rate_2:.2f} or {rate_3:.2f} Hz cannot be "
                "distinguished from it.",
                rate=rate,
                rate_2=rate - tone.frequency,
                rate_3=rate + tone.frequency,
            ),
            _consequence(tone, ringing.not_at_rest and ringing.turning > MIN_MAJORITY),
            WHILE_TURNING if ringing.turning > MIN_MAJORITY else AT_REST_TOO,
        )


def _when(ringing: Ringing) -> str:
    if not np.isfinite(ringing.turning):
        return ""
    if ringing.turning > MIN_MAJORITY:
        return _(", while the IMU turns") + (_(", and not at rest") if ringing.not_at_rest else "")
    if ringing.turning < 1 - MIN_MAJORITY:
        return _(", at rest") + (_(", and not while the IMU turns") if ringing.not_turning else "")
    if np.isfinite(ringing.at_rest):
        scale, unit = read_in(ringing.tone.channel)
        return _(
            ", at rest by {at_rest} {unit} and while the IMU turns by {in_turns} {unit}",
            at_rest=significant(scale * ringing.at_rest, 2),
            in_turns=significant(scale * ringing.in_turns, 2),
            unit=unit,
        )
    return _(", at rest and while the IMU turns")


def _by_circumstance(ringing: Ringing, turning: Array) -> Ringing:
    """The same with the amplitude of where it is: at rest, while the IMU turns, or both.

    By windows that lie in one of the two as a whole. `turning`: of each record, (n,), 1 or 0.
    """
    tone = ringing.tone
    at_rest, in_turns = (_wholly(tone, turning, state) for state in (0.0, 1.0))
    if min(int(at_rest.sum()), int(in_turns.sum())) < MIN_WINDOWS:
        return ringing
    (rest, rest_sigma), (turn, turn_sigma) = map(tone.by_window.size, (at_rest, in_turns))
    larger = max(rest, turn)
    smaller, sigma = (rest, rest_sigma) if rest < turn else (turn, turn_sigma)
    if larger <= 0:
        return ringing
    size = replace(tone, amplitude=float(np.sqrt(larger)))
    if smaller < max(MAX_ABSENT_SHARE**2 * larger, MIN_PRESENT_SIGMAS * sigma):
        at_most = smaller + MIN_PRESENT_SIGMAS * sigma
        absent = at_most < (2 * MAX_ABSENT_SHARE) ** 2 * larger
        return replace(
            ringing,
            tone=size,
            turning=float(turn > rest),
            not_at_rest=absent and turn > rest,
            not_turning=absent and rest > turn,
        )
    if smaller > MAX_EQUAL_SHARE**2 * larger:
        return replace(ringing, turning=0.5)
    in_both = replace(ringing, at_rest=float(np.sqrt(rest)), in_turns=float(np.sqrt(turn)))
    return replace(in_both, tone=size, turning=0.5)


def _wholly(tone: Tone, turning: Array, state: float) -> Booleans:
    """Which windows of a tone lie at rest, 0, or in turns, 1, with a block before and after, (k,).

    Without these blocks where hardly a window has them.
    """
    alike = np.append(0, np.cumsum(turning == state))
    for beside in (BLOCK_READINGS, 0):
        first = np.maximum(tone.by_window.places[:, 0] - beside, 0)
        after = np.minimum(tone.by_window.places[:, 1] + 1 + beside, len(turning))
        within = np.asarray(alike[after] - alike[first] == after - first, bool)
        if within.sum() >= MIN_WINDOWS:
            break
    return within


def _consequence(tone: Tone, only_turning: bool) -> str:
    """A sine of amplitude A has an integral of ±A / (2πf), and a mean over T of ±A / (πfT)."""
    scale, unit = read_in(tone.channel)
    swing = tone.amplitude / (2 * np.pi * tone.frequency)
    mean = _(
        "A mean over 1 s is off by up to {significant} {unit}, over 100 s by up to "
        "{significant_2} {unit}.",
        significant=significant(2 * scale * swing, 2),
        unit=unit,
        significant_2=significant(scale * swing / 50, 2),
    )
    if tone.channel < 3:
        return _("{mean} Bias and scale factor from long rests hardly notice.", mean=mean)
    parts = [significant(swing / turn * 1e6, 2) for turn in (2 * np.pi, np.pi)]
    return _(
        "The angle swings by {swing}°: at most {parts} ppm of a turn of 360°, "
        "{parts_2} ppm of one of 180°.{value} {mean}",
        swing=significant(scale * swing, 3),
        parts=parts[0],
        parts_2=parts[1],
        value=_(" Summed from rest to rest it adds nothing.") if only_turning else "",
        mean=mean,
    )


def _turning(piece: Piece, log: Log) -> Array:
    """Whether the IMU turns, 1, or is at rest, 0, by blocks of records, (n,); NaN without gyros."""
    means = log.windows.mean[:, 3:]
    means = means[np.isfinite(means).all(axis=1)]
    rates = piece.values[:, 3:]
    turning = np.full(len(rates), np.nan)
    if not len(means):
        return turning
    rest = means[np.argmin(np.linalg.norm(means, axis=1))]
    rest = rest if np.linalg.norm(rest) < MAX_GYRO_BIAS else np.zeros(3)
    for start in range(0, len(rates), BLOCK_READINGS):
        block = rates[start : start + BLOCK_READINGS]
        block = block[np.isfinite(block).all(axis=1)]
        if len(block):
            away = float(np.linalg.norm(block.mean(axis=0) - rest))
            turning[start : start + BLOCK_READINGS] = away > MIN_TURN_RATE
    return turning


def _is_tremor(tone: Tone, rates: Array) -> bool:
    """Whether it is of a hand that turns the IMU, by the rates of the piece, (n, 3), rad/s."""
    if tone.frequency > MAX_TREMOR_HZ:
        return False
    length = round(np.ceil(MEAN_S * tone.frequency) * tone.rate / tone.frequency)
    inside = rates[tone.start : tone.end]
    means = inside[: len(inside) // length * length].reshape(-1, length, 3).mean(axis=1)
    larger = np.maximum(*(np.linalg.norm(each, axis=1) for each in (means[:-1], means[1:])))
    turning = larger > MIN_TURN_RATE
    if not turning.any():
        return False
    change = np.linalg.norm(np.diff(means, axis=0), axis=1)[turning] / larger[turning]
    return float(np.median(change)) > MAX_STEADY_CHANGE


def _apart(detected: Sequence[Tone]) -> Iterator[tuple[Tone, tuple[float, ...]]]:
    """Of tones of one channel at the same time the clearest, and the frequencies of the others."""
    taken: list[list[Tone]] = []
    for tone in detected:
        for group in taken:
            first = group[0]
            if tone.channel == first.channel and tone.start < first.end and first.start < tone.end:
                group.append(tone)
                break
        else:
            taken.append([tone])
    for first, *others in taken:
        yield first, tuple(other.frequency for other in others)
