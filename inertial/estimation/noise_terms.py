"""The terms of the noise that the data of static stretches ask for, with sigma and limits.

Quantisation, white noise, bias instability, random walk and ramp (`noise_model`) are fitted to all
frequencies at once by restricted maximum likelihood (`noise_likelihood`). A term is detected where
leaving it out is significant (LEVEL): of a variance, half of a chi-squared distribution is at zero,
because it cannot be negative (Self and Liang, JASA 82, 1987, 605); the slope of the ramp is tested
by Student's t with Satterthwaite's degrees of freedom. A term that is not detected has an upper
limit. Where the data ask for a drift but do not tell which (bias instability, random walk, ramp:
another one in its place is hardly less likely), those form a class: none of them is detected, each
has an upper limit, and the model contains the likeliest.

Oscillations, bins that stand significantly above both their neighbours and the model, are marked
and not fitted. What the terms cannot describe, the fall of a sensor's own low-pass filter, is left
out from the lowest frequency at which it shows; where the terms behind one of the usual filters
describe it, that filter is in the model (`low_pass`). Quantisation comes after every filter, so it
is no larger than what is left out allows: what rises with the frequency within the band, and falls
beyond it, as a hand does that trembles, is none.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.estimation.low_pass import WHITE, LowPass, likeliest
from inertial.estimation.multiresolution import BINS_PER_OCTAVE, Bins, Lowest, Powers
from inertial.estimation.noise_likelihood import Fit, Likelihood
from inertial.estimation.noise_model import STOCHASTIC, TERMS, NoiseModel
from inertial.estimation.probability import chi2_isf, chi2_sf, t_isf, t_sf

LEVEL = 0.01  # chance that a term that is absent is detected
MIN_RISE = 1e-6  # of the deviance: less is rounding, whose root would be in the p-value
CLASS_RISE = 6.0  # of the deviance: a drift in place of another, 20 times less likely
QUANTISATION = "quantisation"
DRIFTS = ("bias_instability", "random_walk", "ramp")
INTERVAL = 0.05  # probability outside an interval
LIMIT = 0.05  # probability above an upper limit
LINE_LEVEL = 1e-3  # chance of any line in a channel
ROUNDING = 1e-20  # of the largest power density, that a channel has which stands still
NEIGHBOURS = 16  # bins on each side of a line that it is compared with
LINE_ROUNDS = 3
MAX_LEAKED = 0.1  # sigma of a bin, that may leak into it from an oscillation elsewhere
MISFIT_LEVEL = 1e-3
MAX_MISFIT = 0.01  # of the density over half an octave, that is accepted although significant
HALVES = 14  # half octaves by which the band is reduced at the most
MARGIN = 2  # half octaves more, where the fall of a filter is too small to be seen


@dataclass(frozen=True)
class Term:
    """One term of one channel; see `noise_model` for the units.

    detected: whether the data ask for it. If so, value and sigma, and `interval`, which covers it
    with 95 %; otherwise NaN, and `upper`, its upper limit, one-sided 95 %. p_value: of the data
    without it. alternatives: the drifts that the data do not tell from it.
    """

    name: str
    detected: bool
    value: float
    sigma: float
    interval: tuple[float, float]
    upper: float
    p_value: float
    alternatives: tuple[str, ...] = ()

    @property
    def most(self) -> float:
        """The largest that it may be."""
        return self.interval[1] if self.detected else self.upper


@dataclass(frozen=True, eq=False)
class NoiseTerms:
    """What the data say of the noise of a channel.

    terms: by name, in the order of TERMS; model: all that is in the data, of a class the likeliest
    (its ramp with sign); covariance: (5, 5), of the coefficients in the model; highest: Hz, the
    highest frequency that was fitted; lines: (l, 2), Hz, from and to, of oscillations; misfit:
    mean square of what is left over its expectation, 1 where the model describes the data;
    low_pass: behind which all terms but the quantisation are, where one is seen.
    """

    terms: dict[str, Term]
    model: NoiseModel
    covariance: Array
    highest: float
    lines: Array
    misfit: float
    low_pass: LowPass | None = None

    def density(self, frequency: Array, interval: float) -> Array:
        """That of both sides of the sampled rate, see `NoiseModel.density`, behind the low pass."""
        if self.low_pass is None:
            return self.model.density(frequency, interval)
        through = replace(self.model, quantisation=0.0).density(frequency, interval)
        after = NoiseModel(self.model.quantisation).density(frequency, interval)
        return np.asarray(through * self.low_pass.power(frequency) + after)


def noise_terms(powers: Powers, counts: Array | None = None) -> list[NoiseTerms | None]:
    """The terms of every channel; None where there is no stretch, or nothing but one value.

    `counts`: (c,), size of a count of each channel, NaN where its readings are not counted.

    None, too, where the power of some bins is no more than rounding: in all stretches that are long
    enough for these the channel stood still, and what is left of the others is no fair sample.
    """
    bins, lowest = powers.bins(), list(powers.lowest())
    rounding = np.zeros(powers.channels)
    if counts is not None:
        rounding = np.nan_to_num(counts) ** 2 / 12 * powers.interval
    return [
        _of_channel(bins, lowest, channel, density)
        for channel, density in enumerate(rounding.tolist())
    ]


def _of_channel(
    bins: Bins, lowest: Sequence[Lowest], channel: int, rounding: float
) -> NoiseTerms | None:
    density = bins.density[:, channel]
    if not len(density) or (density <= ROUNDING * density.max()).any():
        return None
    lines, leaked, within = _usable(bins, lowest, channel)
    passed = likeliest(bins, lowest, channel, lines, rounding)
    if passed is not None:
        own, beside, worst = _lines(passed.bins, passed.lowest, channel, passed.within)
        if worst <= 1:
            bins, lowest, within = passed.bins, passed.lowest, passed.within
            lines, leaked = own, beside
        else:
            passed = None
    used = ~leaked & within
    likelihood = Likelihood.of(bins, lowest, channel, used)
    likelihood, misfit = _widened(likelihood, bins.frequency[used])
    beyond = ~within & ~lines
    chosen = _Selection(likelihood, _largest_quantisation(bins, channel, beyond)).chosen()
    covariance = chosen.covariance.copy()
    if passed is not None:
        covariance[WHITE, WHITE] += (passed.spread * chosen.model.white_noise) ** 2
    return NoiseTerms(
        {name: chosen.term(name) for name in TERMS},
        chosen.model,
        covariance,
        float(bins.frequency[within].max()),
        _ranges(bins, lines),
        misfit,
        None if passed is None else passed.low_pass,
    )


# ---- Which terms


@dataclass(frozen=True)
class _Chosen:
    """The terms of a model, and everything that is told of them."""

    selection: "_Selection"
    names: frozenset[str]
    classes: dict[str, tuple[str, ...]]

    @cached_property
    def fit(self) -> Fit:
        return self.selection.fit(self.names)

    @property
    def model(self) -> NoiseModel:
        return NoiseModel(*map(float, (*np.sqrt(self.fit.variances), self.fit.slope)))

    @property
    def covariance(self) -> Array:
        result = np.zeros((5, 5))
        coefficients = np.sqrt(self.fit.variances)
        per_variance = np.divide(
            0.5, coefficients, out=np.zeros(4), where=coefficients > 0
        )  # of a square root
        result[:4, :4] = self.fit.covariance * np.outer(per_variance, per_variance)
        result[4, 4] = self.fit.slope_variance
        return result

    def term(self, name: str) -> Term:
        """What is told of a term."""
        names, nothing = self.names | {name}, (np.nan, np.nan)
        p_value = self.selection.p_value(names, name)
        if name not in self.names or name in self.classes:
            others = self.classes.get(name, ())
            # Of a class, each is largest where it is there alone.
            alone = names - {*others} if others else names
            upper = self.selection.upper(alone, name)
            return Term(name, False, np.nan, np.nan, nothing, upper, p_value, others)
        i = TERMS.index(name)
        sigma = float(np.sqrt(self.covariance[i, i]))
        value = abs(self.model.ramp) if name == "ramp" else getattr(self.model, name)
        interval = self.selection.interval(self.names, name)
        return Term(name, True, value, sigma, interval, np.nan, p_value)


class _Selection:
    """Fits of models of one channel, each made once; `largest_quantisation`: that is possible."""

    def __init__(self, likelihood: Likelihood, largest_quantisation: float = np.inf) -> None:
        self.likelihood = likelihood
        self.largest_quantisation = largest_quantisation
        self._fits: dict[tuple[frozenset[str], bool], Fit] = {}

    def fit(self, names: frozenset[str], *, restricted: bool = True) -> Fit:
        key = names, restricted
        if key not in self._fits:
            start = self._fits.get((frozenset(TERMS), True))
            self._fits[key] = self._larger(names, restricted) or self.likelihood.maximum(
                _places(names),
                "ramp" in names,
                restricted=restricted,
                start=start.variances if start is not None else None,
            )
        return self._fits[key]

    def _larger(self, names: frozenset[str], restricted: bool) -> Fit | None:
        """The fit of a larger model in which the further terms are zero: it is that of `names`."""
        for (others, alike), fit in self._fits.items():
            further = others - names
            smaller = names < others and alike == restricted and "ramp" not in further
            if smaller and not fit.variances[list(_places(further))].any():
                return fit
        return None

    def chosen(self) -> _Chosen:
        """The terms that are significant, quantisation only where it is possible."""
        names = self._significant(frozenset(TERMS))
        variance = self.fit(names).variances[STOCHASTIC.index(QUANTISATION)]
        if QUANTISATION in names and np.sqrt(variance) > self.largest_quantisation:
            names = self._significant(frozenset(TERMS) - {QUANTISATION})
        return _Chosen(self, names, self._classes(names))

    def _significant(self, every: frozenset[str]) -> frozenset[str]:
        """Of all, the least significant is left out, until all are significant."""
        names = every
        while len(names) > 1:
            p_values = {name: self.p_value(names, name) for name in names}
            worst = max(p_values, key=p_values.__getitem__)
            if p_values[worst] < LEVEL or not _places(names - {worst}):
                break
            names -= {worst}
        for name in TERMS:
            if name in every - names and self.p_value(names | {name}, name) < LEVEL:
                names |= {name}
        return names

    def p_value(self, names: frozenset[str], name: str) -> float:
        """Chance of data that ask for a term of a model at least as much, if it is absent."""
        with_it = self.fit(names)
        if name == "ramp":
            ratio = abs(with_it.slope) / np.sqrt(with_it.slope_variance)
            return 2 * float(t_sf(ratio, with_it.slope_degrees))
        if not _places(names - {name}):
            return 0.0
        rise = self.fit(names - {name}).deviance - with_it.deviance
        return float(chi2_sf(rise, 1)) / 2 if rise > MIN_RISE else 0.5

    def _classes(self, names: frozenset[str]) -> dict[str, tuple[str, ...]]:
        """Drifts of which another one in place of one is hardly less likely."""
        alike: dict[str, set[str]] = {}
        best = self.fit(names, restricted=False).deviance
        for own in names.intersection(DRIFTS):
            for other in set(DRIFTS) - names:
                swapped = self.fit(names - {own} | {other}, restricted=False)
                if swapped.deviance - best < CLASS_RISE:
                    alike.setdefault(own, set()).add(other)
                    alike.setdefault(other, set()).add(own)
        return {name: tuple(n for n in TERMS if n in others) for name, others in alike.items()}

    def interval(self, names: frozenset[str], name: str) -> tuple[float, float]:
        """Both ends of the interval of a term."""
        fit, ramp = self.fit(names), "ramp" in names
        if name == "ramp":
            half = float(t_isf(INTERVAL / 2, fit.slope_degrees) * np.sqrt(fit.slope_variance))
            return max(float(abs(fit.slope)) - half, 0.0), float(abs(fit.slope)) + half
        rise, j = float(chi2_isf(INTERVAL, 1)), STOCHASTIC.index(name)
        low, high = (
            self.likelihood.end_of_interval(fit, _places(names), ramp, j, rise, up)
            for up in (False, True)
        )
        return float(np.sqrt(low)), float(np.sqrt(high))

    def upper(self, names: frozenset[str], name: str) -> float:
        """The upper limit of a term in a model."""
        fit, ramp = self.fit(names), "ramp" in names
        if name == "ramp":
            sigma = np.sqrt(fit.slope_variance)
            return float(abs(fit.slope) + t_isf(LIMIT, fit.slope_degrees) * sigma)
        rise, j = float(chi2_isf(2 * LIMIT, 1)), STOCHASTIC.index(name)
        end = self.likelihood.end_of_interval(fit, _places(names), ramp, j, rise, True)
        limit = float(np.sqrt(end))
        return min(limit, self.largest_quantisation) if name == QUANTISATION else limit


def _places(names: frozenset[str]) -> tuple[int, ...]:
    return tuple(j for j, name in enumerate(STOCHASTIC) if name in names)


# ---- Which bins


def _usable(
    bins: Bins, lowest: Sequence[Lowest], channel: int
) -> tuple[Booleans, Booleans, Booleans]:
    """Of every bin: is an oscillation in it, does one leak into it, is it in the band that fits?"""
    top = float(bins.frequency.max()) * 1.01
    none = np.zeros(len(bins.frequency), bool)
    best, least, last = (none, none, ~none), np.inf, HALVES + MARGIN
    for half in range(HALVES + MARGIN + 1):
        within = bins.frequency < top * 2 ** (-half / 2)
        if half > last or within.sum() < 2 * NEIGHBOURS:
            break
        lines, leaked, worst = _lines(bins, lowest, channel, within)
        if worst < least or half == last:
            best, least = (lines, leaked, within), worst
        if worst <= 1 and last == HALVES + MARGIN:
            last = half + MARGIN if half else half
    return best


def _largest_quantisation(bins: Bins, channel: int, beyond: Booleans) -> float:
    """That of which the bins beyond the band have no more, at an upper limit; see `LIMIT`."""
    degrees, shape = bins.degrees[beyond], bins.shapes[STOCHASTIC.index(QUANTISATION), beyond]
    density = bins.density[beyond, channel] * degrees / chi2_isf(1 - LIMIT, degrees)
    return float(np.sqrt(np.min(density / shape, initial=np.inf)))


def _lines(
    bins: Bins, lowest: Sequence[Lowest], channel: int, within: Booleans
) -> tuple[Booleans, Booleans, float]:
    """Bins with oscillations, bins into which they leak, largest misfit over the accepted one.

    The misfit is that of the mean over half an octave.
    """
    density, degrees = bins.density[:, channel], bins.degrees
    beside = _beside(density)
    limit = chi2_isf(LINE_LEVEL / len(density), degrees) / degrees
    lines = density > limit * beside
    variances: Array | None = None
    leaked = _leaked_into(bins, density, beside, lines, within)
    for _ in range(LINE_ROUNDS):
        used = within & ~leaked
        likelihood = Likelihood.of(bins, lowest, channel, used)
        fit = likelihood.maximum(range(4), ramp=True, start=variances)
        variances = fit.variances
        expected = fit.variances @ bins.shapes
        found = density > limit * np.maximum(beside, expected)
        if np.array_equal(found, lines):
            break
        lines, leaked = found, _leaked_into(bins, density, beside, found, within)
    ratio, count, _place = _by_half_octave(
        bins.frequency[used], density[used] / expected[used], degrees[used]
    )
    significance = np.sqrt(chi2_isf(MISFIT_LEVEL / len(ratio), 1))
    accepted = np.maximum(MAX_MISFIT, significance * np.sqrt(2 / count))
    return lines, leaked, float(np.max(np.abs(ratio - 1) / accepted))


def _leaked_into(
    bins: Bins, density: Array, beside: Array, lines: Booleans, within: Booleans
) -> Booleans:
    """The bins with oscillations, and those into which too much of one leaks.

    The transform has no taper: of the power of an oscillation in a block, a coefficient k steps
    off has 2 / (π k)² on average. Where fewer bins of the band would be left than the median of
    neighbours needs, only the bins with oscillations are left out.
    """
    result = lines.copy()
    tolerated = MAX_LEAKED * beside * np.sqrt(2 / bins.degrees)
    for i in np.flatnonzero(lines).tolist():
        power = (density[i] - beside[i]) * bins.frequency[i] * np.log(2) / BINS_PER_OCTAVE
        apart = np.maximum(np.abs(bins.frequency - bins.frequency[i]), bins.spacing)
        leaked = power * bins.spacing * 2 / (np.pi * apart) ** 2
        result |= (bins.level == bins.level[i]) & (leaked > tolerated)
    if np.sum(within & ~result) < NEIGHBOURS:
        return lines
    return result


def _beside(density: Array) -> Array:
    """The median of the bins beside each, (b,)."""
    padded = np.pad(density, NEIGHBOURS, mode="reflect")
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * NEIGHBOURS + 1)
    return np.asarray(np.median(around, axis=1))


def _by_half_octave(
    frequency: Array, ratio: Array, degrees: Array
) -> tuple[Array, Array, Integers]:
    """Of each half octave the mean ratio, weighted by degrees of freedom, and their sum.

    And of each bin the place of its half octave among them.
    """
    _halves, place = np.unique(np.floor(2 * np.log2(frequency)), return_inverse=True)
    count = np.asarray(np.bincount(place, degrees), np.float64)
    return np.bincount(place, degrees * ratio) / count, count, place


def _widened(likelihood: Likelihood, frequency: Array) -> tuple[Likelihood, float]:
    """The likelihood with the degrees of freedom that the misfit of each half octave leaves."""
    fit = likelihood.maximum(range(4), ramp=True)
    ratio = likelihood.density / (fit.variances / likelihood.unit @ likelihood.shapes)
    mean, count, place = _by_half_octave(frequency, ratio, likelihood.degrees)
    squares = count * (mean - 1) ** 2 / 2
    excess = np.where(chi2_sf(squares, 1) < MISFIT_LEVEL / len(count), squares, 1.0)
    widened = replace(likelihood, degrees=likelihood.degrees / excess[place])
    return widened, float(np.mean(squares))


def _ranges(bins: Bins, lines: Booleans) -> Array:
    """From and to of bins with oscillations that touch, (l, 2), Hz."""
    frequency = bins.frequency[lines]
    if not len(frequency):
        return np.zeros((0, 2))
    apart = np.flatnonzero(np.diff(np.log2(frequency)) > 1.5 / BINS_PER_OCTAVE)
    starts, ends = np.append(0, apart + 1), np.append(apart, len(frequency) - 1)
    return np.column_stack([frequency[starts], frequency[ends]])
