"""The manoeuvres of a plan, every shorthand expanded: one row each, SI, body axes."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import cos, isclose, pi, radians
from typing import Any

import numpy as np

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.records import Row, vector_of
from inertial.physics.motion import Profile, is_vertical, turned, turned_between
from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND, DEGREE, ICE_POINT, in_si
from stages.plan.sampling import are_means
from stages.plan.taken_as_known import ASSUMED_ANGLE, by_hand

DIRECTIONS = np.eye(3)
MAX_BELOW_RATE = 0.01  # by which a turn may stay below its rate

MIN_TURNED = 1e-9  # rad, less is rounding
ATTITUDE = tuple(f"{of}_{axis}" for of in ("up", "mark") for axis in tables.AXES)
_ALWAYS = {
    "id",
    "do",
    "log",
    "format",
    "span",
    "rows",
    "where",
    "mount",
    "position",
    "gyro",
    "power_cycle",
}
_ALWAYS |= {"temperature_deg_c", "temperature_sigma_k"}
_ALLOWED = {
    "rest": {"up", "mark", "seconds"},
    "positions": {"seconds"},
    "turn": {
        *("up", "mark", "about", "degrees", "degrees_sigma"),
        *("rate_deg_s", "accel_deg_s2", "seconds", "recorded"),
    },
    "tumble": {"up", "mark", "about", "step_degrees", "steps", "and_back", "seconds"},
}
# Manoeuvres with a purpose of their own; for the calibration they are rests and turns like others.
PURPOSES = {"align": ("rest", "alignment"), "modulate": ("turn", "modulation")}
_ALLOWED |= {name: _ALLOWED[do] for name, (do, _purpose) in PURPOSES.items()}


def expanded(file: YamlFile, key: Key, item: dict[str, Any]) -> Iterator[Row]:
    """One row for a rest, a turn or a search for positions; one per rest of a tumble."""
    do, purpose = PURPOSES.get(item["do"], (item["do"], None))
    row: Row = {
        "manoeuvre": item["id"],
        "do": do,
        "purpose": purpose,
        "position": item.get("position", item["id"]),
        "mount": item.get("mount", "as mounted"),
        "power_cycle": item.get("power_cycle", False),
        "recorded": item.get("recorded", "whole"),
        "seconds": item.get("seconds"),
        "angle": None,
        "angle_sigma": None,
        "rate": None,
        "rate_sigma": None,
        "acceleration": in_si(item.get("accel_deg_s2"), DEGREE),
        "turned_on": 0.0,
        "tumble": None,
        **_components({"tumble_axis": None, "tumbled": None}),
        **_temperature(file, key, item),
    }
    up, mark = _direction(file, [*key, "up"], item), _direction(file, [*key, "mark"], item)
    if up is not None and mark is not None and abs(up @ mark) > cos(radians(1)):
        raise file.refuse(
            [*key, "mark"], item["mark"], "a direction across up", "name a level direction"
        )
    allowed = _ALLOWED[item["do"]]
    for name in set(item) - allowed - _ALWAYS:
        raise file.refuse_text(
            [*key, name],
            _("the key {name!r}", name=name),
            _(
                "for do: {do} one of {join}",
                do=item["do"],
                join=", ".join(sorted(allowed | _ALWAYS)),
            ),
            _("remove {name}, or correct do", name=name),
        )
    if purpose is not None and up is None:
        raise file.refuse_text(
            key,
            _("do: {do} without a known up", do=item["do"]),
            _("up, the body direction that points up"),
            _("add up: the alignment is told against it"),
        )
    if do == "turn":
        about = _direction(file, [*key, "about"], item)
        about = up if about is None else about
        if about is None:
            raise file.refuse_text(
                key,
                _("a turn without an axis"),
                "about, or up",
                _("add about: the axis of the turn"),
            )
        yield row | _vectors(up, mark, about) | _turn(file, key, item)
    elif do == "tumble":
        yield from _tumble(file, key, item, row, up, mark)
    else:
        yield row | _vectors(up, mark, None)


def stays_in_position(before: Row, after: Row) -> bool:
    """Whether a manoeuvre of the same log begins in the attitude in which the one before ended.

    On a table it is the same set position, with the same error, unless the campaign says otherwise;
    a hand turns none back to where it stood. A tumble is set at each of its rests, and so is what
    rows of means are of.
    """
    if any(before[name] != after[name] for name in ("file", "format", "mount")):
        return False
    if before["up_x"] is None or {before["do"], after["do"]} - {"rest", "turn"}:
        return False
    turns = (before["angle"] or 0.0) / (2 * pi)
    comes_back = before["do"] == "rest" or (bool(turns) and isclose(turns, round(turns)))
    alike = all(before[name] == after[name] for name in ATTITUDE)
    set_anew = before["tumble"] or after["tumble"] or are_means(after["layout"])
    return comes_back and alike and not set_anew


@dataclass
class StatedPosition:
    """A position that the campaign names, as it is used in one log.

    `first`: its first manoeuvre; `turned`: rad, by the turns without a mark so far.
    """

    first: Row | None = None
    turned: float = 0.0

    def turned_on(self, row: Row) -> float:
        """By how much the next manoeuvre begins further about the vertical than the first, rad.

        The marks tell it; without any the turns of the plan do, if they are no whole revolutions.
        """
        place = ("position", "file", "up_x", "up_y", "up_z")
        if self.first is None or any(row[key] != self.first[key] for key in place):
            self.first, self.turned = row, 0.0
        up, mark, about = (vector_of(row, of) for of in ("up", "mark", "about"))
        before = vector_of(self.first, "mark")
        if up is None:
            return 0.0
        if mark is not None:
            on = 0.0 if before is None else turned_between(up, before, mark)
        else:
            on = float(np.arctan2(np.sin(self.turned), np.cos(self.turned)))
            if about is not None and is_vertical(up, about):
                self.turned += (row["angle"] or 0.0) * float(up @ about)
        return on if abs(on) > MIN_TURNED else 0.0


def _temperature(file: YamlFile, key: Key, item: dict[str, Any]) -> Row:
    """What the campaign states of the temperature, K."""
    stated, sigma = item.get("temperature_deg_c"), item.get("temperature_sigma_k")
    if stated is None and sigma is not None:
        raise file.refuse_text(
            [*key, "temperature_sigma_k"],
            _("a standard deviation of no temperature"),
            "temperature_deg_c",
            _("add temperature_deg_c, or remove temperature_sigma_k"),
        )
    return {
        "temperature": None if stated is None else stated + ICE_POINT,
        "temperature_sigma": sigma,
    }


def _direction(file: YamlFile, key: Key, item: dict[str, Any]) -> Array | None:
    """A unit vector in body axes; none where it is left out or unknown."""
    stated = item.get(str(key[-1]), "unknown")
    if stated == "unknown":
        return None
    if isinstance(stated, str):
        sign = -1.0 if stated[0] == "-" else 1.0
        return np.asarray(sign * DIRECTIONS["xyz".index(stated[1])], dtype=np.float64)
    vector = np.array(stated, dtype=np.float64)
    length = float(np.linalg.norm(vector))
    if length == 0:
        raise file.refuse(key, stated, _("a vector that is not zero"), "correct the vector")
    return np.asarray(vector / length, dtype=np.float64)


def _vectors(up: Array | None, mark: Array | None, about: Array | None) -> Row:
    return _components({"up": up, "mark": mark, "about": about})


def _components(vectors: Mapping[str, Array | None]) -> Row:
    return {
        f"{name}_{axis}": None if vector is None else float(vector[i])
        for name, vector in vectors.items()
        for i, axis in enumerate(tables.AXES)
    }


def _turn(file: YamlFile, key: Key, item: dict[str, Any]) -> Row:
    """Angle, rate and duration of a turn; two of the three suffice, by hand none is needed."""
    angle, rate = in_si(item.get("degrees"), DEGREE), in_si(item.get("rate_deg_s"), DEGREE)
    acceleration = in_si(item.get("accel_deg_s2"), DEGREE)
    seconds: float | None = item.get("seconds")
    _check_signs(file, key, item)
    if angle is not None and rate is not None:
        rate = float(np.copysign(rate, angle))
        _check_peak(file, key, angle, rate, acceleration)
        profile = Profile(abs(angle), abs(rate), acceleration or np.inf)
        if seconds is not None and not isclose(profile.seconds, seconds, rel_tol=0.05):
            raise file.refuse(
                [*key, "seconds"],
                seconds,
                _(
                    "about {seconds:.4g} s by degrees, rate_deg_s and accel_deg_s2",
                    seconds=profile.seconds,
                ),
                _("leave out one of degrees, rate_deg_s and seconds"),
            )
        seconds = profile.seconds
    elif rate is not None and seconds is not None:
        angle = rate * (seconds - (abs(rate) / acceleration if acceleration else 0.0))
    elif angle is not None and seconds is not None:
        rate = angle / seconds
    elif not by_hand(file.content) and not (rate is not None and item.get("recorded") == "steady"):
        raise file.refuse_text(
            key,
            _("fewer than two of degrees, rate_deg_s and seconds"),
            _("two of them; for recorded: steady a signed rate"),
            _("add what the table was set to; of a table turned by hand the name is: by hand"),
        )
    sigma = None if angle is None else _angle_sigma(file, key, item)
    sense = _sense(file)
    return {
        "angle": None if angle is None else sense * angle,
        "angle_sigma": sigma,
        "rate": None if rate is None else sense * rate,
        "seconds": seconds,
    }


def _check_peak(
    file: YamlFile, key: Key, angle: float, rate: float, acceleration: float | None
) -> None:
    """Refuse a turn that must stop before it has reached its rate."""
    if acceleration is None:
        return
    peak = np.sqrt(abs(angle) * acceleration) / DEGREE
    if peak < (1 - MAX_BELOW_RATE) * abs(rate) / DEGREE:
        raise file.refuse_text(
            [*key, "rate_deg_s"],
            f"{abs(rate) / DEGREE:g}",
            _(
                "at most {peak:.4g}, which is reached within degrees: {degrees:g} by "
                "accel_deg_s2: {acceleration:g}",
                peak=peak,
                degrees=angle / DEGREE,
                acceleration=acceleration / DEGREE,
            ),
            _("correct one of the three, as the table was set"),
        )


def _sense(file: YamlFile) -> int:
    """The sign of a turn by the right-hand rule whose degrees on the table are positive."""
    return -1 if file.content.get("table", {}).get("counts") == "clockwise" else 1


def _check_signs(file: YamlFile, key: Key, item: dict[str, Any]) -> None:
    """The sign of a turn stands in degrees, or in the rate where degrees is not given."""
    for name in ("degrees", "rate_deg_s"):
        if item.get(name) == 0:
            raise file.refuse([*key, name], 0, _("a number that is not 0"), f"correct {name}")
    if "degrees" in item and item.get("rate_deg_s", 1) < 0:
        raise file.refuse(
            [*key, "rate_deg_s"],
            item["rate_deg_s"],
            _("a magnitude, for degrees has the sign"),
            _("leave the sign to degrees"),
        )


def _angle_sigma(file: YamlFile, key: Key, item: dict[str, Any]) -> float:
    """How well the angle of a turn is known, rad."""
    table = file.content.get("table", {})
    if "degrees_sigma" in item:
        return float(item["degrees_sigma"] * DEGREE)
    if "angle_sigma_arcsec" in table:
        return float(table["angle_sigma_arcsec"] * ARC_SECOND)
    if by_hand(file.content):
        raise file.refuse_text(
            key,
            _("a turn by hand without degrees_sigma"),
            _("degrees_sigma: how well the angle is known, degrees"),
            "add degrees_sigma",
        )
    return ASSUMED_ANGLE


def _tumble(
    file: YamlFile, key: Key, item: dict[str, Any], row: Row, up: Array | None, mark: Array | None
) -> Iterator[Row]:
    about = _direction(file, [*key, "about"], item)
    missing = [name for name in ("up", "about", "step_degrees", "steps") if name not in item]
    if missing or up is None or about is None:
        raise file.refuse_text(
            key,
            _("a tumble without {value}", value=", ".join(missing) or "known directions"),
            _("up, about, step_degrees and steps"),
            _("add what is missing"),
        )
    if abs(up @ about) > cos(radians(1)):
        raise file.refuse(
            [*key, "about"], item["about"], _("an axis across up"), _("name the level axis")
        )
    there = list(range(item["steps"]))
    for way, numbers in (("", there), ("-back", there[::-1] if item.get("and_back") else [])):
        for number in numbers:
            angle = _sense(file) * radians(number * item["step_degrees"])
            ups = turned(up, about, angle)
            marks = None if mark is None else turned(mark, about, angle)
            name = f"{item['id']}{way}-{number:02d}"
            position = f"{item['position']}-{number:02d}" if "position" in item else name
            named = {"manoeuvre": name, "position": position, "do": "rest", "tumble": item["id"]}
            tumbled = _components({"tumble_axis": about, "tumbled": angle * about})
            yield row | named | tumbled | _vectors(ups, marks, None)
