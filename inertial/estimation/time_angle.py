"""The angle of the table as a function of time."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np

from inertial.arrays import Array, Integers


@dataclass(frozen=True)
class Errors:
    """Errors of the angle, one sigma each.

    `density`: rad/√s, white noise along the axis; `offset`: rad/s, of bias and upward earth rate;
    `whole`: rad, of the whole angle; `level`: rad/s, rms of the horizontal earth rate along the
    gyro that is not subtracted; `ripple`: rad, rms of an oscillation that does not decay.
    """

    density: float
    offset: float
    whole: float
    level: float = 0.0
    ripple: float = 0.0


@dataclass(frozen=True)
class TimeAngle:
    """The angle of the table as a function of time, by the gyro along its axis and the whole angle.

        θ(t) = A · C(t) / C(T),   C(t) = ∫ (ω̃ − b − ω_e) dt

    Scale factor and noise of the gyro are constrained at both ends: at rest before, θ is 0, at rest
    after it is the known A. Between, white noise N gives a Brownian bridge, σ² = N² t (T − t)/T at
    a steady rate; an error σ_b of bias and earth rate gives (t − T θ/A) σ_b, which is small, for
    the angle of a table at a steady rate grows as that of a bias.

    It needs no scale factor, so with it any window of this gyro gives the scale factor of the whole
    turn again. It serves other gyros, other turns and marks at fixed angles. Without the known A a
    common scale factor of the gyros and the speed of the table are one unknown.

    At the n + 1 edges of the samples, from the first motion to the last: `time`: s, since the first
    edge; `angle`: rad, from 0 to the whole angle, which is positive.
    """

    time: Array
    angle: Array
    errors: Errors

    @property
    def whole(self) -> float:
        """The whole angle, rad."""
        return float(self.angle[-1])

    @property
    def sigma(self) -> Array:
        """Standard deviation of the angle, (n + 1,); zero at the start."""
        return self.between(0, np.arange(len(self.time)))

    def between(self, i: int, j: int | Integers) -> Array:
        """Standard deviation of the angle between two edges, rad."""
        seconds = np.abs(self.time[j] - self.time[i])
        share = np.abs(self.angle[j] - self.angle[i]) / self.whole
        total = self.time[-1]
        white = seconds - 2 * share * seconds + share**2 * total
        offset = (seconds - share * total) * self.errors.offset
        # The horizontal rate turns with the case: over an angle it sums to 2 sin(angle/2)/rate.
        rate = self.whole / total
        level = self.errors.level * 2 * np.abs(np.sin(share * self.whole / 2)) / rate
        others = offset**2 + level**2 + (share * self.errors.whole) ** 2
        return np.asarray(np.sqrt(self.errors.density**2 * np.maximum(white, 0.0) + others))


def time_angle(increments: Array, step: float, whole: float, errors: Errors) -> TimeAngle:
    """The function of one turn.

    Parameters
    ----------
    increments : (n,), rad, of the gyro along the axis less bias and earth, signed as the turn
    whole : rad, the known angle, positive
    """
    summed = np.append(0.0, np.cumsum(increments))
    time = step * np.arange(len(summed), dtype=np.float64)
    return TimeAngle(time, np.asarray(whole * summed / summed[-1]), errors)


@dataclass(frozen=True)
class Valued:
    """A number with its standard deviation."""

    value: float
    sigma: float


def plateau(turn: TimeAngle, first: int, after: int) -> Valued:
    """The speed between two edges of the steady part, rad/s, by the angle between them.

    For white noise of the rate this weighting is best. An oscillation that both ends cut
    has √2 of its rms.
    """
    seconds = float(turn.time[after] - turn.time[first])
    angle = float(turn.angle[after] - turn.angle[first])
    sigma = np.hypot(float(turn.between(first, after)), np.sqrt(2) * turn.errors.ripple)
    return Valued(angle / seconds, float(sigma) / seconds)


@dataclass(frozen=True)
class Ramp:
    """An acceleration from rest, as if it were constant: from `start` on for `seconds`."""

    start: Valued  # s
    seconds: Valued  # s
    acceleration: Valued  # rad/s²


def spin_up(turn: TimeAngle, steady: int, speed: Valued) -> Ramp:
    """The acceleration of the table before the edge `steady`.

    The rate over the speed increases from 0 to 1 like a distribution function; its mean t₀ is where
    the straight line of the steady part meets the angle 0, its variance
    V = 2/ω ∫ (θ − ω (t − t₀)⁺) dt. Of a constant acceleration of duration D, V is D²/12. So no edge
    of the ramp need be detected.
    """
    time, angle = turn.time[: steady + 1], turn.angle[: steady + 1]
    reached, rate = float(time[-1]), speed.value
    lead = float(angle[-1]) / rate
    middle = reached - lead
    # The trapezoidal rule overestimates the area below a convex curve by h²/12 times its change of
    # slope.
    step = reached / steady
    area = float(np.trapezoid(angle, time)) - step**2 / 12 * rate
    variance = 2 / rate * area - lead**2
    angle_sigma = float(turn.between(0, steady))
    middle_sigma = float(np.hypot(angle_sigma / rate, lead * speed.sigma / rate))
    terms = (
        2 / rate * turn.errors.density * reached**1.5 / np.sqrt(3),
        2 * lead * middle_sigma,
        lead**2 * speed.sigma / rate,
    )
    variance_sigma = float(np.linalg.norm(terms))
    duration = float(np.sqrt(12 * variance)) if variance > 0 else np.nan
    duration_sigma = 6 * variance_sigma / duration
    acceleration = rate / duration
    return Ramp(
        Valued(middle - duration / 2, float(np.hypot(middle_sigma, duration_sigma / 2))),
        Valued(duration, duration_sigma),
        Valued(
            acceleration,
            acceleration * float(np.hypot(duration_sigma / duration, speed.sigma / rate)),
        ),
    )


def spin_down(turn: TimeAngle, steady: int, speed: Valued) -> Ramp:
    """The deceleration of the table after the edge `steady`, by time reversal."""
    total = float(turn.time[-1])
    time, angle = (total - turn.time)[::-1], (turn.whole - turn.angle)[::-1]
    ramp = spin_up(TimeAngle(time, angle, turn.errors), len(time) - 1 - steady, speed)
    start = Valued(total - ramp.start.value - ramp.seconds.value, ramp.start.sigma)
    return Ramp(start, ramp.seconds, ramp.acceleration)


def ripple_angle(amplitude: float, frequency: float) -> float:
    """Rms angle error in a window that cuts an oscillation of the rate, rad.

        ∫ A sin(2πf t + ψ) dt = A/(2πf) · (cos ψ₁ − cos ψ₂)

    ψ₁, ψ₂ are its phases at the two ends. For random phases this is A/(2πf) rms, at worst twice
    that. From rest to rest nothing is cut: whole turns are free of it. `amplitude`: A, rad/s;
    `frequency`: f, Hz.
    """
    return amplitude / (2 * pi * frequency)


def ripple_window(amplitude: float, frequency: float, seconds: Array) -> Array:
    """Rms over all starts of the angle error in windows of `seconds`, rad.

    ∫ over T of A sin(2πf t + ψ) dt has the amplitude A/(πf) · |sin πfT|: zero where T holds a whole
    number of periods, as 18 s do of 20 Hz.
    """
    size = amplitude / (pi * frequency) / sqrt(2)
    return np.asarray(size * np.abs(np.sin(pi * frequency * seconds)))
