"""Functions of one state of the instrument that a reading may contain: means over stretches.

A state is scaled so that a size has the unit of the reading: time in hours, rate in 10 °/s, force
in g, temperature in K, its rate in K/min; an angle is in rad, and known only in turns.
"""

import numpy as np

from inertial.arrays import Array
from inertial.physics.drift import without_clock, without_temperature
from inertial.physics.motion import Motion, without_leans
from inertial.text.parameters import AXES
from inertial.text.units import DEGREE, HOUR

NODES, WEIGHTS = (part / 2 for part in np.polynomial.legendre.leggauss(5))  # of a stretch
RATE = 10 * DEGREE  # rad/s
MINUTE = 60.0  # s
SLOPE_SECONDS = 20.0  # s, over which the rate of a temperature is taken
OWN_SHARE = 0.01  # of the square of an odd function of the rate, that no scale factor has
MAX_CYCLES, RAMPS, STEPS = 20.0, 24, 360  # of a campaign
OF_FORCE = ("power", "odd_power", "polynomial", "hysteresis")
OF_STATE = {
    "time": ("power", "polynomial", "harmonic", "exponential", "ramp", "telegraph"),
    "run_time": ("power", "polynomial", "exponential"),
    "angle": ("harmonic",),
    "rate": ("power", "odd_power", "polynomial", "exponential"),
    "temperature": ("polynomial", "exponential", "hysteresis"),
    "temperature_rate": ("odd_power", "product"),
} | dict.fromkeys(("force_x", "force_y", "force_z", "own_force"), OF_FORCE)
UNITS = {  # of the states; of forces g
    "time": "h",
    "run_time": "h",
    "angle": "rad",
    "rate": "× 10 °/s",
    "temperature": "K",
    "temperature_rate": "K/min",
}
SHAPED_IN_STATE = ("exponential", "ramp", "telegraph", "hysteresis")  # by values of the state
OWN = ("own_force", "other_forces")  # states that differ from axis to axis: laws of all axes
FACTORS = ("time", "rate", "force_x", "force_y", "force_z", "temperature", "temperature_rate")
PRODUCTS = tuple(
    f"{first}*{second}" for i, first in enumerate(FACTORS) for second in FACTORS[i + 1 :]
)
OF_ANY_ORIGIN = ("time", "temperature")  # states that are counted from any value
OF_DRIFTS = (*OF_ANY_ORIGIN, "temperature_rate")
LAWS = (
    *((family, name) for name, families in OF_STATE.items() for family in families),
    *(("product", name) for name in (*PRODUCTS, "other_forces")),
)


def state(name: str, motion: Motion, axis: int) -> Array:
    """A state at the nodes of each stretch, (n, 5), NaN where not known.

    `axis`: of the sensor, whose rate is that about its own axis; `name`: of `OF_STATE`, or two of
    them with a * between, their product; `other_forces` is that of the two other axes.
    """
    if "*" in name:
        first, second = (state(one, motion, axis) for one in name.split("*"))
        return np.asarray(first * second)
    n = len(motion.time)
    later = motion.seconds[:, None] * NODES
    if name in ("time", "run_time"):
        start = np.zeros(n) if name == "time" else _starts(motion)
        return np.asarray((motion.time - start)[:, None] + later) / HOUR
    if name == "angle":
        turning = np.where(motion.rate != 0, motion.angle, np.nan)
        return np.asarray(turning[:, None] + motion.rate[:, None] * later)
    if name == "rate":
        about = np.broadcast_to(motion.about, motion.up.shape)[:, axis]
        rate = motion.rate[:, None] + motion.acceleration[:, None] * later
        return np.asarray(about[:, None] * rate) / RATE
    up = without_leans(motion.up)
    if name.startswith("force"):
        values = up[:, AXES.index(name[-1])]
    elif name == "own_force":
        values = up[:, axis]
    elif name == "other_forces":
        values = np.prod(np.delete(up, axis, axis=1), axis=1)
    elif name == "temperature":
        values = motion.temperature - np.average(motion.temperature, weights=motion.seconds)
    else:
        values = temperature_rate(motion)
    return np.repeat(values[:, None], len(NODES), axis=1)


def _starts(motion: Motion) -> Array:
    """The time of the first stretch of each stretch's run of the instrument, (n,), s."""
    runs, place = np.unique(motion.run, return_inverse=True)
    first = np.array([motion.time[motion.run == run].min() for run in runs])
    return np.asarray(first[place])


def temperature_rate(motion: Motion) -> Array:
    """The rate of the temperature, (n,), K/min, NaN where not known."""
    if not np.isfinite(motion.time + motion.temperature).all():
        return np.full(len(motion.time), np.nan)
    at, place = np.unique(motion.time, return_inverse=True)
    course = np.bincount(place, motion.temperature) / np.bincount(place)
    ends = (motion.time - SLOPE_SECONDS / 2, motion.time + SLOPE_SECONDS / 2)
    before, after = (np.interp(time, at, course) for time in ends)
    span = np.maximum(np.clip(ends[1], *at[[0, -1]]) - np.clip(ends[0], *at[[0, -1]]), 1.0)
    return np.asarray((after - before) / span * MINUTE)


def functions(family: str, name: str, shape: tuple[float, ...], motion: Motion, axis: int) -> Array:
    """The functions of a family of one state: means over the stretches, (n, k), 0 where not known.

    polynomial (d): x … x^d, of the rate without x, which is the scale factor; power (p): |x|^p;
    odd_power (p): sign(x) |x|^p; harmonic (ν): cos νx and sin νx; exponential (c): e^(x/c); ramp
    (x₀): x − x₀ where above 0; telegraph (x₁, x₂ …): 1 between x₁ and x₂, x₃ and x₄, …; hysteresis
    (w): the play operator of half width w in the order of time; product: the state itself, and what
    the zero of a factor adds, see `beside_product`.
    """
    x = state(name, motion, axis)
    if family == "telegraph":
        return _known(between(motion, shape)[:, None])
    if family == "ramp":
        return _known(ramp(motion, shape[0])[:, None])
    if family == "hysteresis":
        return _known(play(x[:, len(NODES) // 2], motion.time, shape[0])[:, None])
    if family == "polynomial":
        values = [x**k for k in powers(name, shape[0])]
    elif family == "power":
        values = [np.abs(x) ** shape[0]]
    elif family == "odd_power":
        values = [np.sign(x) * np.abs(x) ** shape[0]]
    elif family == "harmonic":
        values = [np.cos(shape[0] * x), np.sin(shape[0] * x)]
    elif family == "exponential":
        values = [np.exp(x / shape[0])]
    else:
        values = [x, *(state(other, motion, axis) for other in beside_product(name))]
    return _known(np.column_stack([value @ WEIGHTS for value in values]))


def beside_product(name: str) -> tuple[str, ...]:
    """The factors of a drift that stand beside their product, for the zero of the other is free.

    (t − t₀)(T − T₀) is t T, less T₀ t and t₀ T. Of other products, what a zero adds is a scale
    factor or a sensitivity.
    """
    first, _, second = name.partition("*")
    if not {first, second} <= set(OF_DRIFTS):
        return ()
    return tuple(other for one, other in ((first, second), (second, first)) if one in OF_ANY_ORIGIN)


def powers(name: str, degree: float) -> range:
    """Those of a polynomial of a state."""
    return range(2 if name == "rate" else 1, round(degree) + 1)


def _known(values: Array) -> Array:
    return np.asarray(np.nan_to_num(values, posinf=0.0, neginf=0.0))


def after(motion: Motion, time: float) -> Array:
    """The share of each stretch after a time, h, (n,)."""
    return np.clip((motion.time - HOUR * time) / motion.seconds + 0.5, 0.0, 1.0)


def between(motion: Motion, times: tuple[float, ...]) -> Array:
    """The share of each stretch on the upper of two levels, changed at these times, h, (n,)."""
    return np.asarray(sum((-1) ** k * after(motion, time) for k, time in enumerate(times)))


def ramp(motion: Motion, start: float) -> Array:
    """The mean over each stretch of the time since a start, h, 0 before it, (n,)."""
    first, last = (
        np.maximum(motion.time + sign * motion.seconds / 2 - HOUR * start, 0.0) for sign in (-1, 1)
    )
    return np.asarray((last**2 - first**2) / (2 * motion.seconds) / HOUR)


def play(x: Array, time: Array, width: float) -> Array:
    """The play operator of half width `width` of a state (n,) in the order of time; at first 0."""
    order = np.argsort(time, kind="stable")
    held, result = 0.0, np.zeros_like(x)
    for i in order:
        if np.isfinite(x[i]):
            held = min(max(held, x[i] - width), x[i] + width)
        result[i] = held
    return result


def steps(motion: Motion, count: int) -> Array:
    """Evenly spaced times of a change between the first and the last stretch, h, (count,)."""
    return np.linspace(motion.time.min(), motion.time.max(), count + 2)[1:-1] / HOUR


def grid(family: str, name: str, motion: Motion) -> list[tuple[float, ...]]:
    """The shapes of a family that this motion can distinguish, alike for all axes.

    What an effect of the catalogue is by one state is left out: a straight line, the square of an
    own force.
    """
    x = np.stack([state(name, motion, axis) for axis in range(len(AXES))])
    low, high = float(np.nanmin(x)), float(np.nanmax(x))
    span = high - low
    if (
        name == "rate"
        and family in ("polynomial", "odd_power")
        and _proportional(x, motion.seconds)
    ):
        return []  # what is odd in it is the scale factor, but for the rate of the earth
    if family == "polynomial":
        return [(float(d),) for d in range(2, 6)]
    if family in ("power", "odd_power"):
        exponents = (0.25, 0.5, 0.75, 1.25, 1.5, 1.75, 2.0, 2.5, 3.0, 4.0, 5.0)
        return [(p,) for p in exponents if (name, p) != ("own_force", 2.0)]
    if family == "harmonic" and name == "angle":
        return [(order,) for order in np.arange(0.25, 12.01, 0.125).tolist()]
    if family == "harmonic":
        cycles = np.arange(1.0, MAX_CYCLES + 0.01, 1 / 3)
        return [(2 * np.pi * each / span,) for each in cycles.tolist()]
    if family == "exponential":
        return [(sign * span * share,) for share in (0.1, 0.2, 0.4, 0.8) for sign in (-1, 1)]
    if family == "ramp":
        return [(float(start),) for start in steps(motion, RAMPS)]
    if family == "hysteresis":
        return [(share * span / 2,) for share in (0.25, 0.5, 0.75, 0.9)]
    return [()]


def _proportional(rates: Array, seconds: Array) -> bool:
    """Whether what is odd in the rates, (3, n, 5), is all but in proportion to them.

    So it is where the table turns at one rate, to either side: the cube, weighted by the duration
    of the stretches, (n,), has little of its own beside the rate.
    """
    weight = np.sqrt(np.broadcast_to(seconds[:, None] * WEIGHTS, rates.shape)).ravel()
    first = np.nan_to_num(rates).ravel() * weight
    third = np.nan_to_num(rates**3).ravel() * weight
    own = third - first * (first @ third) / max(float(first @ first), np.finfo(float).tiny)
    return bool(own @ own <= OWN_SHARE * (third @ third))


def unknown(name: str, motion: Motion) -> str:
    """Why a state is not known in this motion, in a sentence; empty where it is."""
    if "temperature" in name and (why := without_temperature(motion)):
        return why
    return without_clock(motion) if "time" in name or "temperature_rate" in name else ""


def known(name: str, motion: Motion, axis: int) -> bool:
    """Whether a state is known in this motion, and varies; that of a run: where there are more."""
    if name == "run_time" and len(np.unique(motion.run)) == 1:
        return False
    x = state(name, motion, axis)
    finite = x[np.isfinite(x)]
    if name not in ("angle",) and len(finite) < x.size:
        return False
    return len(finite) > 0 and bool(np.ptp(finite) > 1e-3)
