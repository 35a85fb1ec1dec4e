"""Readings that are a multiple of what they should be, and the units that explain the multiple."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.arrays import Array
from inertial.signal.detector import Given, Log
from inertial.signal.plan_detector import Recorded
from inertial.text.messages import _
from inertial.text.units import DEGREE, STANDARD_GRAVITY

# Of gravity. A consumer accelerometer may be off by 80 mg and 3 % (MPU-6050, PS-MPU-6000A), an old
# one by 110 mg; the smallest wrong factor is 2. Of the rate of a turn, which has no bias: 3 %.
MAX_SCALE_ERROR = {"accel": 0.15, "gyro": 0.05}
MAX_RATIO_SPREAD = 0.05  # of the ratios of turns to their plan: a gyro of a phone is off by 3 %
MAX_FACTOR_DIFFERENCE = 0.01  # relative: factors that differ by less explain the same
MIN_RAW_COUNT_RATIO = 50.0  # a multiple that no sensor reads in any unit
FULL_SCALE_FACTORS = (2, 4, 8, 16)
MIN_SPHERE_WINDOWS = 12  # at rest, from which bias and radius are determined together
MIN_SPHERE_SPREAD = 0.2  # of gravity: rms of f across its least direction
QUIET_VARIANCE_RATIO = 4.0  # over the lower quartile: a window of 1 s in which the IMU is at rest
UNIT_FACTORS = {
    "accel": {
        STANDARD_GRAVITY: _("the values are in m/s² but are read as g"),
        1 / STANDARD_GRAVITY: _("the values are in g but are read as m/s²"),
        1000.0: _("the values are in mg but are read as g (or in mm/s² as m/s²)"),
        1000.0 / STANDARD_GRAVITY: _("the values are in mg but are read as m/s²"),
        100.0: _("the values are in cm/s² (Gal) but are read as m/s²"),
    },
    "gyro": {
        1 / DEGREE: _("the values are in degrees but are read as radians"),
        DEGREE: _("the values are in radians but are read as degrees"),
        1000.0: _("the values are in thousandths of the stated unit, such as milli-°/s"),
    },
}


def force_at_rest(log: Log) -> float:
    """The median of |f| where a log is quiet, m/s²; NaN where not all axes are recorded."""
    force = np.linalg.norm(log.windows.mean[:, :3], axis=1)
    recorded = np.isfinite(force)
    if not recorded.any():
        return np.nan
    variance = np.nansum(log.windows.variance[recorded], axis=1)
    quiet = variance <= QUIET_VARIANCE_RATIO * np.quantile(variance, 0.25)
    return float(np.median(force[recorded][quiet]))


def quiet_force(log: Log) -> Array:
    """The means of the specific force over the windows of a log that are quiet, (k, 3), m/s²."""
    force, variance = log.windows.mean[:, :3], log.windows.variance[:, :3].sum(axis=1)
    known = np.isfinite(force).all(axis=1) & np.isfinite(variance)
    if not known.any():
        return np.empty((0, 3))
    force, variance = force[known], variance[known]
    return np.asarray(force[variance <= QUIET_VARIANCE_RATIO * np.quantile(variance, 0.25)])


def radius_at_rest(log: Log) -> float:
    """The radius of the sphere about the bias on which f lies at rest, m/s².

    A large bias moves the centre of that sphere, not its radius. NaN where the log has too few
    attitudes to determine both.
    """
    if len(force := quiet_force(log)) < MIN_SPHERE_WINDOWS:
        return np.nan
    # |f − b|² = r²  ⇔  2 f·b + (r² − b²) = f², linear in b and r² − b².
    design = np.column_stack([2 * force, np.ones(len(force))])
    size = np.sqrt(np.mean(np.sum(force**2, axis=1)))
    shares = np.linalg.svd((force - force.mean(axis=0)) / size, compute_uv=False)
    if shares[-1] < MIN_SPHERE_SPREAD * np.sqrt(len(force)):
        return np.nan
    solution = np.linalg.lstsq(design, np.sum(force**2, axis=1), rcond=None)[0]
    return float(np.sqrt(max(solution[3] + solution[:3] @ solution[:3], 0.0)))


def explanation_of(ratio: float, sensor: str, given: Given, count: float = np.nan) -> str | None:
    """What explains that a sensor reads `ratio` times what it should, in words; None if nothing.

    Parameters
    ----------
    sensor : accel or gyro
    count : m/s or rad, what one count is by the campaign; where it is not given, the counts of
        any two listed instruments are compared
    """
    known = factors_near(ratio, sensor, given, count)
    if known:
        return ", or ".join(known.values())
    if abs(ratio) > MIN_RAW_COUNT_RATIO:
        return _("the values are counts, and counts_per_unit is missing")
    return None


def factors_near(
    ratio: float, sensor: str, given: Given, count: float = np.nan
) -> dict[float, str]:
    """The known factor that is nearest to a ratio, and those that differ little from it.

    Each with what makes it, the nearest first; none where a sensor that is merely off is as near.
    Arguments as of `explanation_of`.
    """
    known = dict(_known_factors(sensor, given, count))
    distance = {factor: abs(np.log(abs(ratio) / factor)) for factor in known}
    nearest = min(distance, key=lambda factor: distance[factor], default=1.0)
    if not known or distance[nearest] >= np.log1p(MAX_SCALE_ERROR[sensor]):
        return {}
    near = [f for f in distance if abs(f / nearest - 1) < MAX_FACTOR_DIFFERENCE]
    return {factor: known[factor] for factor in sorted(near, key=lambda f: distance[f])}


def _known_factors(sensor: str, given: Given, count: float) -> Iterator[tuple[float, str]]:
    """Factors that are known to happen, and what makes each."""
    yield from UNIT_FACTORS[sensor].items()
    for scale in FULL_SCALE_FACTORS:
        for factor, size in ((float(scale), "small"), (1 / scale, "large")):
            cause = _(
                "counts_per_unit is {scale} times too {size}, as of another full scale",
                scale=scale,
                size=size,
            )
            if sensor == "gyro" and scale == FULL_SCALE_FACTORS[0]:
                cause += _(", or the sample rate is off by {scale}", scale=scale)
            yield factor, cause
    size_of = {name: sizes[sensor == "gyro"] for name, sizes in given.count_sizes.items()}
    for used in [count] if np.isfinite(count) else sorted(set(size_of.values())):
        instruments: dict[float, list[str]] = {}
        for name, other in size_of.items():
            if abs(used / other - 1) > MAX_FACTOR_DIFFERENCE:
                instruments.setdefault(used / other, []).append(name)
        for factor, names in instruments.items():
            # Slightly beside the factor itself, which may be that of a unit as well.
            yield (
                factor * (1 + 1e-12),
                _("the counts are those of {names}", names=_(" or ").join(names)),
            )


def turn_ratios(recorded: Recorded) -> tuple[Array, Array]:
    """Recorded over planned rate and angle of each turn, (m,), NaN where not known."""
    with np.errstate(divide="ignore", invalid="ignore"):
        rate = np.where(recorded.found, recorded.speed / recorded.rate, np.nan)
        whole = recorded.found & ~recorded.steady & (recorded.lacking_s == 0)
        angle = np.where(whole, recorded.moved / recorded.angle, np.nan)
    return rate, angle


def common_turn_ratio(recorded: Recorded) -> tuple[float, str] | None:
    """The ratio by which all turns differ from their plan, in rate and in angle, and its cause.

    None where they do not differ, or not by one ratio. A single turn may have been planned
    wrongly: its ratio counts only if a unit, a full scale or an instrument explains it.
    """
    rate, angle = turn_ratios(recorded)
    known = np.isfinite(rate)
    if not known.any():
        return None
    ratio = float(np.median(rate[known]))
    both = np.concatenate([rate[known], angle[known & np.isfinite(angle)]]) / ratio
    if abs(ratio - 1) <= recorded.tolerance or ratio <= 0:
        return None
    if np.abs(both - 1).max() > MAX_RATIO_SPREAD:
        return None
    count = recorded.count[known]
    count = count[np.isfinite(count)]
    size = float(np.median(count)) if len(count) else np.nan
    cause = explanation_of(ratio, "gyro", recorded.given, size)
    if cause is None and known.sum() == 1:
        return None
    return ratio, cause or _("no known unit, full scale or instrument explains it")


# ---- Counts that are written without their sign: of 16 bits −1 is written as 65535.

WORD_BITS = (16, 24, 32)
MIN_LEAPS, MAX_LEFT = 5, 0.1  # over half the range; share of them that the sign must not leave


def signed(counts: Array, bits: int) -> Array:
    """Counts of so many bits with their sign."""
    half = 2.0 ** (bits - 1)
    return np.asarray((counts + half) % (2 * half) - half)


def bits_without_sign(recordings: Sequence[Array]) -> int | None:
    """The bits of counts, (n, 3) each, that leap over their range where they pass zero, or None.

    No motion takes a sensor from one end of its range to the other between two samples.
    """
    counts = [own[np.isfinite(own).all(axis=1)] for own in recordings]
    if any(own.min(initial=0) < 0 or (own % 1).any() for own in counts):
        return None
    most = max((own.max(initial=0) for own in counts), default=0)
    for bits in WORD_BITS:
        if most >= 2**bits:
            continue
        leaps, left = (
            sum(int((np.abs(np.diff(own, axis=0)) > 2 ** (bits - 1)).sum()) for own in each)
            for each in (counts, [signed(own, bits) for own in counts])
        )
        if leaps >= MIN_LEAPS and left < MAX_LEFT * leaps:
            return bits
    return None
