"""What is hidden and in no catalogue."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from hidden_courses import known_course
from hidden_elsewhere import Random, between, direction
from hidden_sizes import reference

import laboratory
from inertial.effects.law import ALL, law_name
from inertial.physics.laws import AXES

Document = dict[str, Any]


@dataclass(frozen=True)
class Outside:
    """What is in no catalogue.

    `hidden`: the names that are true of it, laws of the right form among them; `key`: the
    parameter that is its size, where it has a ratio.
    """

    name: str
    hidden: tuple[str, ...]
    told: Callable[[Random, float, float], dict[str, Any]]
    key: str = ""

    @property
    def scales(self) -> bool:
        """Whether it has a signal-to-noise ratio."""
        return bool(self.key)

    def scaled(self, effects: Mapping[str, Any], factor: float) -> dict[str, Any]:
        """The effects, so many times as large."""
        own = effects[self.name]
        return {self.name: own | {self.key: [factor * value for value in own[self.key]]}}


def of_time(*families: str) -> tuple[str, ...]:
    """The names of laws of the gyros in time, of one axis or of all."""
    return tuple(law_name("gyro", axis, one, "time") for one in families for axis in (*AXES, ALL))


OUTSIDE: tuple[Outside, ...] = (
    Outside(
        "gyro_telegraph",
        of_time("telegraph"),
        lambda r, s, span: {
            "gyro_telegraph": {
                "height_deg_h": (s * direction(r)).tolist(),
                "dwell_s": float(r.uniform(150, 500)),
            }
        },
        "height_deg_h",
    ),
    Outside(
        "gyro_cubic_drift",
        of_time("power", "polynomial"),
        lambda r, s, span: {"gyro_cubic_drift": {"k_deg_h_h3": (s * direction(r)).tolist()}},
        "k_deg_h_h3",
    ),
    Outside(
        "clock_step",
        (),
        lambda r, s, span: {
            "clock_step": {  # a share of what is recorded: between two logs nobody could see it
                "at_s": float(r.uniform(0.1, 0.9)),
                "step_ms": float(r.choice([-1, 1])) * between(r, 2, 50),
            }
        },
    ),
    Outside(
        "table_ripple",  # of an order between those that are looked for
        ("table_ripple",),
        lambda r, s, span: {
            "table_ripple": {
                "order": float(r.integers(5, 60)) + 0.1 + 0.05 * float(r.random()),
                "amplitude_arcsec": between(r, 3, 20),
            }
        },
    ),
)


def recorded(document: Document, share: float) -> float:
    """When so large a share of a campaign's samples is recorded, s since its first."""
    recording = laboratory.perform(laboratory.specify(document | {"effects": {}}))
    stamps = np.concatenate([records.stamps for records in recording.records.values()])
    return float(np.sort(stamps)[int(share * len(stamps))] - recording.start) / 1e9


def course_size(document: Document) -> Callable[[str], float]:
    """The signal-to-noise ratio that what is hidden has in the reference of a plan."""
    one, other = (
        laboratory.perform(laboratory.specify(document | {"effects": effects}))
        for effects in (document["effects"], {})
    )
    course = known_course("known_course", [one], other)
    return lambda plan: reference(plan).size_of(course)
