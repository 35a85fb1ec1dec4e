"""The compensated readings against what is known: gravity, the earth's rate, the angle of turns.

M and bias are linear, and what effects add is so small that noise does not bend it: the mean of
compensated samples is the compensated mean. So the blocks of `segment` are enough, and what is
masked stays out.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.measurement import Measurement, SensorResult
from inertial.campaign.rate_segments import position_of
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import Row, with_mount
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.gyroscope_equations import horizontal_sigma
from inertial.estimation.gyroscope_observations import Earth, Position
from inertial.physics.drift import THERMOMETER_ERROR
from inertial.physics.forward import Triad
from inertial.physics.motion import Motion, stretches
from inertial.sensors import FILE_KEYS
from inertial.tables import GYRO
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import decimals_of, fixed, with_own_sigma
from inertial.text.parameters import sign_of
from inertial.text.units import DEGREES, DEGREES_PER_HOUR, ICE_POINT, MICRO_G, SECONDS_OF_ARC, Unit
from stages.compensation.correction import UNKNOWN

UNITS = {
    # quantity: (its name in a sentence, unit of the value, unit of the difference)
    "gravity": ("|f|", Unit("m/s²", 1.0), MICRO_G),
    "force_up": (_("f along up"), Unit("m/s²", 1.0), MICRO_G),
    "rate_up": (_("the rate along up"), DEGREES_PER_HOUR, DEGREES_PER_HOUR),
    "angle": (_("the angle"), DEGREES, SECONDS_OF_ARC),
}
SI = {"gravity": "m/s²", "force_up": "m/s²", "rate_up": "rad/s", "angle": "rad"}
NO_SCATTER = (np.zeros(3), np.zeros(3))
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
        remaining, spread = with_own_sigma(off, sigma)
        before = fixed(fine.of(self.before - self.expected), decimals_of(sigma) or 0)
        far = (self.after - self.expected) / self.sigma
        verdict = (
            _("within its sigma")
            if abs(far) <= 1
            else _("{fixed} sigma", fixed=fixed(abs(far), 1))
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


def checks(
    data: CampaignData, measurement: Measurement, scatter: tuple[Array, Array] = NO_SCATTER
) -> Iterator[Check]:
    """Every static position and every whole rotation of one mount.

    `scatter`: of accelerometers and gyros between positions by hand, or from one switch-on to the
    next, (3,) each, m/s² and rad/s.
    """
    positions = data.accelerometer_positions[0]
    forces = {position.label: force_at(position, measurement) for position in positions}
    if (triad := measurement.accelerometer.triad) is not None:
        for position in positions:
            yield from _forces(position, forces[position.label], triad, data, scatter[0])
    if (triad := measurement.gyro.triad) is not None:
        for position in data.gyro_inputs.of_known_attitude.static_positions:
            force = forces.get(position.label, UNKNOWN)
            yield from rate_check(position, measurement, triad, force, data, scatter[1])
        for rotation in data.gyro_inputs.usable:
            if rotation.plan.recorded == "whole" and rotation.done.complete:
                yield from angle_check(rotation, measurement, triad, data, scatter[1])


def not_compensated(result: SensorResult, mount: str) -> Iterator[Row]:
    """Why the three sensors of one kind are not compensated, or which effects stay in them."""
    sensor = FILE_KEYS[result.sensor]
    if result.triad is None:
        yield _row(sensor, sensor, mount, _not_determined(result, sensor))
        return
    for effect, _values in result.removable:
        if effect.valid is not None:
            low, high = (fixed(each - ICE_POINT, 1) for each in effect.valid)
            yield _row(
                "temperature",
                f"{sensor}/{effect.name}",
                mount,
                _(
                    "The parameters of the {sensor}s depend on the temperature, and are known from "
                    "{low} to {high} °C: samples that are colder or warmer by more than "
                    "{margin:.0f} K are not compensated.",
                    sensor=sensor,
                    low=low,
                    high=high,
                    margin=THERMOMETER_ERROR,
                ),
            )
    for one in result.staying:
        yield _row(
            "effect",
            f"{sensor}/{one.effect.name}",
            mount,
            _(
                "The parameters of the {sensor}s are those of a model with {effect}, which stays "
                "in the compensated readings: {stays}.",
                sensor=sensor,
                effect=in_words(one.effect.name),
                stays=one.effect.stays,
            ),
        )


def _not_determined(result: SensorResult, sensor: str) -> str:
    if len(result.missing) == 1 and not any(row["value"] for row in result.rows.values()):
        (reason,) = result.missing  # one for all twelve
        told = reason.removesuffix(".")
        return _("The {sensor}s are not compensated: {reason}.", sensor=sensor, reason=told)
    missing = {", ".join(map(sign_of, names)): why for why, names in result.missing.items()}
    reasons = "; ".join(f"{names}: {why}" for names, why in missing.items())
    return _(
        "The {sensor}s are not compensated, for not all of M and bias is determined. {value}.",
        sensor=sensor,
        value=reasons or _("Nothing was recorded that shows them"),
    )


def _row(quantity: str, place: str, mount: str, sentence: str) -> Row:
    """A row that says something and checks nothing."""
    nothing = ("expected", "expected_sigma", "before", "after", "after_sigma", "in_sigmas_after")
    return dict.fromkeys(nothing) | {
        "id": f"{with_mount('compensation', mount)}/{place}",
        "mount": mount,
        "manoeuvre": None,
        "quantity": quantity,
        "unit": "",
        "sentence": sentence,
    }


# --- Static positions ---


def motion_of(position: StaticPosition) -> Motion:
    """When a static position was recorded and how warm it was, as one stretch."""
    middle, temperature = (
        np.array([position.mean_of(values)]) for values in (position.time, position.temperature)
    )
    return stretches(middle, np.array([position.seconds.sum()]), temperature)


def force_at(position: StaticPosition, measurement: Measurement) -> Array:
    """The specific force in a static position by its readings, (3,)."""
    (force,) = measurement.force(position.over()[0][None], motion_of(position))
    return np.asarray(force)


def _forces(
    position: StaticPosition, force: Array, triad: Triad, data: CampaignData, scatter: Array
) -> Iterator[Check]:
    """|f|, which no tilt changes, and the force along up, which tilt lessens by its square.

    By hand up is where the force is, so they are the same.
    """
    reading, noise = position.over()
    noise = np.hypot(noise, scatter)
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
        noise_along(force / size, triad, noise),
    )
    if data.by_hand:
        return
    up = position.up_now
    tilted = gravity.number * data.position_sigma**2
    yield Check(
        position.label,
        "force_up",
        gravity.number,
        gravity.scatter,
        float(reading @ up),
        float(force @ up),
        float(np.hypot(noise_along(up, triad, noise), tilted)),
    )


def rate_check(
    position: StaticPosition,
    measurement: Measurement,
    triad: Triad,
    force: Array,
    data: CampaignData,
    scatter: Array,
) -> Iterator[Check]:
    """The rate along up; a tilt turns part of the level earth rate into it.

    None without a latitude, for then nothing is known to compare it with.
    """
    if "latitude" not in data.known:
        return
    reading, noise = position.over()
    noise = np.hypot(noise, scatter)
    up, earth = position.up_now, data.earth
    after = float(measurement.rate(reading[None], motion_of(position), force[None])[0] @ up)
    if np.isfinite(after):
        tilted = earth.level * data.position_sigma
        spread = (noise_along(up, triad, noise), tilted, earth.up_sigma)
        yield Check(
            position.label,
            "rate_up",
            earth.up,
            earth.up_sigma,
            float(reading @ up),
            after,
            float(np.linalg.norm(spread)),
        )


def noise_along(direction: Array, triad: Triad, sigma: Array) -> float:
    """The noise of a compensated mean along a direction, from that of the three readings."""
    weights = direction @ np.linalg.inv(triad.matrix)
    return float(np.linalg.norm(np.where(weights == 0, 0.0, weights * sigma)))


# --- Rotations ---


def angle_check(
    rotation: Rotation, measurement: Measurement, triad: Triad, data: CampaignData, scatter: Array
) -> Iterator[Check]:
    """The angle of a whole turn about its axis, with the earth's rate taken out.

    The axis is fixed in body and laboratory, so the earth's rate along it is the same all the
    time: ω_e sinφ for an upright axis.
    """
    m, blocks = rotation.plan, rotation.blocks
    seconds = blocks.seconds * rotation.weights
    assert m.angle is not None and m.angle_sigma is not None  # else it is refused
    time = float(seconds.sum())
    motion = stretches(blocks.time, blocks.seconds, blocks.temperature)
    force = measurement.force(blocks.accel, motion)
    rates = measurement.rate(blocks.gyro, motion, force)
    before, turned = (float(seconds @ values @ m.axis) for values in (blocks.gyro, rates))
    earth, sigma = earth_along(m.axis, position_of(m, data.heading), data.earth)
    after = turned - earth * time
    if not np.isfinite(after):
        return
    own = np.hypot(data.noise.of(m.name, "rest", GYRO) * np.sqrt(time), scatter * time)
    noise = noise_along(m.axis, triad, own)
    timed = m.angle * rotation.clock_sigma
    yield Check(
        m.name,
        "angle",
        m.angle,
        m.angle_sigma,
        before - earth * time,
        after,
        float(np.linalg.norm([noise, m.angle_sigma, timed, sigma * time])),
    )


def earth_along(axis: Array, position: Position, earth: Earth) -> tuple[float, float]:
    """The earth's rate along the axis of a turn, and its sigma, rad/s."""
    if not position.is_known:
        return 0.0, horizontal_sigma(position, earth)
    lean = float(position.up @ axis)
    upward, spread = earth.up * lean, earth.up_sigma * lean
    if position.north is not None:
        return upward + earth.level * float(position.north @ axis), abs(spread)
    # An unknown azimuth is a random direction.
    across = earth.level * np.sqrt(max(1 - lean**2, 0.0) / 2)
    return upward, float(np.hypot(spread, across))
