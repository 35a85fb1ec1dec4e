"""The plan of a campaign, manoeuvre by manoeuvre, with its shorthand written out."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import ceil, pi, sqrt
from typing import Any

import numpy as np

from laboratory.arrays import Array
from laboratory.axes import direction
from laboratory.errors import Complaint
from laboratory.profiles import Profile, Standing, Steady, Trapezoid
from laboratory.units import DEGREE


@dataclass(frozen=True)
class Manoeuvre:
    """A rest or a turn."""

    name: str
    log: str
    position: str  # manoeuvres with the same one stand alike, errors included
    up: Array  # unit vector, (3,), body axes: points up at the start
    mark: Array | None  # body axes: points at the table's zero mark at the start
    about: Array  # unit vector, (3,), body axes: axis of the turn
    profile: Profile
    seconds: float  # with the rest before and after a turn

    def samples(self, interval: float) -> int:
        """Whole samples that hold the manoeuvre."""
        return ceil(self.seconds / interval - 1e-6)

    @property
    def comes_back(self) -> bool:
        """Whether the IMU stands at the end as it stood at the start."""
        turns = self.profile.angle / (2 * pi)
        return abs(turns - round(turns)) < 1e-12


class PlanError(ValueError):
    """A manoeuvre that cannot be carried out."""

    def __init__(self, complaint: Complaint) -> None:
        self.complaint = complaint
        super().__init__(str(complaint))


def written_out(campaign: Mapping[str, Any], still: float) -> list[Manoeuvre]:
    """The manoeuvres of a campaign; `still`: rest before and after a whole turn, s."""
    manoeuvres: list[Manoeuvre] = []
    for index, written in enumerate(campaign["plan"]):
        place = f"campaign.plan[{index}]"
        log = written.get("log", campaign.get("log"))
        if log is None:
            expected = "the manoeuvre's log, or a default log in campaign.log"
            raise PlanError(Complaint(f"{place}.log", "nothing", expected))
        if written["id"] in (manoeuvre.name for manoeuvre in manoeuvres):
            raise PlanError(Complaint(f"{place}.id", f"{written['id']} again", "another id"))
        profile, seconds = (
            resting(written, place) if written["do"] == "rest" else turning(written, place, still)
        )
        up = direction(written["up"])
        mark = direction(written["mark"]) if "mark" in written else None
        if mark is not None and np.linalg.norm(np.cross(up, mark)) < 1e-6:
            expected = "a direction that is not the vertical, for it gives the azimuth"
            raise PlanError(Complaint(f"{place}.mark", str(written["mark"]), expected))
        about = direction(written.get("about", written["up"]))
        position = written.get("position", f"of {written['id']}")
        manoeuvre = Manoeuvre(written["id"], log, position, up, mark, about, profile, seconds)
        check_position(manoeuvre, manoeuvres, place)
        manoeuvres.append(manoeuvre)
    check_steady(manoeuvres)
    return manoeuvres


def resting(written: Mapping[str, Any], place: str) -> tuple[Profile, float]:
    """The profile and the seconds of a rest."""
    for key in ("about", "degrees", "rate_deg_s", "accel_deg_s2", "recorded"):
        if key in written:
            raise PlanError(Complaint(f"{place}.{key}", str(written[key]), "nothing: a rest"))
    if "seconds" not in written:
        raise PlanError(Complaint(f"{place}.seconds", "nothing", "the length of the rest, s"))
    return Standing(), written["seconds"]


def turning(written: Mapping[str, Any], place: str, still: float) -> tuple[Profile, float]:
    """The profile and the seconds of a turn, from two of its angle, rate and duration.

    With ramps the duration T, the angle A, the rate r and the acceleration a of a turn are bound
    by A = r (T − r/a); without, by A = r T.
    """
    given = [key for key in ("degrees", "rate_deg_s", "seconds") if key in written]
    if len(given) != 2:
        found = " and ".join(given) or "none"
        raise PlanError(Complaint(place, found, "two of degrees, rate_deg_s and seconds"))
    angle = written.get("degrees", 0.0) * DEGREE
    rate = written.get("rate_deg_s", 0.0) * DEGREE
    seconds = written.get("seconds", 0.0)
    if written.get("recorded") == "steady":
        if not seconds:
            seconds = abs(angle / rate)
        return Steady(angle / seconds if angle else rate, seconds), seconds
    if "accel_deg_s2" not in written:
        expected = "the acceleration of the ramps, deg/s², or recorded: steady"
        raise PlanError(Complaint(f"{place}.accel_deg_s2", "nothing", expected))
    acceleration = written["accel_deg_s2"] * DEGREE
    if not rate:
        spare = (acceleration * seconds) ** 2 - 4 * acceleration * abs(angle)
        if spare < 0:
            least = 2 * sqrt(abs(angle) / acceleration)
            expected = f"at least {least:.6g} s for this angle and acceleration"
            raise PlanError(Complaint(f"{place}.seconds", f"{seconds}", expected))
        rate = (acceleration * seconds - sqrt(spare)) / 2
    if not angle:
        angle = rate * (seconds - abs(rate) / acceleration)
        if angle * rate <= 0 or seconds < 2 * abs(rate) / acceleration:
            expected = f"at least the two ramps, {2 * abs(rate) / acceleration:.6g} s"
            raise PlanError(Complaint(f"{place}.seconds", f"{seconds}", expected))
    profile = Trapezoid(still, angle, abs(rate), acceleration)
    return profile, profile.seconds + 2 * still


def check_position(manoeuvre: Manoeuvre, others: Sequence[Manoeuvre], place: str) -> None:
    """The same position name, the same attitude."""
    for other in others:
        if other.position == manoeuvre.position and not (
            np.allclose(other.up, manoeuvre.up)
            and (other.mark is None) == (manoeuvre.mark is None)
            and (
                other.mark is None
                or manoeuvre.mark is None
                or np.allclose(other.mark, manoeuvre.mark)
            )
        ):
            found = f"{manoeuvre.position} with another up or mark than in {other.name}"
            raise PlanError(Complaint(f"{place}.position", found, "the same, or another name"))


def check_steady(manoeuvres: Sequence[Manoeuvre]) -> None:
    """A table that turns before the log begins leaves no room for another manoeuvre in it."""
    for index, manoeuvre in enumerate(manoeuvres):
        alone = sum(other.log == manoeuvre.log for other in manoeuvres) == 1
        if isinstance(manoeuvre.profile, Steady) and not alone:
            expected = "a log of its own for a turn of which only the steady part is recorded"
            raise PlanError(Complaint(f"campaign.plan[{index}].log", manoeuvre.log, expected))
