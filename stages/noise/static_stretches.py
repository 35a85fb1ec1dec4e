"""Allan deviation, spectrum and terms of the noise of all static stretches together.

The rule for gaps and masks: a stretch is what was recorded at rest without a gap, without a masked
sample and in one manoeuvre, so no average spans any of these. Each stretch has a mean of its own,
for it has an attitude of its own. Stretches in which the same channels of a sensor are recorded at
the same rate, with about the same scatter, are pooled; of several such pools the one with the most
time counts. Where somebody drills next door for an hour the other hours tell the noise.

By hand an IMU may be shaken, or creep, in one rest so slowly that no two samples beside each other
show it. So there the means over longer times must scatter alike, too.

A support that tilts by ε drifts in an accelerometer by g ε where that is level, and by next to
nothing where it is upright. So by hand, on a desk or a cushion, a drift is the accelerometer's own
only if it drifts in the stretches in which it is upright, too; these are pooled besides.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from inertial.arrays import Array, Booleans, finite_or_none
from inertial.campaign.noise_levels import DRIFTS, MAX_P_VALUE, drift_of, drifts_of_axes
from inertial.campaign.records import Row
from inertial.estimation.allan import Allan, AllanSums, factors_up_to
from inertial.estimation.low_pass import LowPass
from inertial.estimation.multiresolution import MIN_WHOLE, Powers, Spectrum, WelchSums, segment_for
from inertial.estimation.noise_model import TERMS, NoiseModel
from inertial.estimation.noise_terms import QUANTISATION, NoiseTerms, noise_terms
from inertial.estimation.probability import f_sf
from inertial.sensors import COLUMNS
from inertial.tables import AXES

# ---- Whether a single manoeuvre changes by a step at rest, which the noise would take for a drift.
#
# A bias that jumps, or an IMU that is moved, within one manoeuvre looks there like a random walk,
# and a random walk of that size would hide it: every manoeuvre would be allowed to differ as much.
# A drift is in all. So where the static stretches of comparable length in other manoeuvres show
# none, what those of one manoeuvre show is no drift.

MOST_MEANS = 64  # of a stretch that are kept
LEAST_MEANS = 16
CLEAR = 60.0  # squared ratio of a step to its sigma
QUIET = 25.0  # the same, which noise alone exceeds in one of 500
COMPARABLE = 0.5  # of the length of a stretch, that others have at least
LEAST_OTHERS = 3
NORMAL = 0.6745  # median of |x| of a standard normal variable


@dataclass
class Course:
    """Means over equal parts of a stretch, piece by piece, in bounded memory; c channels."""

    means: list[Array] = field(default_factory=list)
    each: int = 1  # samples in a mean
    _rest: list[Array] = field(default_factory=list)

    def add(self, values: Array) -> None:
        """The next samples, (n, c)."""
        joined = np.concatenate([*self._rest, values])
        while (len(self.means) + len(joined) // self.each) > MOST_MEANS:
            if len(self.means) % 2:  # an odd one waits for the other half of its pair
                joined = np.concatenate([np.repeat(self.means[-1:], self.each, axis=0), joined])
                self.means.pop()
            self.means = [
                (a + b) / 2 for a, b in zip(self.means[::2], self.means[1::2], strict=True)
            ]
            self.each *= 2
        whole = len(joined) // self.each * self.each
        self.means += list(joined[:whole].reshape(-1, self.each, joined.shape[1]).mean(axis=1))
        self._rest = [joined[whole:]]

    def step(self) -> tuple[int, Array]:
        """Samples, and of each channel the largest squared ratio of a step to its sigma, (c,)."""
        k = len(self.means)
        if k < LEAST_MEANS:
            return 0, np.zeros(0)
        means = np.array(self.means)
        changes = np.abs(np.diff(means, axis=0))
        variance = (np.median(changes, axis=0) / NORMAL) ** 2 / 2
        sums, place = np.cumsum(means - means.mean(axis=0), axis=0)[:-1], np.arange(1, k)
        squares = sums**2 * (k / (place * (k - place)))[:, None]
        return k * self.each, squares.max(axis=0) / np.where(variance > 0, variance, np.inf)


@dataclass(frozen=True)
class Step:
    """Of the static stretch of a manoeuvre, see `Course.step`."""

    manoeuvre: str
    samples: int
    ratios: Array


def of_one_manoeuvre(steps: Sequence[Step], channels: int) -> Booleans:
    """Of which channels a single manoeuvre alone changes by a step at rest, (c,)."""
    known = [step for step in steps if step.samples]
    found = np.zeros(channels, bool)
    for step in known:
        least = COMPARABLE * step.samples
        others = [
            other.ratios
            for other in known
            if other.manoeuvre != step.manoeuvre and other.samples >= least
        ]
        if len(others) >= LEAST_OTHERS:
            found |= (step.ratios > CLEAR) & (np.array(others) < QUIET).all(axis=0)
    return found


# ---- Whether a stretch is as quiet as others: variances of means over 1, 2, 4, … samples.

LEAST_OF_MEANS = 8  # of which a variance is known well enough
SAME_VARIANCE = 9.0  # ratio of variances that are alike: desks and floors differ by less
MAX_CHANCE = 1e-4  # that of noise alone two variances differ so
INDEPENDENT = 2 / 3  # degrees of freedom of white noise for each difference of successive means


@dataclass
class SlowScatter:
    """Squares of half the differences of successive means, by averaging time 2^k samples.

    `squares`: (k, c) each; `counts`: (k,), differences in them.
    """

    squares: Array
    counts: Array

    @classmethod
    def of(cls, values: Array) -> "SlowScatter":
        """Of the samples (n, c) of one stretch."""
        squares, counts = [], []
        means = values
        while len(means) >= LEAST_OF_MEANS:
            squares.append((np.diff(means, axis=0) ** 2).sum(axis=0) / 2)
            counts.append(len(means) - 1.0)
            even = means[: len(means) // 2 * 2]
            means = (even[::2] + even[1::2]) / 2
        return cls(np.reshape(squares, (-1, values.shape[1])), np.array(counts))

    def add(self, other: "SlowScatter") -> None:
        """The stretches of the other, too."""
        few, more = sorted((self, other), key=lambda each: len(each.counts))
        squares, counts = more.squares.copy(), more.counts.copy()
        squares[: len(few.counts)] += few.squares
        counts[: len(few.counts)] += few.counts
        self.squares, self.counts = squares, counts

    def alike(self, other: "SlowScatter") -> bool:
        """Whether no variance is far from that of the other, and by more than chance."""
        both = min(len(self.counts), len(other.counts))
        if not both:
            return True
        counts = np.array([self.counts[:both], other.counts[:both]])[:, :, None]
        variance = np.array([self.squares[:both], other.squares[:both]]) / counts
        louder = np.take_along_axis(counts, variance.argmax(axis=0)[None], axis=0)[0]
        quieter = counts.sum(axis=0) - louder
        low, high = variance.min(axis=0), variance.max(axis=0)
        far = (high > SAME_VARIANCE * low) & (low > 0)  # a channel that stands still tells nothing
        ratio = high / np.where(low > 0, low, np.inf)
        chance = f_sf(ratio, INDEPENDENT * louder, INDEPENDENT * quieter)
        return not bool((far & (chance < MAX_CHANCE)).any())


# ---- All static stretches together.

StaticStretch = tuple[str, str, int]  # manoeuvre, phase, and its number there

SAME_INTERVAL = 1e-3  # relative difference of sampling intervals that are alike
SAME_SCATTER = 1.5  # ratio of scatters that are alike
PER_DECADE = 6  # averaging times
LONGEST_SHARE = 0.25  # of the longest stretch, that an averaging time may be
UPRIGHT = 0.98  # share of the specific force, from which on an accelerometer is upright
MAX_OWN_P_VALUE = 0.1  # where it is upright, of a drift that is known to be there: whose it is
UNITS = {  # of quantisation, white noise, bias instability, random walk and ramp
    "gyro": ("rad", "rad/√s", "rad/s", "rad/s/√s", "rad/s²"),
    "accel": ("m/s", "m/s/√s", "m/s²", "m/s²/√s", "m/s³"),
}


@dataclass
class _Pool:
    """The stretches in which some channels of a sensor are recorded at one rate.

    `scatter`: (c,), from sample to sample, where the first stretch begins; `slow`: of means, where
    each begins, by hand; `upright`: of the stretches in which an accelerometer is upright, by its
    number; `standing`: which are now.
    """

    sensor: str
    recorded: tuple[bool, ...]
    interval: float
    scatter: Array
    sums: AllanSums
    powers: Powers
    welch: WelchSums
    slow: SlowScatter
    upright: dict[int, Powers] = field(default_factory=dict)
    stretch: StaticStretch | None = None
    standing: tuple[int, ...] = ()
    samples: int = 0
    course: Course = field(default_factory=Course)
    steps: list[Step] = field(default_factory=list)

    @classmethod
    def of(
        cls,
        sensor: str,
        recorded: tuple[bool, ...],
        interval: float,
        scatter: Array,
        longest: int,
    ) -> "_Pool":
        factors = factors_up_to(max(int(LONGEST_SHARE * longest), 1), PER_DECADE)
        channels = sum(recorded)
        return cls(
            sensor,
            recorded,
            interval,
            scatter,
            AllanSums(channels, factors),
            Powers(channels, interval),
            WelchSums(channels, interval, segment_for([longest])),
            SlowScatter.of(np.zeros((0, channels))),
        )

    def add(self, stretch: StaticStretch, values: Array) -> None:
        if stretch != self.stretch:
            self.end()
            self.stretch = stretch
            force = np.abs(values.mean(axis=0))
            known = self.sensor == "accel" and all(self.recorded)
            upright = np.flatnonzero(force > UPRIGHT * np.linalg.norm(force)) if known else ()
            self.standing = tuple(map(int, upright))
        for sums in (self.sums, self.powers, self.welch, self.course):
            sums.add(values)
        for i in self.standing:
            own = self.upright.setdefault(i, Powers(1, self.interval))
            own.add(values[:, i : i + 1])
        self.samples += len(values)

    def takes(
        self, sensor: str, recorded: tuple[bool, ...], interval: float, scatter: Array
    ) -> bool:
        """Whether a stretch belongs here."""
        alike = (self.sensor, self.recorded) == (sensor, recorded)
        if not alike or abs(interval / self.interval - 1) >= SAME_INTERVAL:
            return False
        smaller, larger = np.sort([scatter, self.scatter], axis=0)
        return bool((larger <= SAME_SCATTER * smaller).all())

    def end(self) -> None:
        for sums in (self.sums, self.powers, self.welch):
            sums.end()
        for powers in self.upright.values():
            powers.end()
        if self.stretch is not None:
            self.steps.append(Step(self.stretch[0], *self.course.step()))
        self.course = Course()

    @property
    def channels(self) -> list[str]:
        axes = zip(AXES, self.recorded, strict=True)
        return [f"{self.sensor}_{axis}" for axis, there in axes if there]


@dataclass
class StaticStretches:
    """Takes in the samples at rest piece by piece, in bounded memory.

    `longest`: records of the longest stretch, as planned from the segments; `by_hand`: whether the
    support may tilt.
    """

    longest: int
    by_hand: bool = False
    _pools: list[_Pool] = field(default_factory=list)

    def add(self, stretch: StaticStretch, values: Array, interval: float) -> None:
        """The next samples (n, 6) of a stretch; NaN where a channel, or a sensor, is not there."""
        for sensor, columns in COLUMNS.items():
            part = values[:, columns]
            there = np.isfinite(part)
            if not there.all():
                rows = there.any(axis=1)
                part, there = part[rows], there[rows]
            recorded = tuple(bool(each) for each in np.all(there, axis=0))
            if len(part) and any(recorded):
                own = part[:, np.array(recorded)]
                self._pool(stretch, sensor, recorded, interval, own).add(stretch, own)

    def _pool(
        self,
        stretch: StaticStretch,
        sensor: str,
        recorded: tuple[bool, ...],
        interval: float,
        values: Array,
    ) -> _Pool:
        kind = (sensor, recorded, interval)
        known = [pool for pool in self._pools if pool.takes(*kind, pool.scatter)]
        for pool in known:
            if pool.stretch == stretch:
                return pool  # it goes on
        enough = len(values) >= MIN_WHOLE
        scatter = np.diff(values, axis=0).std(axis=0) if enough else np.zeros(values.shape[1])
        slow = SlowScatter.of(values if enough and self.by_hand else values[:0])
        for pool in sorted(known, key=lambda pool: -pool.samples):  # a short one is like many
            if not enough or (pool.takes(*kind, scatter) and pool.slow.alike(slow)):
                break
        else:
            pool = _Pool.of(*kind, scatter, self.longest)
            self._pools.append(pool)
        pool.slow.add(slow)
        return pool

    def noises(self, counts: Array) -> Iterator["SensorNoise"]:
        """The noise of each sensor, where there is a stretch that is long enough.

        `counts`: (6,), see `noise_terms`.
        """
        for sensor in COLUMNS:
            own = [pool for pool in self._pools if pool.sensor == sensor]
            for pool in sorted(own, key=lambda pool: -pool.samples * pool.interval)[:1]:
                pool.end()
                if max(pool.powers.seconds, default=0.0) >= MIN_WHOLE * pool.interval:
                    own_counts = counts[COLUMNS[sensor]][np.array(pool.recorded)]
                    yield _noise_of(pool, self.by_hand, own_counts)


class Filtered(NamedTuple):
    """A low pass, and the white noise that it is given."""

    low_pass: LowPass
    white_noise: float


@dataclass(frozen=True)
class SensorNoise:
    """The noise of the c recorded channels of a sensor.

    `interval`: s, between samples; `seconds`: of the longest stretch; `usual`: of the median one;
    `stepped`: (c,), whether one manoeuvre alone changes by a step at rest, so that what it shows as
    a drift is none; `of_bias`: by which terms the biases drift, by hand without the support where
    that tilts.
    """

    sensor: str
    channels: list[str]
    terms: list[NoiseTerms | None]
    allan: Allan
    spectrum: Spectrum
    interval: float
    seconds: float
    usual: float
    stepped: Booleans
    of_bias: list[NoiseTerms | None]

    @property
    def quantised(self) -> dict[str, NoiseModel]:
        """Quantisation and white noise of the channels that certainly have the former.

        White noise that does not show beside it is as large as it may be.
        """
        return {
            channel: NoiseModel(
                terms.model.quantisation,
                terms.model.white_noise or terms.terms["white_noise"].most,
            )
            for channel, terms in zip(self.channels, self.terms, strict=True)
            if terms is not None
            and terms.model.quantisation
            and terms.terms[QUANTISATION].p_value < MAX_P_VALUE
        }

    @property
    def filtered(self) -> dict[str, Filtered]:
        """The low pass behind which the noise of channels is, and their white noise before it."""
        return {
            channel: Filtered(terms.low_pass, terms.model.white_noise)
            for channel, terms in zip(self.channels, self.terms, strict=True)
            if terms is not None and terms.low_pass is not None and terms.model.white_noise
        }

    def drifts(
        self, sheet: Mapping[str, Mapping[str, float | None]]
    ) -> Iterator[tuple[str, dict[str, float | None]]]:
        """What enters the covariance, by channel; `sheet`: see `term_rows`."""
        stated = [sheet[channel].get("bias_instability") for channel in self.channels]
        shown = [
            None if stepped else terms
            for terms, stepped in zip(self.of_bias, self.stepped, strict=True)
        ]
        pairs = zip(shown, stated, strict=True)
        drifts = drifts_of_axes([drift_of(*pair, self.seconds) for pair in pairs], self.of_bias)
        for channel, drift, figure in zip(self.channels, drifts, stated, strict=True):
            own: dict[str, float | None] = {**drift, "data_sheet": figure}
            if channel in self.quantised:
                own["quantisation"] = self.quantised[channel].quantisation
            if channel in self.filtered:
                own["delay"] = self.filtered[channel].low_pass.delay
            yield channel, own

    def allan_rows(self) -> Iterator[Row]:
        """Rows of the table."""
        allan = self.allan
        for i, (channel, terms) in enumerate(zip(self.channels, self.terms, strict=True)):
            model = np.sqrt(terms.model.allan_variance(allan.tau)) if terms else None
            for j, tau in enumerate(allan.tau.tolist()):
                if allan.deviation[j, i] > 0:
                    yield {
                        "channel": channel,
                        "tau": tau,
                        "deviation": float(allan.deviation[j, i]),
                        "lower": float(allan.lower[j, i]),
                        "upper": float(allan.upper[j, i]),
                        "degrees": float(allan.degrees[j, i]),
                        "model": None if model is None else float(model[j]),
                        "stretches": int(allan.stretches[j]),
                    }

    def spectrum_rows(self) -> Iterator[Row]:
        """Rows of the table."""
        spectrum = self.spectrum
        for i, (channel, terms) in enumerate(zip(self.channels, self.terms, strict=True)):
            if terms is None:
                continue
            model = terms.density(spectrum.frequency, self.interval)
            line = spectrum.in_ranges(terms.lines)
            for j, frequency in enumerate(spectrum.frequency.tolist()):
                yield {
                    "channel": channel,
                    "frequency": frequency,
                    "density": float(spectrum.density[j, i]),
                    "degrees": float(spectrum.degrees[j]),
                    "model": float(model[j]),
                    "line": bool(line[j]),
                }

    def term_rows(self, sheet: Mapping[str, Mapping[str, float | None]]) -> Iterator[Row]:
        """Rows of the table; `sheet`: figures of the data sheet by channel and term."""
        for i, (channel, terms) in enumerate(zip(self.channels, self.terms, strict=True)):
            if terms is None:
                continue
            for name, unit in zip(TERMS, UNITS[self.sensor], strict=True):
                term = terms.terms[name]
                yield {
                    "channel": channel,
                    "term": name,
                    "detected": term.detected,
                    "stepped": bool(self.stepped[i]),
                    "tilted": self.of_bias[i] is not terms,
                    "value": finite_or_none(term.value),
                    "sigma": finite_or_none(term.sigma),
                    "upper": finite_or_none(term.upper),
                    "unit": unit,
                    "p_value": finite_or_none(term.p_value),
                    "data_sheet": sheet[channel].get(name),
                    "seconds": self.seconds,
                }


def _noise_of(pool: _Pool, by_hand: bool, counts: Array) -> SensorNoise:
    terms = noise_terms(pool.powers, counts)
    models = [NoiseModel(white_noise=1.0) if each is None else each.model for each in terms]
    return SensorNoise(
        pool.sensor,
        pool.channels,
        terms,
        pool.sums.result(pool.interval, models),
        pool.welch.spectrum(),
        pool.interval,
        max(pool.powers.seconds),
        float(np.median(pool.powers.seconds)),
        of_one_manoeuvre(pool.steps, len(pool.channels)),
        [_without_support(pool, i, t) for i, t in enumerate(terms)] if by_hand else terms,
    )


def _without_support(pool: _Pool, channel: int, terms: NoiseTerms | None) -> NoiseTerms | None:
    """The terms of a channel, or those where it is upright if these contradict its drift."""
    powers, drift = pool.upright.get(channel), drift_of(terms)
    if not drift or not powers or max(powers.seconds, default=0.0) < MIN_WHOLE * pool.interval:
        return terms
    upright = noise_terms(powers)[0]
    if upright is None:
        return terms
    shows = any(upright.terms[name].p_value < MAX_OWN_P_VALUE for name in DRIFTS)
    within = all(size <= upright.terms[name].most for name, size in drift.items())
    return terms if shows and within else upright
