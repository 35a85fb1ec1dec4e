"""Faults by size: as large as moves a result by so many sigma, at a place drawn by chance.

A fault of one manoeuvre moves the bias of its channel by its share of the rests, and the scale
factor by half of what it does to one of two opposite rests; `unit` of a campaign tells the sigmas.
Where a fault is there or not (a sign, a wiring) the size says nothing, and only the place is drawn.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import cases
import numpy as np
from cases import Cause, cause
from scipy.optimize import brentq
from scipy.stats import norm

Document = dict[str, Any]
Random = np.random.Generator
SENSORS = {"accel": "accelerometer", "gyro": "gyro"}
KEYS = {"accel": "m_s2", "gyro": "rad_s"}
SCATTER = {"accel": 1.067e-3, "gyro": 3.49e-5}  # of a reading at 100 Hz: m/s², rad/s
GRAVITY = 9.7936174
FORMULA_SIGMA = 5e-4  # m/s²: how far gravity is from the formula's


@dataclass(frozen=True)
class Place:
    """A manoeuvre of a clean campaign: its log and its lines there, counted from 0."""

    manoeuvre: str
    log: str
    rows: range
    up: str
    turns: bool


@dataclass(frozen=True)
class Setting:
    """What a fault is drawn in.

    `places`: of all manoeuvres; `sigmas`: of the clean result by sensor and parameter.
    """

    document: Document
    places: tuple[Place, ...]
    sigmas: Mapping[str, Mapping[str, float]]

    def rest(self, random: Random) -> Place:
        """One of the rests."""
        return _one(random, [place for place in self.places if not place.turns])

    def turn(self, random: Random) -> Place:
        """One of the turns."""
        return _one(random, [place for place in self.places if place.turns])

    def within(self, log: str) -> tuple[str, ...]:
        """The manoeuvres of a log."""
        return tuple(place.manoeuvre for place in self.places if place.log == log)

    def bias(self, sensor: str, axis: str) -> float:
        """By how much one rest must be off to move the bias by one sigma, m/s² or rad/s."""
        rests = sum(not place.turns for place in self.places)
        return rests * self.sigmas[sensor][f"bias_{axis}"]


@dataclass(frozen=True)
class Told:
    """A fault as the laboratory is told of it, and what the diagnosis must say.

    `spoiled`: manoeuvres whose readings it leaves nothing of.
    """

    changes: Document
    cause: Cause
    spoiled: tuple[str, ...] = ()


@dataclass(frozen=True)
class Fault:
    """`hide`: at so many sigma; `plans`: in which it can be; `sized`: whether a size means much."""

    name: str
    hide: Callable[[Setting, Random, float], Told]
    plans: tuple[str, ...] = ("positions", "stops", "rates")
    sized: bool = True


def _one(random: Random, some: list[Any]) -> Any:
    return some[int(random.integers(len(some)))]


def _channel(random: Random) -> tuple[str, str]:
    return str(random.choice(["accel", "gyro"])), str(random.choice(list("xyz")))


def _spikes(setting: Setting, random: Random, sigma: float) -> Told:
    sensor, axis = _channel(random)
    place, number = setting.rest(random), 30
    rows = random.choice(np.array(place.rows[20:-20]), number, replace=False)
    size = sigma * setting.bias(sensor, axis) * len(place.rows) / number
    size = max(size, 20 * SCATTER[sensor])  # smaller ones are noise
    told = {"log": place.log, "channel": f"{sensor}_{axis}", f"size_{KEYS[sensor]}": size}
    told["lines"] = sorted((rows + 1).tolist())
    return Told(cases.fault({"spikes": told}), cause({"spike"}, sensor, axis))


def _gap(setting: Setting, random: Random, sigma: float) -> Told:
    place, samples = setting.turn(random), int(10 * sigma)
    line = place.rows[0] + len(place.rows) // 2 + int(random.integers(-40, 40))
    told = {"log": place.log, "line": line, "samples": samples}
    return Told(cases.fault({"lose": told}), cause({"gap"}), (place.manoeuvre,))


def _repeated(setting: Setting, random: Random, sigma: float) -> Told:
    place = setting.rest(random)
    line = int(random.integers(place.rows[50], place.rows[-50]))
    told = {"log": place.log, "line": line, "samples": int(sigma), "stamps": "same"}
    return Told(cases.fault({"repeat": told}), cause({"duplicate"}))


def _clipped(setting: Setting, random: Random, sigma: float) -> Told:
    """The range ends within the scatter of a rest: −E[(n − k)⁺] is the shift of its mean."""
    upright = [o for o in setting.places if not o.turns and o.up in ("+x", "+y", "+z")]
    place = _one(random, upright)
    axis = place.up[1]
    truth = setting.document["truth"]["accelerometer"]
    number = "xyz".index(axis)
    level = GRAVITY * truth["matrix"][number][number] + truth["bias_m_s2"][number]
    share = min(sigma * setting.bias("accel", axis) / SCATTER["accel"], 2.0)
    at = float(brentq(lambda k: norm.pdf(k) - k * norm.sf(k) - share, -3.0, 5.0))
    told = {"log": place.log, "channel": f"accel_{axis}"}
    told |= {"limit_m_s2": level + at * SCATTER["accel"]}
    names = {"saturation", "accel_saturation"}
    return Told(cases.fault({"clip": told}), cause(names, "accel", axis), (place.manoeuvre,))


def _knock(setting: Setting, random: Random, sigma: float) -> Told:
    place = setting.rest(random)
    line = int(random.integers(place.rows[100], place.rows[-200]))
    told = cases.KNOCK | {"log": place.log, "line": line}
    told |= {"peak_m_s2": 5.0 * sigma, "peak_rad_s": 0.25 * sigma}
    return Told(cases.fault({"knock": told}), cause(cases.IMPACT))


def _clock(setting: Setting, random: Random, sigma: float) -> Told:
    place = setting.rest(random)
    ppm = sigma * 2 * setting.sigmas["accel"]["scale_x"] * 1e6 * float(random.choice([-1, 1]))
    told = {"log": place.log, "ppm": ppm}
    return Told(cases.fault({"drift": told}), cause(cases.CLOCK), setting.within(place.log))


def _dead(setting: Setting, random: Random, sigma: float) -> Told:
    sensor, axis = _channel(random)
    place = setting.rest(random)
    samples = int(10 * sigma)
    line = int(random.integers(place.rows[20], place.rows[-20] - samples))
    told = {"log": place.log, "channel": f"{sensor}_{axis}", "line": line, "samples": samples}
    return Told(
        cases.fault({"kill": told | {"reads": "frozen"}}), cause({"dead_axis"}, sensor, axis)
    )


def _position(setting: Setting, random: Random, sigma: float) -> Told:
    place = _one(random, [o for o in setting.places if not o.turns and o.up in cases.UPS])
    by = sigma * setting.bias("accel", "x") / GRAVITY
    return Told(
        cases.set_off(place.manoeuvre, place.up, by),
        cause(cases.POSITION, "accel", manoeuvre=place.manoeuvre),
        (place.manoeuvre,),
    )


def _angle(setting: Setting, random: Random, sigma: float) -> Told:
    place = setting.turn(random)
    axis = place.up[1]
    written = next(
        one for one in setting.document["campaign"]["plan"] if one["id"] == place.manoeuvre
    )
    turns = sum(o.turns and o.up[1] == axis for o in setting.places)
    off = sigma * turns * setting.sigmas["gyro"][f"scale_{axis}"] * written["degrees"]
    stated = {place.manoeuvre: {"degrees": written["degrees"] - off}}
    return Told(
        {"misstated": {"plan": stated}},
        cause(cases.ANGLE, "gyro"),
        (place.manoeuvre,),
    )


def _gravity(setting: Setting, random: Random, sigma: float) -> Told:
    """Of what moves the result of the repaired campaign: the sigma of the formula."""
    off = (3 + sigma) * FORMULA_SIGMA * float(random.choice([-1, 1]))
    stated = setting.document["campaign"]["site"]["gravity_m_s2"] + off
    return Told(cases.stated(site={"gravity_m_s2": stated}), cause(cases.GRAVITY, "accel"))


def _signs(setting: Setting, random: Random, sigma: float) -> Told:
    sensor, axis = _channel(random)
    return Told(cases.flipped(SENSORS[sensor], axis), cause(cases.SIGNS, sensor, axis))


def _axes(setting: Setting, random: Random, sigma: float) -> Told:
    sensor, _ = _channel(random)
    axes = random.choice(list("xyz"), 2, replace=False).tolist()
    told = {"log": "all", "sensor": SENSORS[sensor], "axes": axes}
    return Told(cases.fault({"swap": told}), cause(cases.AXES, sensor))


def _counts(setting: Setting, random: Random, sigma: float) -> Told:
    factor = float(random.choice([180 / np.pi, 2.0, 0.5, np.pi / 180]))
    stated = cases.stated(instrument=cases.of_counts(cases.COUNT * factor))
    return Told(stated, cause(cases.COUNTS, "gyro"))


def _sense(setting: Setting, random: Random, sigma: float) -> Told:
    return Told(cases.turned_the_other_way(setting.document), cause(cases.SENSE))


def _exchanged(setting: Setting, random: Random, sigma: float) -> Told:
    places = {o.log: o for o in setting.places if o.turns is (sigma > 4)}
    one, other = random.choice(sorted(places), 2, replace=False).tolist()
    while places[one].up == places[other].up:
        one, other = random.choice(sorted(places), 2, replace=False).tolist()
    return Told(cases.fault({"exchange": {"logs": [one, other]}}), cause(cases.EXCHANGED))


def _sample_rate(setting: Setting, random: Random, sigma: float) -> Told:
    rate = float(random.choice([50, 125, 200]))
    return Told({"receiver": {"rate_hz": rate}}, cause(cases.STATED_RATE))


def _hemisphere(setting: Setting, random: Random, sigma: float) -> Told:
    latitude = setting.document["campaign"]["site"]["latitude_deg"]
    names = {"latitude_error", "latitude_sign"}
    return Told({"truth": {"latitude_deg": -latitude}}, cause(names, "gyro"))


HEADED, RECEIVED, ALONE = ("stops", "rates"), ("positions", "stops"), ("positions",)
FAULTS: tuple[Fault, ...] = (
    Fault("spikes", _spikes),
    Fault("gap in a turn", _gap),
    Fault("repeated records", _repeated),
    Fault("clipping within the scatter", _clipped, RECEIVED),
    Fault("impact", _knock),
    Fault("clock of one log", _clock, RECEIVED),
    Fault("dead axis", _dead),
    Fault("position off", _position, ALONE),
    Fault("angle of a turn off", _angle),
    Fault("gravity stated wrong", _gravity),
    Fault("sign of an axis", _signs, sized=False),
    Fault("axes exchanged", _axes, sized=False),
    Fault("count size of the gyros", _counts, RECEIVED, sized=False),
    Fault("sense of the table", _sense, sized=False),
    Fault("logs exchanged", _exchanged, ALONE, sized=False),
    Fault("sample rate", _sample_rate, RECEIVED, sized=False),
    Fault("latitude of the other hemisphere", _hemisphere, HEADED, sized=False),
)
BY_NAME = {fault.name: fault for fault in FAULTS}
