"""Drawn campaigns in a chamber: which parameters follow which curve of the temperature."""

import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from block_statistics import GRAVITY, LATITUDE, Layout, pieces
from hidden_plans import sensors
from temperature_bound import Bound, Curve

import laboratory

Array = np.ndarray
Document = dict[str, Any]
Made = tuple[list[Document], float, list[Document]]  # manoeuvres, pause, s, steps of the chamber

SHAPES = ("1", "2", "3", "knee")
CURVES = 3  # parameters that are curves, in a campaign
RATIOS = (5.0, 40.0)  # signal-to-noise ratio of the highest coefficient, or of the bend
LOWER = 10.0  # sigma, spread of the lower coefficients
KNOTS = (0.35, 0.65)  # of the range, where a knee lies
# Sigma of a cubic, above which a plan does not show the curve of an element of M, of a bias of the
# accelerometers, m/s², or of the gyros, rad/s.
MAX_SIGMA = {"matrix": 1e-4, "accelerometer": 1e-3, "gyro": 1e-5}
BLOCK = 10.0  # s, of a rest
RATE = 50.0  # samples per second
GYRO, ACCELEROMETER = 0.15, 0.06  # °/√h and m/s/√h: a STIM300
MICRO_G, DEGREE_PER_HOUR = 9.80665e-6, np.radians(1 / 3600)
AXES = "xyz"
MARKS = {"x": "+y", "y": "+z", "z": "+x"}
WAYS = ("forward", "back")  # of a turn
ICE_POINT = 273.15


def _rest(name: str, log: str, up: str, seconds: float = 20.0) -> Document:
    mark = MARKS[up[1]]
    return {"id": f"{log}-{name}", "log": log, "do": "rest", "up": up, "mark": mark} | {
        "seconds": seconds
    }


def _turn(axis: str, log: str, degrees: float) -> Document:
    way = WAYS[degrees < 0]
    return {"id": f"{log}-{axis}-{way}", "log": log, "do": "turn", "up": f"+{axis}"} | {
        "mark": MARKS[axis],
        "degrees": degrees,
        "rate_deg_s": 60,
        "accel_deg_s2": 60,
    }


def _whole(log: str) -> list[Document]:
    """Six positions, and a turn each way about each axis."""
    rests = [_rest(f"{axis}{way}", log, sign + axis) for axis in AXES for way, sign in SIGNS]
    return rests + [_turn(axis, log, degrees) for axis in AXES for degrees in (360, -360)]


SIGNS = (("up", "+"), ("down", "-"))


def _few(log: str) -> list[Document]:
    """Four attitudes, and turns about z."""
    ups = ("+x", "+y", "+z", "-z")
    rests = [_rest(f"rest{i}", log, up) for i, up in enumerate(ups)]
    return rests + [_turn("z", log, degrees) for degrees in (360, -360)]


def _nodes(levels: tuple[int, ...]) -> Made:
    """All manoeuvres at each of several temperatures, which is held meanwhile."""
    plan = [m for i in range(len(levels)) for m in _whole(f"node{i}")]
    log, pause = 282.0, 1800.0
    steps: list[Document] = [{"hold_s": log}]
    for before, after in pairwise(levels):
        ramp = abs(after - before) / 3 * 60
        steps += [{"to_deg_c": after, "rate_k_min": 3}, {"hold_s": log + pause - ramp}]
    return plan, pause, steps


def _ramp() -> Made:
    """Few attitudes again and again while it warms by 1 K/min, the whole plan at both ends."""
    groups = [f"group{i}" for i in range(10)]
    plan = [m for g in groups for m in (_whole(g) if g in (groups[0], groups[-1]) else _few(g))]
    return plan, 300.0, [{"to_deg_c": 65, "rate_k_min": 1}]


def _soak() -> Made:
    """The whole plan at three temperatures; between them short rests, all attitudes in turn."""
    attitudes = [(f"{axis}{way}", sign + axis) for axis in AXES for way, sign in SIGNS]

    def between(level: int) -> list[Document]:
        return [
            _rest(f"{turn}-{name}", f"soak{level}", up, 40)
            for turn in range(8)
            for name, up in attitudes
        ]

    return _levels(between, 2 * 300 + 8 * len(attitudes) * 50)


def _single() -> Made:
    """The whole plan at three temperatures; between them a long rest in each of four attitudes.

    Each attitude sees a part of the temperatures only, so that what has a scale factor or a cross
    term between them is known where its attitude was.
    """

    def between(level: int) -> list[Document]:
        ups = ("+x", "+y", "+z", "-z")
        return [_rest(f"{i}", f"soak{level}-{i}", up, 240) for i, up in enumerate(ups)]

    return _levels(between, 6 * 300 + 4 * 240)


def _levels(between: Callable[[int], list[Document]], seconds: float) -> Made:
    """The whole plan at three temperatures, and what is done while the IMU follows the air."""
    plan = _whole("level0")
    for level in range(2):
        plan += [*between(level), *_whole(f"level{level + 1}")]
    steps: list[Document] = [{"hold_s": 400}]
    for to in (27, 65):
        steps += [{"to_deg_c": to, "rate_k_min": 10}, {"hold_s": seconds + 50}]
    return plan, 300.0, steps


PLANS: Mapping[str, tuple[Callable[[], Made], float]] = {  # and the time constant of the IMU, s
    "nodes": (lambda: _nodes((-10, 5, 20, 35, 50, 65)), 120.0),
    "ramp": (_ramp, 120.0),
    "soak": (_soak, 600.0),
    "single": (_single, 600.0),
}
REPORTED = "single"  # this plan does not determine all curves, and is reported without a demand


@dataclass(frozen=True)
class Planned:
    """A plan, its bound, and the temperatures at which it has whole sets of manoeuvres, K."""

    document: Document
    bound: Bound
    candidates: tuple[int, ...]  # parameters of which the plan shows a curve
    low: float
    high: float
    nodes: Array


@cache
def planned(plan: str) -> Planned:
    """A plan with nothing hidden."""
    document = document_of(plan)
    recording = laboratory.perform(laboratory.specify(document))
    layout = _layout(document["campaign"]["plan"])
    temperature = np.concatenate([_blocks_of(recording, piece) for piece in layout.parts])
    bound = Bound(layout, temperature, GYRO, ACCELEROMETER)
    low, high = float(temperature.min()), float(temperature.max())
    middle, half = (low + high) / 2, (high - low) / 2
    candidates = tuple(
        p for p in range(24) if (bound.alone(Curve(p, "3", middle, half)) < _most(p)).all()
    )
    by_log = [
        np.mean(recording.truth[log].temperature)
        for log, own in recording.truth.items()
        if sum(name.endswith(WAYS) for name in own.rows) == 2 * len(AXES)
    ]
    return Planned(document, bound, candidates, low, high, np.array(by_log))


def document_of(plan: str) -> Document:
    """The campaign of a plan with nothing hidden."""
    make, constant = PLANS[plan]
    return _document(*make(), constant)


def _most(p: int) -> float:
    if p % 12 < 9:
        return MAX_SIGMA["matrix"]
    return MAX_SIGMA["accelerometer" if p < 12 else "gyro"]


def _document(
    manoeuvres: list[Document], pause: float, steps: list[Document], constant: float
) -> Document:
    return {
        "campaign": {
            "campaign": 1,
            "instrument": {"name": "made up", "rate_hz": RATE},
            "serial": "unknown",
            "date": "unknown",
            "site": {"latitude_deg": float(np.degrees(LATITUDE)), "gravity_m_s2": GRAVITY}
            | {"gravity_sigma_m_s2": 1e-9},
            "table": {"name": "three-axis in a chamber", "heading_deg": 25}
            | {"position_sigma_arcsec": 2, "angle_sigma_arcsec": 2},
            "plan": manoeuvres,
        },
        "start": {"gps_week": 2443, "gps_second": 90018.0, "pause_s": pause},
        "receiver": {"message": "columns", "rate_hz": RATE, "gyro_count_rad": 1e-9}
        | {"accelerometer_count_m_s": 1e-7, "status": "00000077", "line_end": "lf"},
        "handling": {"still_s": 2, "change_s": 5},
        "truth": sensors(np.random.default_rng(0)),
        "temperature": {
            "start_deg_c": -10,
            "chamber": {"steps": steps, "time_constant_s": constant},
        },
        "noise": {
            "angle_random_walk_deg_sqrt_h": GYRO,
            "velocity_random_walk_m_s_sqrt_h": ACCELEROMETER,
            "gyro_rate_random_walk_deg_h_sqrt_h": 0,
            "accelerometer_random_walk_m_s2_sqrt_h": 0,
        },
        "effects": {},
        "seed": 1,
    }


def _layout(manoeuvres: list[Document]) -> Layout:
    """Every rest in blocks, so that the temperature may change within it."""
    parts = []
    for piece in pieces(manoeuvres):
        if piece.turn is None:
            k = max(1, round(float(piece.seconds[0]) / BLOCK))
            piece = replace(
                piece,
                seconds=np.repeat(piece.seconds / k, k),
                angles=np.repeat(piece.angles, k, axis=0),
                rates=np.zeros(k),
                phases=["rest"] * k,
            )
        parts.append(piece)
    return Layout(parts)


def _blocks_of(recording: laboratory.Recording, piece: Any) -> Array:
    """The mean temperature of each block, K."""
    log = next(log for log, own in recording.truth.items() if piece.manoeuvre in own.rows)
    truth = recording.truth[log]
    rows = truth.rows[piece.manoeuvre]
    edges = rows.start + np.round(np.append(0, np.cumsum(piece.seconds)) * RATE).astype(int)
    edges[-1] = min(edges[-1], rows.stop)
    pairs = pairwise(edges)
    return np.array([truth.temperature[a : max(b, a + 1)].mean() for a, b in pairs])


# ---- what is hidden


@dataclass(frozen=True)
class Drawn:
    """A drawn campaign: its document, its curves, and the SNR of each one's highest coefficient."""

    document: Document
    curves: tuple[Curve, ...]
    coefficients: tuple[Array, ...]  # in units of (T − middle) / half
    ratios: tuple[float, ...]

    def truth(self, p: int, at: Array) -> Array:
        """A parameter at temperatures, K, in SI."""
        value = np.full(len(at), _constants(self.document)[p])
        for curve, numbers in zip(self.curves, self.coefficients, strict=True):
            if curve.parameter == p:
                value = value + curve.shapes(at)[:, : len(numbers)] @ numbers
        return value


def _constants(document: Document) -> Array:
    """The 24 parameters at the reference: M − I by rows and the bias."""
    truth = document["truth"]
    return np.concatenate(
        [
            np.append(np.array(truth[sensor]["matrix"]) - np.eye(3), truth[sensor][bias])
            for sensor, bias in (("accelerometer", "bias_m_s2"), ("gyro", "bias_rad_s"))
        ]
    )


def drawn(name: str) -> Drawn:
    """The draw of a name, `plan|number`."""
    plan, _number = name.split("|")
    told = planned(plan)
    random = np.random.default_rng([2033, zlib.crc32(name.encode())])
    middle, half = (told.low + told.high) / 2, (told.high - told.low) / 2
    chosen = random.choice(told.candidates, CURVES, replace=False)
    curves = tuple(
        Curve(
            int(p),
            str(random.choice(SHAPES)),
            middle,
            half,
            told.low + float(random.uniform(*KNOTS)) * 2 * half,
        )
        for p in chosen
    )
    sigmas = list(told.bound.sigmas(curves)[24:])
    coefficients, ratios = [], []
    for curve in curves:
        own = np.array([sigmas.pop(0) for _ in range(curve.count)])
        ratio = float(np.exp(random.uniform(*np.log(RATIOS))))
        numbers = random.normal(0, LOWER, curve.count) * own
        numbers[-1] = ratio * own[-1] * random.choice([-1, 1])
        coefficients.append(numbers)
        ratios.append(ratio)
    document = told.document | {"truth": sensors(random), "seed": int(random.integers(2**31))}
    temperature = document["temperature"] | {"reference_deg_c": middle - ICE_POINT}
    effects = {"temperature_curves": _specified(curves, coefficients)}
    document |= {"temperature": temperature, "effects": effects}
    return Drawn(document, curves, tuple(coefficients), tuple(ratios))


def _specified(curves: tuple[Curve, ...], coefficients: list[Array]) -> Mapping[str, Any]:
    """The curves as the laboratory takes them."""
    told: dict[str, Any] = {}
    for curve, numbers in zip(curves, coefficients, strict=True):
        sensor, key = (
            ("accelerometer", "bias_micro_g")
            if curve.parameter < 12
            else (
                "gyro",
                "bias_deg_h",
            )
        )
        unit = MICRO_G if curve.parameter < 12 else DEGREE_PER_HOUR
        i = curve.parameter % 12
        if i < 9:
            key, unit, name = "matrix_ppm", 1e-6, AXES[i // 3] + AXES[i % 3]
        else:
            name = AXES[i - 9]
        per_kelvin = numbers / curve.half ** np.arange(1, len(numbers) + 1) / unit
        if curve.shape == "knee":
            below, bend = numbers / curve.half / unit
            shape: Document = {"knee_deg_c": curve.knot - ICE_POINT}
            shape |= {"below": float(below), "above": float(below + bend)}
        else:
            shape = {"powers": per_kelvin.tolist()}
        told.setdefault(sensor, {}).setdefault(key, {})[name] = shape
    return told
