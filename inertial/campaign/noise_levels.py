"""The effective white noise of each mean and each sum: that of the campaign, or a level of its own.

A level is known to some per cent only, and a sensor alone has the same in every manoeuvre. So the
level that is common to the campaign is taken, but for a manoeuvre and phase whose own level differs
from it by more than chance: there the table, or the air, adds to the noise. Where the others
together scatter by more than chance, as on a table that shakes sideways, whose horizontal axes are
louder, each is between its own and the common one.

Where counts are coarse beside the noise, and do not carry over what they leave, the mean of a
manoeuvre is off by their rounding however long it is; a level beside its own holds that.

A white noise of the angle, the quantisation of IEEE Std 952, is no level: it makes every sum as
uncertain by its two ends, however long it is. So it stands beside the level, which is without it.

Beside the common level of a channel stand the bias instability and the random walk that the static
stretches show, or the bias instability of the data sheet as far as these leave it open. From here
they enter the covariance of every estimate, and from nowhere else.
"""

from collections.abc import Mapping, Sequence
from functools import cached_property
from operator import itemgetter

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, Booleans
from inertial.campaign.records import Row, grouped, rows_of
from inertial.estimation.noise_model import FLOOR_VARIANCE
from inertial.estimation.noise_terms import NoiseTerms
from inertial.estimation.probability import chi2_sf
from inertial.estimation.random_walk import MeasuredDrift

Key = tuple[str | None, str | None, str]  # manoeuvre, phase, channel

MIN_SCATTER_RATIO = 1.5  # of a rate segment to static positions, from which a channel oscillates
LEVEL_P_VALUE = 2.7e-3  # that any level of a channel differs so by chance: three sigma
DRIFTS = ("bias_instability", "random_walk")  # terms of the noise
MAX_P_VALUE = 1e-3  # of a drift that enters: of 12 that are absent, one in a campaign of a hundred
LEVEL_COLUMNS = [column.name for column in tables.LEVELS.columns]
LEAST_ALIKE = 2  # axes with a bias instability, by which the third has one too
MAX_ALIKE_P_VALUE = 0.1  # of an axis beside a single one: a drift that is known to be there
MAX_STATED_RATIO = 1.5  # of a bias instability to the data sheet's, from which it is unexpected
MIN_NOISE_RECORDING_S = 1800.0  # s, of a rest that is recorded for its noise
OWN, BETWEEN, COMMON = "own", "between", "common"
STATED, RESIDUALS = "stated", "residuals"  # of means without time


def drift_of(
    terms: NoiseTerms | None, stated: float | None = None, seconds: float = np.inf
) -> dict[str, float]:
    """What of the terms of a channel enters the covariance, by name.

    Of drifts that the data do not distinguish that is the likeliest. The bias instability that the
    data sheet states, `stated`, goes on for longer than static stretches are: it stands for one
    that they do not show, or show less of, as far as their upper limit leaves it open; and for a
    random walk that they do not tell from it and that over half the longest of them, `seconds`, is
    no larger.
    """
    instability, walk = DRIFTS
    if terms is None:
        return {instability: stated} if stated else {}
    sizes = {name: float(getattr(terms.model, name)) for name in DRIFTS}
    certain = {name for name in DRIFTS if terms.terms[name].p_value < MAX_P_VALUE}
    shown = {name: size for name, size in sizes.items() if size > 0 and name in certain}
    if not stated:
        return shown
    if walk in shown:
        lowest = stated * np.sqrt(FLOOR_VARIANCE)  # Allan deviation
        larger = shown[walk] * np.sqrt(seconds / 6) > MAX_STATED_RATIO * lowest
        alike = instability in terms.terms[walk].alternatives
        return shown if larger or not alike else {instability: stated}
    limit = terms.terms[instability].most
    return {instability: max(shown.get(instability, 0.0), float(np.fmin(stated, limit)))}


def drifts_of_axes(
    drifts: Sequence[Mapping[str, float]], terms: Sequence[NoiseTerms | None]
) -> list[dict[str, float]]:
    """What enters of each axis of a sensor; of one that shows no drift also that of the others.

    The axes of a sensor are of one design. Where two of them show a bias instability, short
    stretches have missed that of the third: it has the mean power of theirs, as far as its own
    upper limit leaves it open. Else its stretches would seem to differ by more than noise does. So
    has one beside a single such axis, if it hints at a bias instability itself.
    """
    instability, _ = DRIFTS
    shown = [drift[instability] for drift in drifts if drift.get(instability)]
    result = [dict(drift) for drift in drifts]
    if shown:
        of_others = float(np.sqrt(np.mean(np.square(shown))))
        for drift, own in zip(result, terms, strict=True):
            if own is None or drift:
                continue
            term = own.terms[instability]
            if len(shown) >= LEAST_ALIKE or term.p_value < MAX_ALIKE_P_VALUE:
                drift[instability] = float(np.fmin(of_others, term.most))
    return result


def effective_levels(
    noise: pd.DataFrame,
    drifts: Mapping[str, Mapping[str, float | None]] | None = None,
    rounding: Mapping[tuple[str, str, str], float] | None = None,
) -> pd.DataFrame:
    """The table of effective levels, by the levels of all manoeuvres.

    `drifts`: see `drift_of`, and the quantisation, by channel; `rounding`: what coarse counts add,
    by manoeuvre, phase and channel; a channel that stands still in a manoeuvre has no level there,
    but this. One that stands still in all has no noise that its counts would show, and this alone;
    the largest is that of a manoeuvre that has none.

    The common variance is the mean of theirs, weighted with w = (N/σ)², their relative precision,
    for else a level that came out low would weigh more for it. Then the common level has the
    relative sigma (Σw)^−½, and Σw/2 degrees of freedom: a variance known to √(2/ν).
    """
    by_channel = grouped(rows_of(noise), lambda row: row["channel"])
    rows: list[Row] = []
    rounding = dict(rounding or {})
    for channel, own in by_channel.items():
        white, sigma = np.array([(row["white_noise"], row["sigma"]) for row in own]).T
        weight = (white / sigma) ** 2
        alike = ~_differ(white, float(np.median(white)), weight / 2)
        alike = alike if alike.any() else np.ones(len(white), bool)
        total = float(weight[alike].sum())
        level = float(np.sqrt(np.average(white[alike] ** 2, weights=weight[alike])))
        common = {"white_noise": level, "sigma": level * total**-0.5, "source": COMMON}
        common["degrees"] = total / 2
        elsewhere = dict.fromkeys(("manoeuvre", "phase", "measured", "per_sample", "swing"))
        rows.append(
            elsewhere | {"channel": channel} | common | dict((drifts or {}).get(channel, {}))
        )
        differ = _differ(white, level, weight / 2)
        spread = _spread(white[alike], weight[alike] / 2)
        for row, precision, differs in zip(own, weight, differ, strict=True):
            rows.append(
                {key: row[key] for key in ("manoeuvre", "phase", "channel", "per_sample")}
                | {"swing": row.get("swing")}
                | {"measured": row["white_noise"]}
                | {"rounding": rounding.pop((row["manoeuvre"], row["phase"], channel), None)}
                | common
                | (
                    {"white_noise": row["white_noise"], "sigma": row["sigma"], "source": OWN}
                    | {"degrees": float(precision) / 2}
                    if differs
                    else _between(row["white_noise"], float(precision) / 2, level, spread)
                    if spread
                    else {}
                )
            )
        for key in [key for key in rounding if key[-1] == channel]:
            place = dict(zip(("manoeuvre", "phase", "channel"), key, strict=True))
            rows.append(place | common | {"rounding": rounding.pop(key)})
    still = {"white_noise": 0.0, "sigma": 0.0, "source": COMMON, "degrees": np.inf}
    most = {channel: size for (*_, channel), size in sorted(rounding.items(), key=itemgetter(1))}
    rows += [still | {"channel": channel, "white_noise": size} for channel, size in most.items()]
    for (manoeuvre, phase, channel), size in rounding.items():
        place = {"manoeuvre": manoeuvre, "phase": phase, "channel": channel}
        rows.append(place | still | {"rounding": size})
    return pd.DataFrame(rows, columns=LEVEL_COLUMNS) if rows else tables.LEVELS.empty()


def _differ(white: Array, level: float, degrees: Array) -> Booleans:
    """Which levels, (n,), differ from a common one by more than chance, of all n together.

    A variance of ν degrees of freedom is chi-squared. In sigmas of its own a low one of few degrees
    would seem to differ far more often than a high one, and it would weigh too much besides.
    """
    above = chi2_sf(degrees * (white / level) ** 2, degrees)
    return np.asarray(2 * np.minimum(above, 1 - above) * len(white) < LEVEL_P_VALUE)


def _spread(white: Array, degrees: Array) -> float:
    """The variance of the logarithm of the variances of levels, (n,), beyond chance; 0: none.

    Bartlett's test of equal variances (1937), then the moments of DerSimonian and Laird (1986): the
    logarithm of a variance of ν degrees of freedom is known to √(2/ν).
    """
    more, total = len(white) - 1, float(degrees.sum())
    if not more:
        return 0.0
    variance = np.log(white**2)
    pooled = float(np.log(np.average(white**2, weights=degrees)))
    unequal = float(degrees @ (pooled - variance))
    unequal /= 1 + (float(np.sum(1 / degrees)) - 1 / total) / (3 * more)
    if chi2_sf(unequal, more) >= LEVEL_P_VALUE:
        return 0.0
    weight = degrees / 2
    off = variance - np.average(variance, weights=weight)
    beyond = float(weight @ off**2) - more
    return max(beyond / float(weight.sum() - weight @ weight / weight.sum()), 0.0)


def _between(white: float, degrees: float, common: float, spread: float) -> Row:
    """The level of a manoeuvre by its own and by the common one, about which others scatter."""
    share = spread / (spread + 2 / degrees)
    level, known = common * (white / common) ** share, degrees + 2 / spread
    sigma = level / np.sqrt(2 * known)
    return {"white_noise": level, "sigma": sigma, "source": BETWEEN, "degrees": known}


def only_noise(manoeuvres: pd.DataFrame, terms: pd.DataFrame) -> bool:
    """Whether a campaign is nothing but a long rest in one attitude: a recording of the noise."""
    attitudes = manoeuvres[[f"up_{axis}" for axis in tables.AXES]]
    alike = len(manoeuvres) == 1 or (
        bool(attitudes.notna().all(axis=None)) and len(attitudes.drop_duplicates()) == 1
    )
    resting = bool((manoeuvres["do"] == "rest").all())
    return alike and resting and bool((terms["seconds"] >= MIN_NOISE_RECORDING_S).any())


class NoiseLevels:
    """The effective levels by manoeuvre, phase and channel, per √s."""

    def __init__(self, levels: pd.DataFrame) -> None:
        self._rows: dict[Key, Row] = {
            (row["manoeuvre"], row["phase"], row["channel"]): row for row in rows_of(levels)
        }

    @property
    def degrees(self) -> float:
        """Degrees of freedom of the least known common level; infinite where there is none."""
        common = (row["degrees"] for row in self._rows.values() if row["source"] == COMMON)
        return float(min(common, default=np.inf))

    def of(self, manoeuvre: str, phase: str, channels: Sequence[str]) -> Array:
        """The levels of some channels, rest or steady; NaN where nothing is known."""
        return np.array([self._level(manoeuvre, phase, channel) for channel in channels])

    def of_samples(self, manoeuvre: str, phase: str, channels: Sequence[str]) -> Array:
        """The standard deviation of the samples of some channels; NaN where nothing is known."""
        rows = [self._rows.get((manoeuvre, phase, channel)) for channel in channels]
        return np.array([np.nan if row is None else row["per_sample"] for row in rows], np.float64)

    def quantisation(self, sensor: str) -> Array:
        """The white noise of the integral of each channel of a sensor, (3,), rad or m/s."""
        found = [row.get("quantisation") or 0.0 for row in self._of_axes(sensor)]
        return np.nan_to_num(np.array(found, np.float64))

    def of_integral(self, manoeuvre: str, phase: str, sensor: str) -> Array:
        """The same with what oscillates in a manoeuvre, rest or steady, (3,), rad or m/s."""
        keys = [(manoeuvre, phase, f"{sensor}_{axis}") for axis in tables.AXES]
        swings = [self._rows.get(key, {}).get("swing") or 0.0 for key in keys]
        return np.hypot(self.quantisation(sensor), np.nan_to_num(np.array(swings, np.float64)))

    def delay(self, sensor: str) -> float:
        """By how much the slowest low pass of a sensor delays slow changes, s; 0: none is seen."""
        return max((row.get("delay") or 0.0 for row in self._of_axes(sensor)), default=0.0)

    def rounded(self, sensor: str) -> int:
        """How many means of the channels of a sensor are off by rounding of coarse counts."""
        own = (row for key, row in self._rows.items() if key[-1].startswith(sensor))
        return sum(row["rounding"] is not None for row in own)

    def drift(self, sensor: str) -> MeasuredDrift:
        """The drift of the biases of a sensor, `gyro` or `accel`, by the noise at rest."""
        rows = self._of_axes(sensor)
        sizes = np.array([[row.get(term) or 0.0 for term in DRIFTS] for row in rows], np.float64)
        instability, walk = np.nan_to_num(sizes).T
        stated = self._stated(sensor)
        expected = not walk.any() and bool(np.all(instability <= MAX_STATED_RATIO * stated))
        known = np.where(walk > 0, stated, np.minimum(instability, stated))
        return MeasuredDrift(instability, walk, expected=expected, stated=known)

    def stated_drift(self, sensor: str) -> MeasuredDrift:
        """The same by the data sheet alone: a support that tilts is no drift of the bias."""
        return MeasuredDrift(self._stated(sensor), np.zeros(len(tables.AXES)), expected=True)

    def _of_axes(self, sensor: str) -> list[Row]:
        return [self._rows.get((None, None, f"{sensor}_{axis}"), {}) for axis in tables.AXES]

    def _stated(self, sensor: str) -> Array:
        """The bias instability of each axis that the data sheet states, else 0, (3,)."""
        stated = [row.get("data_sheet") or 0.0 for row in self._of_axes(sensor)]
        return np.nan_to_num(np.array(stated, np.float64))

    def oscillates(self, manoeuvre: str, channels: Sequence[str]) -> bool:
        """Whether a channel oscillates in the steady part of a turn, and not at rest."""
        return any(self._oscillates(manoeuvre, channel) for channel in channels)

    def _oscillates(self, manoeuvre: str, channel: str) -> bool:
        row = self._rows.get((manoeuvre, "steady", channel))
        if row is None or row["measured"] is None or channel not in self._at_rest:
            return False
        return _ratio(row) > MIN_SCATTER_RATIO * self._at_rest[channel]

    @cached_property
    def _at_rest(self) -> dict[str, float]:
        """The usual scatter of the samples of each channel at rest, in its white noise per √s."""
        rests: dict[str, list[float]] = {}
        for (_, phase, channel), row in self._rows.items():
            if phase == "rest" and row["measured"] is not None:
                rests.setdefault(channel, []).append(_ratio(row))
        return {channel: float(np.median(ratios)) for channel, ratios in rests.items()}

    def _level(self, manoeuvre: str, phase: str, channel: str) -> float:
        common = self._rows.get((None, None, channel))
        row = self._rows.get((manoeuvre, phase, channel), common)
        if row is None:
            return np.nan
        return float(np.hypot(row["white_noise"], row["rounding"] or 0.0))


def _ratio(row: Row) -> float:
    """Scatter of the samples in units of the white noise that was measured beside it."""
    return float(row["per_sample"] / row["measured"])
