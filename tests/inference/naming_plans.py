"""Made-up campaigns of two plans: when, where and how fast the case is, and how effects show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array

EARTH, LATITUDE, GRAVITY = 7.292115e-5, np.radians(30.53), 9.7936
HALF_WAVES = 8  # of a drift without a law
REST, BLOCK = 30.0, 1.0  # s, of one row


@dataclass(frozen=True)
class Rows:
    """Every row of a campaign: (n,) or (n, 3); `rate` in body axes, rad/s."""

    seconds: Array
    time: Array
    position: NDArray[np.int64]
    up: Array
    north: Array
    rate: Array
    acceleration: Array  # of the rate
    angle: Array  # of the table; NaN at rest

    @property
    def temperature(self) -> Array:
        """Warming, K, with a draught."""
        return 2 * (1 - np.exp(-self.time / 900)) + 0.3 * np.sin(self.time / 250)

    @property
    def earth(self) -> Array:
        return np.asarray(EARTH * (np.sin(LATITUDE) * self.up + np.cos(LATITUDE) * self.north))


Face = tuple[int, int, int, tuple[int, ...]]  # axis, sign of up; s at rest; °/s of whole turns
FACES = [(axis, sign) for axis in range(3) for sign in (1, -1)]
SIX: list[Face] = [(axis, sign, 300, (10, -10) if sign > 0 else ()) for axis, sign in FACES]
TURN_AND_STOP: list[Face] = [
    (axis, sign, 240, (6, -6) if sign > 0 else (12, -12)) for axis, sign in FACES
]
PLANS = {
    "b": SIX,
    "c": TURN_AND_STOP,
    "c, same rates at opposite g": TURN_AND_STOP
    + [(axis, sign, 0, (12, -12) if sign > 0 else (6, -6)) for axis, sign in FACES],
    "c, all rests again": TURN_AND_STOP + [(axis, sign, 240, ()) for axis, sign in FACES],
}


def rows_of(plan: str) -> Rows:
    """Plan b: six rests of 5 min, whole turns at 10 °/s. Plan c: turns up at 6 and down at
    12 °/s with rests between, as Liu & Yu 2013 have them."""
    parts: list[tuple[Array, ...]] = []
    clock = 0.0
    eye: Array = np.eye(3)
    for position, (axis, sign, seconds, rates) in enumerate(PLANS[plan]):
        up, side = sign * eye[axis], eye[(axis + 1) % 3]
        count = int(seconds / REST)
        still, rest = clock + middles(count, REST), np.zeros(count)
        parts.append(_rows(still, REST, position, up, side, rest, rest, rest, np.nan))
        clock += seconds
        for rate in rates:
            speed = np.radians(rate)
            count = int(abs(360 / rate) / BLOCK)
            moving = clock + middles(count, BLOCK)
            speeds, ramps = np.full(count, speed), np.zeros(count)
            speeds[[0, -1]] /= 2
            ramps[[0, -1]] = speed / BLOCK, -speed / BLOCK
            turned = np.cumsum(speeds) * BLOCK - speeds / 2
            parts.append(_rows(moving, BLOCK, position, up, side, turned, speeds, ramps, 0.0))
            clock += count * BLOCK + 20
    return Rows(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def times_of_jumps(plan: str) -> Array:
    """About a minute apart."""
    time = rows_of(plan).time
    return np.linspace(time[0], time[-1], 38)[1:-1]


def middles(count: int, step: float) -> Array:
    return np.asarray(step * (np.arange(count) + 0.5), np.float64)


def _rows(
    time: Array,
    seconds: float,
    position: int,
    up: Array,
    side: Array,
    turned: Array,
    speed: Array,
    ramp: Array,
    known: float,
) -> tuple[Array, ...]:
    n = len(time)
    across = np.cross(up, side)
    # The table turns the case about up; north turns back.
    north = np.cos(turned)[:, None] * side - np.sin(turned)[:, None] * across
    return (
        np.full(n, seconds), time, np.full(n, position), np.tile(up, (n, 1)), north,
        speed[:, None] * up, ramp[:, None] * up, turned + known,
    )  # fmt: skip


def per_axis(values: Array) -> Array:
    """(n, 3) → (n, 3, 3): a parameter for each axis."""
    return np.asarray(values[:, :, None] * np.eye(3))


def matrix(values: Array) -> Array:
    """(n, 3) → (n, 3, 9): a full matrix times the vector."""
    return np.asarray(np.einsum("ik,nj->nikj", np.eye(3), values).reshape(len(values), 3, 9))


def common(time_course: Array) -> Array:
    return per_axis(np.tile(time_course[:, None], (1, 3)))


def catalogue(r: Rows, jumps: Array) -> dict[str, tuple[list[Array], list[Array]]]:
    """For each effect its candidates' traces in gyros and accelerometers, (n, 3, k) each.

    `jumps`: the times at which a jump is sought.
    """
    n, t, T = len(r.time), r.time / 1000, r.temperature[:, None]
    w, up = r.rate, r.up
    truth = w + r.earth
    turning = np.isfinite(r.angle)
    theta = np.where(turning, r.angle, 0.0)
    zero = [np.zeros((n, 3, 0))]
    taus = np.geomspace(0.1, 3, 10)
    orders = np.arange(0.5, 20.1, 0.5)
    steps = [common((r.time > at).astype(float)) for at in jumps]
    warm = [common(np.exp(-t / tau)) for tau in taus]
    speed = w * turning[:, None]
    ripples = [
        speed[:, :, None] * (k * np.stack([np.cos(k * theta), -np.sin(k * theta)], 1))[:, None, :]
        for k in orders
    ]
    cross: Array = np.stack([np.cross(up, e) * GRAVITY for e in np.eye(3)], 2)
    phase = np.pi * (r.time - r.time[0]) / np.ptp(r.time)
    waves = np.cos(phase[:, None] * np.arange(1, HALF_WAVES + 1))
    any_one = [waves[:, None, :] * np.eye(3)[axis][:, None] for axis in range(3)]
    any_all: Array = np.concatenate(any_one, axis=2)
    lab = np.stack([np.cross(r.north, up), r.north], 2)  # what a fixed tilt adds to up
    tilts = lab * GRAVITY
    side = tilts * (np.abs(up[:, 2:3, None]) < 0.5)
    wobble = (
        np.stack([np.cos(2 * theta), np.sin(2 * theta)], 1)[:, None, :]
        * tilts
        * turning[:, None, None]
    )
    pull = [np.cross(w, np.cross(w, e)) + np.cross(r.acceleration, e) for e in np.eye(3)]
    arm = np.stack(pull, 2)
    size = np.einsum("ik,nij->nikj", np.eye(3), arm).reshape(n, 3, 9)
    return {
        "gyro_g": ([matrix(up)], zero),
        "gyro_g2": ([per_axis(up**2)], zero),
        "gyro_asymmetry": ([per_axis(np.abs(w))], zero),
        "gyro_quadratic": ([per_axis(truth * np.abs(truth))], zero),
        "gyro_cubic": ([per_axis(truth**3)], zero),
        "gyro_scale_g": ([per_axis(truth * up)], zero),
        "gyro_ramp": ([common(t)], zero),
        "gyro_warm": (warm, zero),
        "gyro_temperature": ([per_axis(np.tile(T, 3))], zero),
        "gyro_scale_temperature": ([per_axis(T * truth)], zero),
        "gyro_jump": (steps, zero),
        "latency": ([-per_axis(r.acceleration)], zero),
        "ripple": (ripples, zero),
        "latitude": ([np.cross(np.cross(up, r.north), r.earth)[:, :, None]], zero),
        "heading": ([np.cross(up, r.earth)[:, :, None]], zero),
        "accel_k2": (zero, [per_axis(up**2)]),
        "accel_k3": (zero, [per_axis(up**3)]),
        "accel_asymmetry": (zero, [per_axis(np.abs(up))]),
        "accel_cross": (zero, [per_axis(up[:, [1, 2, 0]] * up[:, [2, 0, 1]])]),
        "accel_ramp": (zero, [common(t)]),
        "accel_warm": (zero, warm),
        "accel_temperature": (zero, [per_axis(np.tile(T, 3))]),
        "accel_scale_temperature": (zero, [per_axis(T * up)]),
        "accel_jump": (zero, steps),
        "lever": (zero, [arm]),
        "size": (zero, [size]),
        "tilt": (zero, [tilts]),
        "skew": (zero, [side]),
        "wobble": (zero, [wobble]),
        "mounting": (zero, [cross]),
        "any_gyro": (any_one, zero),
        "any_gyros": ([any_all], zero),
        "any_accel": (zero, any_one),
        "any_accels": (zero, [any_all]),
    }
