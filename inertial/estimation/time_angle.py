"""The angle of the table as a function of time."""

from dataclasses import dataclass
from math import pi, sqrt

import numpy as np
from numpy.typing import NDArray

# ---- The angle of the table as a function of time, from the gyro along its axis and the whole
# angle.
#
#     θ(t) = A · C(t) / C(T),   C(t) = ∫ (ω̃ − b − ω_e) dt
#
# Scale factor and noise of the gyro are tied at both ends: at rest before, θ is 0, at rest after
# it is the known A. Between, white noise N leaves a Brownian bridge, σ² = N² t (T − t)/T at a
# steady rate; what is not known of bias and earth leaves (t − T θ/A) σ_b, which is little, for a
# table at a steady rate drifts like a bias.
#
# It needs no scale factor, so with it any window of this gyro gives the scale factor of the whole
# turn again. It serves other gyros, other turns and marks at fixed angles. What it cannot do:
# without the known A a common scale factor of the gyros and the speed of the table are one
# unknown.

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Errors:
    """What the angle suffers, one sigma each.

    `density`: rad/√s, white noise along the axis; `offset`: rad/s, of bias and upward earth rate;
    `whole`: rad, of the whole angle; `level`: rad/s, rms of the level earth rate that the gyro
    feels and that is not taken out; `ripple`: rad, rms of an oscillation that rings on.
    """

    density: float
    offset: float
    whole: float
    level: float = 0.0
    ripple: float = 0.0


@dataclass(frozen=True)
class TimeAngle:
    """A turn at the n + 1 edges of its samples, from the first motion to the last.

    `time`: s, since the first edge; `angle`: rad, from 0 to the whole angle, which is positive.
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

    def between(self, i: int, j: int | NDArray[np.int64]) -> Array:
        """Standard deviation of the angle between two edges, rad."""
        seconds = np.abs(self.time[j] - self.time[i])
        share = np.abs(self.angle[j] - self.angle[i]) / self.whole
        total = self.time[-1]
        white = seconds - 2 * share * seconds + share**2 * total
        offset = (seconds - share * total) * self.errors.offset
        # The level rate turns with the case: over an angle it sums to 2 sin(angle/2)/rate.
        rate = self.whole / total
        level = self.errors.level * 2 * np.abs(np.sin(share * self.whole / 2)) / rate
        others = offset**2 + level**2 + (share * self.errors.whole) ** 2
        return np.asarray(np.sqrt(self.errors.density**2 * np.maximum(white, 0.0) + others))


def tied(increments: Array, step: float, whole: float, errors: Errors) -> TimeAngle:
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

    White noise of the rate makes every other weighting worse. An oscillation that both ends cut
    counts with √2 of its rms.
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
    """How the table comes to its speed before the edge `steady`.

    The rate over the speed grows from 0 to 1 like a distribution; its mean t₀ is where the straight
    line of the steady part meets the angle 0, its variance V = 2/ω ∫ (θ − ω (t − t₀)⁺) dt. Of a
    constant acceleration that lasts D, V is D²/12. So no edge of the ramp need be found.
    """
    time, angle = turn.time[: steady + 1], turn.angle[: steady + 1]
    reached, rate = float(time[-1]), speed.value
    lead = float(angle[-1]) / rate
    middle = reached - lead
    # The trapezoidal rule takes a bent curve for too much: by h²/12 times its change of slope.
    step = reached / steady
    area = float(np.trapezoid(angle, time)) - step**2 / 12 * rate
    variance = 2 / rate * area - lead**2
    of_angle = float(turn.between(0, steady))
    of_middle = float(np.hypot(of_angle / rate, lead * speed.sigma / rate))
    terms = (
        2 / rate * turn.errors.density * reached**1.5 / np.sqrt(3),
        2 * lead * of_middle,
        lead**2 * speed.sigma / rate,
    )
    of_variance = float(np.linalg.norm(terms))
    lasts = float(np.sqrt(12 * variance)) if variance > 0 else np.nan
    of_lasts = 6 * of_variance / lasts
    acceleration = rate / lasts
    return Ramp(
        Valued(middle - lasts / 2, float(np.hypot(of_middle, of_lasts / 2))),
        Valued(lasts, of_lasts),
        Valued(acceleration, acceleration * float(np.hypot(of_lasts / lasts, speed.sigma / rate))),
    )


def spin_down(turn: TimeAngle, steady: int, speed: Valued) -> Ramp:
    """How the table comes to rest after the edge `steady`: the same, seen from the end."""
    total = float(turn.time[-1])
    time, angle = (total - turn.time)[::-1], (turn.whole - turn.angle)[::-1]
    seen = spin_up(TimeAngle(time, angle, turn.errors), len(time) - 1 - steady, speed)
    start = Valued(total - seen.start.value - seen.seconds.value, seen.start.sigma)
    return Ramp(start, seen.seconds, seen.acceleration)


# ---- What an oscillation of the rate leaves in an angle whose window cuts it.
#
#     ∫ A sin(2πf t + ψ) dt = A/(2πf) · (cos ψ₁ − cos ψ₂)
#
# ψ₁, ψ₂ are its phases at the two ends. For phases by chance this is A/(2πf) rms, at worst twice
# as much. From rest to rest nothing is cut: whole turns are free of it, windows are not.


def ripple_angle(amplitude: float, frequency: float) -> float:
    """Rms of the angle that is left, rad, of an amplitude in rad/s at `frequency` in Hz.

    At worst it is twice this.
    """
    return amplitude / (2 * pi * frequency)


def ripple_scale(amplitude: float, frequency: float, angle: float, windows: int = 1) -> float:
    """Rms of the scale factor error by `windows` windows of `angle` (rad) each, 1.

    Forward and backward are two. At worst it is 2√windows times this.
    """
    return ripple_angle(amplitude, frequency) / abs(angle) / sqrt(windows)


def ripple_window(amplitude: float, frequency: float, seconds: Array) -> Array:
    """Rms over all starts of the angle that is left in windows of `seconds`, rad.

    ∫ over T of A sin(2πf t + ψ) dt has the amplitude A/(πf) · |sin πfT|: nothing where T holds
    whole periods, as 18 s do of 20 Hz.
    """
    size = amplitude / (pi * frequency) / sqrt(2)
    return np.asarray(size * np.abs(np.sin(pi * frequency * seconds)))
