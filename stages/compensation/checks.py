"""The compensated readings against what is known: gravity, the earth's rate, the angle of turns.

Compensation is linear, so the mean of compensated samples is the compensated mean: the blocks of
`segment` are enough, and what is masked stays out.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial import tables
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.rate_segments import Recorded, position_of
from inertial.campaign.records import Row, with_mount
from inertial.campaign.solution import joint_rows
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_observations import Earth, Position
from inertial.estimation.triad import linear_names
from inertial.physics.forward import Triad
from inertial.tables import GYRO
from inertial.text.messages import _
from inertial.text.numbers import decimals_of, fixed, with_sigma
from inertial.text.units import DEGREES, DEGREES_PER_HOUR, MICRO_G, SECONDS_OF_ARC, Unit
from stages.compensation.correction import truth_of

Array = NDArray[np.float64]

UNITS = {
    # quantity: (its name in a sentence, unit of the value, unit of the difference)
    "gravity": ("|f|", Unit("m/s²", 1.0), MICRO_G),
    "force_up": ("f along up", Unit("m/s²", 1.0), MICRO_G),
    "rate_up": (_("the rate along up"), DEGREES_PER_HOUR, DEGREES_PER_HOUR),
    "angle": ("the angle", DEGREES, SECONDS_OF_ARC),
}
SI = {"gravity": "m/s²", "force_up": "m/s²", "rate_up": "rad/s", "angle": "rad"}
MAX_EXPECTED_SIGMAS = 3.0  # sigmas, above which the parameters do not explain the check


@dataclass(frozen=True)
class Check:
    """One quantity before and after, SI; `sigma` of after less expected."""

    manoeuvre: str
    quantity: str
    expected: float
    expected_sigma: float
    before: float
    after: float
    sigma: float

    def row(self, mount: str) -> Row:
        """The row of the table; `mount` is empty where there is a single one."""
        name, unit, fine = UNITS[self.quantity]
        off, sigma = fine.of(self.after - self.expected), fine.of(self.sigma)
        remaining, spread = with_sigma(off, sigma, decimals_of(sigma))
        before = fixed(fine.of(self.before - self.expected), decimals_of(sigma) or 0)
        far = (self.after - self.expected) / self.sigma
        verdict = (
            "within its sigma"
            if abs(far) <= 1
            else f"{fixed(abs(far), 1)} sigma"
            if abs(far) <= MAX_EXPECTED_SIGMAS
            else _(
                "{fixed} sigma, so these parameters are not all there is", fixed=fixed(abs(far), 1)
            )
        )
        value = fixed(unit.of(self.expected), 4) + (
            unit.name if unit is DEGREES else f" {unit.name}"
        )
        return {
            "id": f"{with_mount('compensation', mount)}/{self.quantity}/{self.manoeuvre}",
            "mount": mount,
            "manoeuvre": self.manoeuvre,
            "quantity": self.quantity,
            "unit": SI[self.quantity],
            "expected": self.expected,
            "expected_sigma": self.expected_sigma,
            "before": self.before,
            "after": self.after,
            "after_sigma": self.sigma,
            "in_sigmas_after": far,
            "sentence": _(
                "{manoeuvre}: {name} differs from {value} by {before} {name_2} before and by "
                "{after} ± {spread} {name_2} after compensation: {verdict}.",
                manoeuvre=self.manoeuvre,
                name=name,
                value=value,
                before=before,
                name_2=fine.name,
                after=remaining,
                spread=spread,
                verdict=verdict,
            ),
        }


def checks(data: CampaignData) -> Iterator[Check]:
    """Every static position and every whole rotation of one mount."""
    if (triad := data.result.accelerometer) is not None:
        for position in data.accelerometer_positions[0]:
            yield from _forces(position, triad, data)
    if (triad := data.result.gyro) is not None:
        for position in data.gyro_positions[0]:
            yield from _rate(position, triad, data)
        for rotation in data.gyro_inputs.usable:
            if rotation.plan.recorded == "whole" and rotation.done.complete:
                yield from _angle(rotation, triad, data)


def missing(parameters: pd.DataFrame, sensor: str, mount: str) -> Row:
    """Why the three sensors of one kind are not compensated."""
    reasons: dict[str, list[str]] = {}
    for row in joint_rows(parameters, mount):
        if row["parameter"] in linear_names() and row["value"] is None:
            reasons.setdefault(row["reason"], []).append(row["parameter"])
    undetermined = "; ".join(f"{', '.join(names)}: {reason}" for reason, names in reasons.items())
    nothing = ("expected", "expected_sigma", "before", "after", "after_sigma", "in_sigmas_after")
    return dict.fromkeys(nothing) | {
        "id": f"{with_mount('compensation', mount)}/{sensor}",
        "mount": mount,
        "manoeuvre": None,
        "quantity": sensor,
        "unit": "",
        "sentence": _(
            "The {sensor}s are not compensated, for not all of M and bias is determined. {value}.",
            sensor=sensor,
            value=undetermined or "Nothing was recorded that shows them",
        ),
    }


def table_of(rows: list[Row]) -> pd.DataFrame:
    """The table of checks, which may be empty."""
    if not rows:
        return tables.CHECKS.empty()
    frame = pd.DataFrame(rows)
    numbers = [column.name for column in tables.CHECKS.columns if column.unit in ("as unit", "1")]
    return frame.astype(dict.fromkeys(numbers, np.float64))


# --- Static positions ---


def _forces(position: StaticPosition, triad: Triad, data: CampaignData) -> Iterator[Check]:
    """|f|, which no tilt changes, and the force along up, which tilt lessens by its square."""
    reading, noise = position.over()
    force = truth_of(reading, triad)
    gravity = data.gravity
    size = float(np.linalg.norm(force))
    if not np.isfinite(size):
        return
    yield Check(
        position.label,
        "gravity",
        gravity.number,
        gravity.scatter,
        float(np.linalg.norm(reading)),
        size,
        _noise_along(force / size, triad, noise),
    )
    up = position.up_now
    tilted = gravity.number * data.position_sigma**2
    yield Check(
        position.label,
        "force_up",
        gravity.number,
        gravity.scatter,
        float(reading @ up),
        float(force @ up),
        float(np.hypot(_noise_along(up, triad, noise), tilted)),
    )


def _rate(position: StaticPosition, triad: Triad, data: CampaignData) -> Iterator[Check]:
    """The rate along up; a tilt turns part of the level earth rate into it."""
    reading, noise = position.over()
    up, earth = position.up_now, data.earth
    after = float(truth_of(reading, triad) @ up)
    if np.isfinite(after):
        tilted = earth.level * data.position_sigma
        spread = (_noise_along(up, triad, noise), tilted, earth.up_sigma)
        yield Check(
            position.label,
            "rate_up",
            earth.up,
            earth.up_sigma,
            float(reading @ up),
            after,
            float(np.linalg.norm(spread)),
        )


def _noise_along(direction: Array, triad: Triad, sigma: Array) -> float:
    """The noise of a compensated mean along a direction, from that of the three readings."""
    weights = direction @ np.linalg.inv(triad.matrix)
    return float(np.linalg.norm(np.where(weights == 0, 0.0, weights * sigma)))


# --- Rotations ---


def _angle(rotation: Recorded, triad: Triad, data: CampaignData) -> Iterator[Check]:
    """The angle of a whole turn about its axis, with the earth's rate taken out.

    The axis is fixed in body and laboratory, so the earth's rate along it is the same all the
    time: ω_e sinφ for an upright axis.
    """
    m, seconds = rotation.plan, rotation.blocks.seconds
    assert m.angle is not None and m.angle_sigma is not None  # else it is refused
    time = float(seconds.sum())
    summed = (rotation.blocks.gyro * seconds[:, None]).sum(axis=0)
    earth, sigma = _earth_along(m.axis, position_of(m, data.heading), data.earth)
    after = float(truth_of(summed, triad, time) @ m.axis) - earth * time
    if not np.isfinite(after):
        return
    noise = _noise_along(m.axis, triad, data.noise.of(m.name, "rest", GYRO) * np.sqrt(time))
    yield Check(
        m.name,
        "angle",
        m.angle,
        m.angle_sigma,
        float(summed @ m.axis) - earth * time,
        after,
        float(np.linalg.norm([noise, m.angle_sigma, sigma * time])),
    )


def _earth_along(axis: Array, position: Position, earth: Earth) -> tuple[float, float]:
    """The earth's rate along the axis of a turn, and its sigma, rad/s."""
    lean = float(position.up @ axis)
    upward, spread = earth.up * lean, earth.up_sigma * lean
    if position.north is not None:
        return upward + earth.level * float(position.north @ axis), abs(spread)
    # An unknown azimuth is a random direction.
    across = earth.level * np.sqrt(max(1 - lean**2, 0.0) / 2)
    return upward, float(np.hypot(spread, across))
