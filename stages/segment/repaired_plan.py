"""The plan as a repair makes it: manoeuvres in each other's place, turned back, at other rates."""

from collections.abc import Collection, Sequence
from dataclasses import replace

from inertial.campaign.records import Manoeuvre
from stages.segment.steps import Exchanged, OtherSense

PLACE = ("log", "from_s", "to_s", "from_row", "to_row", "label")  # a log, and a selection of it


def place_of(m: Manoeuvre) -> tuple[object, ...]:
    """Where the plan has it: its log, and what it selects of that."""
    return tuple(getattr(m, key) for key in PLACE)


def exchanged_back(plan: Sequence[Manoeuvre], exchanged: Exchanged) -> list[Manoeuvre]:
    """The plan with manoeuvres in each other's log or stretch, or in each other's turn."""
    half = len(exchanged.names) // 2
    number = {m.name: i for i, m in enumerate(plan)}
    made = list(plan)
    for one, two in zip(exchanged.names[:half], exchanged.names[half:], strict=True):
        i, k = number[one], number[two]
        if place_of(plan[i]) == place_of(plan[k]):
            made[i], made[k] = plan[k], plan[i]
        else:
            made[i], made[k] = _placed(plan[i], plan[k]), _placed(plan[k], plan[i])
    return made


def _placed(m: Manoeuvre, like: Manoeuvre) -> Manoeuvre:
    return replace(m, **{key: getattr(like, key) for key in PLACE})


def turned_back(plan: Sequence[Manoeuvre], turns: OtherSense) -> list[Manoeuvre]:
    """The plan with some of its turns the other way, or the other way up."""
    other = _other_way_up if turns.upended else _turned_back
    return [other(m) if m.name in turns.names else m for m in plan]


def _other_way_up(m: Manoeuvre) -> Manoeuvre:
    return replace(m, **{key: -getattr(m, key) for key in ("up", "about")})


def _turned_back(m: Manoeuvre) -> Manoeuvre:
    angle = None if m.angle is None else -m.angle
    return replace(m, angle=angle, rate=None if m.rate is None else -m.rate)


def at_other_rate(
    plan: Sequence[Manoeuvre], ratio: float, names: Collection[str]
) -> list[Manoeuvre]:
    """The plan with some of its turns at the rate at which they were recorded."""
    return [replace(m, rate=m.rate * ratio) if m.rate and m.name in names else m for m in plan]
