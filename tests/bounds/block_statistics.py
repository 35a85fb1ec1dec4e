"""What an IMU on the table would read, block by block, by its own exact physics and no noise.

The unknowns are one vector: M of the accelerometers by rows and their bias, the same of the gyros,
then two tilts for each position, and two of the table's axis there, by which the force goes round
in turns; the error of the angle of each turn, and the lever arm from the table's axis to each
accelerometer along its own axis. It shares no code with the stages.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import study_plans as plans

Array = np.ndarray

LATITUDE, GRAVITY, EARTH = np.radians(30.5278), 9.7936174, 7.292115e-5
EARTH_UP, EARTH_LEVEL = EARTH * np.sin(LATITUDE), EARTH * np.cos(LATITUDE)
HEADING = np.radians(25)
ARC_SECOND = np.radians(1 / 3600)
SANE = 0.1  # by how much M of the gyros may be off the unit matrix: all that rests alone leave open
STILL = 2.0  # s, at rest before and after a turn
BLOCK = 0.2  # s, of a turn
LEVER_ARM = 0.1  # m, how far off the table's axis an IMU may stand
STEPS = 8  # of a block, in which the earth turns in body axes


@dataclass(frozen=True)
class Piece:
    """One rest or turn: k blocks of `seconds`, at these angles and rates of the table.

    `up`, `mark`, `about`: (3,), set directions, body axes before the turn; `angles`: (k, STEPS),
    rad; `rates`: (k,), rad/s, means; `phases`: (k,).
    """

    manoeuvre: str
    position: str
    turn: int | None  # number of the turn
    up: Array
    mark: Array
    about: Array
    seconds: Array
    angles: Array
    rates: Array
    phases: Sequence[str]


def unit(direction: str | Sequence[float]) -> Array:
    if not isinstance(direction, str):
        return np.asarray(np.asarray(direction) / np.linalg.norm(direction))
    sign = 1.0 if direction[0] == "+" else -1.0
    return np.asarray(sign * np.eye(3)["xyz".index(direction[1])])


def turned(vectors: Array, axis: Array, angle: Array) -> Array:
    """Rotate vectors (…, 3) about an axis (3,) by angles (…), right hand (Rodrigues)."""
    c, s = np.cos(angle)[..., None], np.sin(angle)[..., None]
    along = (vectors @ axis)[..., None] * axis
    return np.asarray(c * vectors + s * np.cross(axis, vectors) + (1 - c) * along)


def pieces(plan: Sequence[Mapping[str, Any]]) -> list[Piece]:
    """Every rest and turn; a tumble is its rests, as the pipeline numbers them."""
    found: list[Piece] = []
    for item in plan:
        up, mark = unit(item["up"]), unit(item["mark"])
        name, position = item["id"], item.get("position", item["id"])
        if item["do"] == "tumble":
            about = unit(item["about"])
            for number in range(item["steps"]):
                # The case turns by the right hand, so the vertical goes the other way in it.
                angle = np.array(-np.radians(number * item["step_degrees"]))
                ups, marks = turned(up, about, angle), turned(mark, about, angle)
                own = f"{name}-{number:02d}"
                found.append(_rest(own, own, ups, marks, item["seconds"]))
        elif item["do"] == "rest":
            found.append(_rest(name, position, up, mark, item["seconds"]))
        else:
            number = sum(p.turn is not None for p in found)
            found.append(_turn(item, position, number, up, mark))
    return found


def _rest(name: str, position: str, up: Array, mark: Array, seconds: float) -> Piece:
    zero = np.zeros((1, STEPS))
    long = np.array([float(seconds)])
    return Piece(name, position, None, up, mark, up, long, zero, np.zeros(1), ["rest"])


def _turn(item: Mapping[str, Any], position: str, number: int, up: Array, mark: Array) -> Piece:
    """From STILL before to STILL after, the rate a trapezoid."""
    whole, rate, ramp = (np.radians(item[k]) for k in ("degrees", "rate_deg_s", "accel_deg_s2"))
    sign, size = np.sign(whole), abs(whole)
    up_s, last = rate / ramp, size / rate + rate / ramp
    count = int(np.ceil(last / BLOCK))
    edges = np.minimum(np.arange(count + 1) * BLOCK, last)

    def angle(t: Array) -> Array:
        after = size - ramp * (last - t) ** 2 / 2
        steady = np.where(t > last - up_s, after, rate * (t - up_s / 2))
        return np.asarray(np.where(t < up_s, ramp * t**2 / 2, steady))

    seconds = np.diff(edges)
    fine = edges[:-1, None] + seconds[:, None] * (np.arange(STEPS) + 0.5) / STEPS
    rates = sign * np.diff(angle(edges)) / seconds
    steady = (edges[:-1] >= up_s) & (edges[1:] <= last - up_s)
    middle = np.where(steady, "steady", np.where(edges[:-1] < up_s, "spin-up", "spin-down"))
    return Piece(
        item["id"],
        position,
        number,
        up,
        mark,
        up,
        np.concatenate([[STILL], seconds, [STILL]]),
        np.concatenate(
            [np.zeros((1, STEPS)), sign * angle(fine), np.full((1, STEPS), sign * size)]
        ),
        np.concatenate([[0.0], rates, [0.0]]),
        ["rest-before", *middle, "rest-after"],
    )


@dataclass(frozen=True)
class Layout:
    """Where each unknown stands, and how well it is known beforehand (NaN: not at all)."""

    parts: list[Piece]

    @property
    def positions(self) -> list[str]:
        return list(dict.fromkeys(p.position for p in self.parts))

    @property
    def turns(self) -> int:
        return sum(p.turn is not None for p in self.parts)

    @property
    def known(self) -> Array:
        """Sigmas of the unknowns, (24 + 4 positions + turns + 3,)."""
        errors = np.full(4 * len(self.positions) + self.turns, plans.ARCSECONDS * ARC_SECOND)
        sought = np.full(24, np.nan)
        sought[12:21] = SANE
        return np.concatenate([sought, errors, np.full(3, LEVER_ARM)])

    def truth(self) -> Array:
        """The unknowns of an ideal IMU on an ideal table."""
        ideal = np.append(np.eye(3).ravel(), np.zeros(3))
        return np.concatenate([ideal, ideal, np.zeros(len(self.known) - 24)])

    def read(self, unknowns: Array) -> Array:
        """Mean readings of all blocks: specific force, m/s², and rate, rad/s; (blocks, 6)."""
        (force, force_bias), (rate, rate_bias) = (
            (part[:9].reshape(3, 3), part[9:]) for part in (unknowns[:12], unknowns[12:24])
        )
        count = 24 + 4 * len(self.positions)
        tilts, tilts_of_axis = unknowns[24:count].reshape(2, -1, 2)
        angles, arm = unknowns[count:-3], unknowns[-3:]
        rows = []
        for p in self.parts:
            first = p.mark
            second = np.cross(p.up, p.mark)
            tilt = tilts[self.positions.index(p.position)]
            vector = tilt[0] * first + tilt[1] * second
            size = float(np.linalg.norm(vector))
            axis = vector / size if size else first

            def lean(v: Array, axis: Array = axis, size: float = size) -> Array:
                return turned(v, axis, np.array(size))

            up, mark, about = lean(p.up), lean(p.mark), lean(p.about)
            north = np.cos(HEADING) * mark + np.sin(HEADING) * np.cross(up, mark)
            stretch = 1.0
            if p.turn is not None:
                whole = p.angles[-1, -1]
                stretch = (whole + angles[p.turn]) / whole
            turned_by = -p.angles * stretch
            ups = turned(np.broadcast_to(up, (*turned_by.shape, 3)), about, turned_by).mean(1)
            norths = turned(np.broadcast_to(north, (*turned_by.shape, 3)), about, turned_by).mean(1)
            spin = p.rates[:, None] * stretch * about
            felt = spin + EARTH_UP * ups + EARTH_LEVEL * norths
            if p.turn is not None:
                axis_tilt = tilts_of_axis[self.positions.index(p.position)]
                lies = axis_tilt[0] * first + axis_tilt[1] * second
                round_ = turned(np.broadcast_to(lies, (*turned_by.shape, 3)), p.up, turned_by)
                ups = ups + np.cross(round_.mean(1) - lies, p.up)
            pull = np.square(p.rates * stretch)[:, None] * (about * (about @ arm) - arm)
            felt_force = GRAVITY * ups + pull
            rows.append(np.hstack([felt_force @ force.T + force_bias, felt @ rate.T + rate_bias]))
        return np.vstack(rows)

    @property
    def seconds(self) -> Array:
        """How long each block lasts, (blocks,)."""
        return np.concatenate([p.seconds for p in self.parts])
