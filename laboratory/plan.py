"""The plan of a campaign as a list of manoeuvres, its shorthand expanded."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from math import sqrt
from typing import Any, Final

import numpy as np

from laboratory.axes import direction
from laboratory.errors import Complaint
from laboratory.manoeuvre import AS_MOUNTED, Manoeuvre, PlanError
from laboratory.profiles import Profile, Standing, Steady, Trapezoid
from laboratory.tumble import rests_of
from laboratory.units import DEGREE


def expanded_plan(campaign: Mapping[str, Any], still: float) -> list[Manoeuvre]:
    """The manoeuvres of a campaign; `still`: rest before and after a whole turn, s."""
    manoeuvres: list[Manoeuvre] = []
    for index, written in enumerate(campaign["plan"]):
        place = f"campaign.plan[{index}]"
        log = written.get("log", campaign.get("log"))
        if log is None:
            expected = "the manoeuvre's log, or a default log in campaign.log"
            raise PlanError(Complaint(f"{place}.log", "nothing", expected))
        check_keys(written, place)
        first = manoeuvre_of(written, log, place, still)
        if manoeuvres and "position" not in written and written["do"] != "tumble":
            first = staying(manoeuvres[-1], first)
        for manoeuvre in rests_of(first, written, place) if written["do"] == "tumble" else [first]:
            if manoeuvre.name in (other.name for other in manoeuvres):
                raise PlanError(Complaint(f"{place}.id", f"{manoeuvre.name} again", "another id"))
            check_position(manoeuvre, manoeuvres, place)
            check_mount(manoeuvre, manoeuvres, place)
            manoeuvres.append(manoeuvre)
    check_steady(manoeuvres)
    return manoeuvres


def manoeuvre_of(written: Mapping[str, Any], log: str, place: str, still: float) -> Manoeuvre:
    """The manoeuvre of an item of the plan; of a tumble its first rest."""
    turns = written["do"] in ("turn", "modulate")
    profile, seconds = (
        turn_profile(written, place, still) if turns else rest_profile(written, place)
    )
    up = direction(written["up"])
    about = direction(written.get("about", written["up"]))
    position = written.get("position", f"of {written['id']}")
    azimuth = None if "mark" in written else position
    across = np.eye(3)[np.argmin(np.abs(up))]  # any direction where the azimuth is random
    mark = direction(written["mark"]) if "mark" in written else across
    if np.linalg.norm(np.cross(up, mark)) < 1e-6:
        expected = "a direction that is not vertical, because it defines the azimuth"
        raise PlanError(Complaint(f"{place}.mark", str(written["mark"]), expected))
    mount = written.get("mount", AS_MOUNTED)
    return Manoeuvre(
        written["id"], log, position, position, mount, up, mark, azimuth, about, profile, seconds
    )


def staying(before: Manoeuvre, after: Manoeuvre) -> Manoeuvre:
    """The second of two, in the position of the first where it begins as that ended."""
    same = (before.log, before.mount) == (after.log, after.mount) and before.comes_back
    marked = (before.azimuth is None) == (after.azimuth is None)
    if not (same and marked and before.step is None):
        return after
    if not (np.allclose(before.up, after.up) and np.allclose(before.mark, after.mark)):
        return after
    azimuth = None if after.azimuth is None else before.azimuth
    return replace(after, position=before.position, shares=before.shares, azimuth=azimuth)


SPECIFIC_KEYS: Final = {  # by kind of manoeuvre
    "rest": {"seconds"},
    "turn": {"about", "degrees", "rate_deg_s", "accel_deg_s2", "seconds", "recorded"},
    "tumble": {"about", "step_degrees", "steps", "and_back", "seconds"},
    "align": {"seconds"},
    "modulate": {"about", "degrees", "rate_deg_s", "accel_deg_s2", "seconds"},
}
REQUIRED_KEYS: Final = {"tumble": ("about", "step_degrees", "steps")}


def check_keys(written: Mapping[str, Any], place: str) -> None:
    """Keys that belong to another kind of manoeuvre, or that are missing."""
    known = set().union(*SPECIFIC_KEYS.values())
    for key in written:
        if key in known - SPECIFIC_KEYS[written["do"]]:
            found, expected = str(written[key]), f"nothing: a {written['do']}"
            raise PlanError(Complaint(f"{place}.{key}", found, expected))
    for key in REQUIRED_KEYS.get(written["do"], ()):
        if key not in written:
            raise PlanError(Complaint(f"{place}.{key}", "nothing", f"{key} of a tumble"))


def rest_profile(written: Mapping[str, Any], place: str) -> tuple[Profile, float]:
    """The profile and the seconds of a rest."""
    if "seconds" not in written:
        raise PlanError(Complaint(f"{place}.seconds", "nothing", "the length of the rest, s"))
    return Standing(), written["seconds"]


def turn_profile(written: Mapping[str, Any], place: str, still: float) -> tuple[Profile, float]:
    """The profile and the seconds of a turn, from two of its angle, rate and duration.

    With ramps the duration T, the angle A, the rate r and the acceleration a of a turn are related
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
        root = (acceleration * seconds) ** 2 - 4 * acceleration * abs(angle)
        if root < 0:
            least = 2 * sqrt(abs(angle) / acceleration)
            expected = f"at least {least:.6g} s for this angle and acceleration"
            raise PlanError(Complaint(f"{place}.seconds", f"{seconds}", expected))
        rate = (acceleration * seconds - sqrt(root)) / 2
    if not angle:
        angle = rate * (seconds - abs(rate) / acceleration)
        if angle * rate <= 0 or seconds < 2 * abs(rate) / acceleration:
            expected = f"at least the two ramps, {2 * abs(rate) / acceleration:.6g} s"
            raise PlanError(Complaint(f"{place}.seconds", f"{seconds}", expected))
    profile = Trapezoid(still, angle, abs(rate), acceleration)
    return profile, profile.seconds + 2 * still


def check_position(manoeuvre: Manoeuvre, others: Sequence[Manoeuvre], place: str) -> None:
    """Manoeuvres of the same position name have the same attitude."""
    for other in others:
        if other.position == manoeuvre.position and not (
            np.allclose(other.up, manoeuvre.up)
            and np.allclose(other.mark, manoeuvre.mark)
            and other.azimuth == manoeuvre.azimuth
            and other.mount == manoeuvre.mount
        ):
            found = f"{manoeuvre.position} with another up, mark or mount than in {other.name}"
            raise PlanError(Complaint(f"{place}.position", found, "the same, or another name"))


def check_mount(manoeuvre: Manoeuvre, others: Sequence[Manoeuvre], place: str) -> None:
    """The mount does not change within a log."""
    for other in others:
        if other.log == manoeuvre.log and other.mount != manoeuvre.mount:
            found = f"{manoeuvre.log}, in which {other.name} has another mount"
            raise PlanError(Complaint(f"{place}.log", found, "another log for another mount"))


def check_steady(manoeuvres: Sequence[Manoeuvre]) -> None:
    """A turn of which only the steady part is recorded has a log of its own."""
    for index, manoeuvre in enumerate(manoeuvres):
        alone = sum(other.log == manoeuvre.log for other in manoeuvres) == 1
        if isinstance(manoeuvre.profile, Steady) and not alone:
            expected = "a log of its own for a turn of which only the steady part is recorded"
            raise PlanError(Complaint(f"campaign.plan[{index}].log", manoeuvre.log, expected))
