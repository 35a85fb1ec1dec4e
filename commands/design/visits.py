"""What may be done in one attitude of a table: a rest, and turns about the vertical there and back.

A visit is the unit of a design. Its manoeuvres share their position, and so its error.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import Any

import numpy as np

from commands.design.turntable import Turntable, direction
from inertial.arrays import Array, nearest_axis
from inertial.campaign.foreseen import Pace, session_seconds
from inertial.campaign.records import Manoeuvre
from inertial.physics.motion import Profile, level_axes
from inertial.text.units import DEGREE

Item = dict[str, Any]

RESTS = (30.0, 90.0, 180.0, 300.0)  # s
TURNING = (10.0, 30.0, 90.0)  # s, about which a turn takes one way
RATE_SHARES = (1.0, 0.25)  # of the largest rate
CLOSE = 1e-9


@dataclass(frozen=True)
class Visit:
    """A rest and turns there and back in one attitude.

    `up`: body axes; `rest`: s, 0 for none; `turns`: rate, °/s, and whole turns one way, of each.
    """

    up: tuple[float, float, float]
    rest: float = 0.0
    turns: tuple[tuple[float, int], ...] = ()

    def items(self, name: str, table: Turntable) -> list[Item]:
        """Its manoeuvres as the plan of a campaign file has them."""
        at: Item = {"position": name, "up": written(np.array(self.up))}
        if table.oriented:
            at["mark"] = written(level_axes(np.array(self.up))[0])
        found = []
        if self.rest:
            found.append({"id": f"{name}-rest", "do": "rest", **at, "seconds": self.rest})
        for number, (rate, turns) in enumerate(self.turns, 1):
            which = f"-{number}" if len(self.turns) > 1 else ""
            for way, sign in (("forward", 1), ("back", -1)):
                turn = {"id": f"{name}{which}-{way}", "do": "turn", **at}
                turn |= {"degrees": sign * 360 * turns, "rate_deg_s": rate}
                found.append(turn | {"accel_deg_s2": table.entry["accel_deg_s2"]})
        return found


def written(vector: Array) -> str | list[float]:
    """A direction as a campaign file has it: a body axis with its sign, or three numbers."""
    axis = nearest_axis(vector)
    if abs(vector[axis]) > 1 - CLOSE:
        return f"{'-' if vector[axis] < 0 else '+'}{'xyz'[axis]}"
    return [round(float(each), 9) + 0.0 for each in vector]  # no −0


def manoeuvre_of(item: Item, angle_sigma: float) -> Manoeuvre:
    """A rest or a whole turn of a plan as the stages have it; `angle_sigma`: rad."""
    up = direction(item["up"])
    rest = Manoeuvre(
        name=item["id"],
        do="rest",
        log="",
        position=str(item.get("position", item["id"])),
        mount="as mounted",
        up=up,
        mark=direction(item["mark"]) if "mark" in item else None,
        seconds=item.get("seconds"),
    )
    if item["do"] == "rest":
        return rest
    angle = item["degrees"] * DEGREE
    rate = float(np.copysign(item["rate_deg_s"] * DEGREE, angle))
    ramp = item["accel_deg_s2"] * DEGREE
    return replace(
        rest,
        do="turn",
        about=up,
        angle=angle,
        angle_sigma=angle_sigma,
        rate=rate,
        acceleration=ramp,
        seconds=Profile(abs(angle), abs(rate), ramp).seconds,
    )


def items_of(visits: Sequence[Visit], table: Turntable, prefix: str = "p") -> list[Item]:
    """The plan of visits one after another, each a position of its own."""
    width = len(str(len(visits)))
    named = [(f"{prefix}{number:0{width}d}", visit) for number, visit in enumerate(visits, 1)]
    return [item for name, visit in named for item in visit.items(name, table)]


def plan_of(items: Sequence[Item], table: Turntable) -> list[Manoeuvre]:
    """The manoeuvres of a plan at this table."""
    return [manoeuvre_of(item, table.angle_sigma) for item in items]


def possible(
    table: Turntable,
    max_rate: float,
    rests: Sequence[float] = RESTS,
    shares: Sequence[float] = RATE_SHARES,
    turning: Sequence[float] = TURNING,
    *,
    both: bool = True,
    single: bool = False,
) -> list[Visit]:
    """The visits among which a plan is chosen.

    Turns are about an axis of the case: about another one each accelerometer would be pulled by all
    three components of a lever arm of its own, which the estimation does not know.

    Parameters
    ----------
    max_rate : of the gyros, °/s
    rests, turning : s, of a rest, and of a turn one way
    shares : of the largest rate
    both : whether a visit may hold a rest and turns
    single : whether its turns are at one of the rates, and not at all of them: else a scale factor
        that depends on the rate would pass for another scale factor
    """
    fastest = min(table.rate, max_rate)
    rates = [float(f"{share * fastest:.3g}") for share in shares]
    each = [[(rate, max(round(s * rate / 360), 1)) for rate in rates] for s in turning]
    sets = {(turn,) for turns in each for turn in turns} if single else set(map(tuple, each))
    found = []
    for up in table.ups:
        here = Visit((float(up[0]), float(up[1]), float(up[2])))
        found += [replace(here, rest=rest) for rest in rests]
        if np.abs(up).max() < 1 - CLOSE:
            continue
        for rest, turns in product((0.0, *rests) if both else (0.0,), sorted(sets)):
            found.append(replace(here, rest=rest, turns=turns))
    return found


def visit_seconds(visit: Visit, table: Turntable) -> float:
    """The time at the table for a visit, the change to it included, s."""
    pace: Pace = table.pace
    return session_seconds(plan_of(visit.items("p", table), table), pace) + pace.change


def published(items: Sequence[Mapping[str, Any]], table: Turntable) -> Iterator[Item]:
    """The rests and turns of a plan to record by, at this table: with marks where it has a heading.

    Rates beyond the table's are its largest.
    """
    for item in items:
        keys = {k: v for k, v in item.items() if k not in ("log", "format", "mount")}
        if table.oriented:
            keys["mark"] = written(level_axes(direction(item["up"]))[0])
        if item["do"] == "turn":
            keys["rate_deg_s"] = min(item["rate_deg_s"], table.rate)
            keys["accel_deg_s2"] = min(item["accel_deg_s2"], table.entry["accel_deg_s2"])
        yield keys
