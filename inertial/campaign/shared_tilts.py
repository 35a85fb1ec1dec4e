"""The tilts of positions that gyros and accelerometers both show, and the likelihood that follows.

Gyros in a turn about the vertical show the part that is fixed to the case; see `position_tilt`. So
their equations are written in the unknowns of the accelerometers, and what both show counts once.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.elimination import Name
from inertial.estimation.gyroscope_equations import is_upright
from inertial.estimation.position_tilt import OF_AXIS, OF_CASE, TILTS, case_by_both, names_of
from inertial.sensors import SENSORS


@dataclass(frozen=True)
class SharedTilts:
    """Those of some positions.

    `before`: what is known of the unknowns of gyros and accelerometers beforehand, rad⁻².
    """

    positions: tuple[str, ...]
    before: Mapping[str, Array]

    @property
    def names(self) -> Mapping[str, tuple[Name, ...]]:
        """The unknowns by sensor."""
        kinds = {"gyro": OF_CASE, "accel": (*TILTS, *OF_AXIS)}
        return {sensor: names_of(self.positions, of) for sensor, of in kinds.items()}

    def by_those_of_accelerometers(
        self, gyro: EffectInformation, accel: EffectInformation
    ) -> EffectInformation:
        """The information of gyros, of which the last columns are their tilts, by those of both."""
        tilts = accel.names[len(accel.names) - len(self.before["accel"]) :]
        return gyro.by_others(case_by_both(len(self.positions)), tilts)


def shared_tilts(campaign: Campaign) -> SharedTilts | None:
    """Those of positions with upright turns alone; None where one sensor alone shows any."""
    both = campaign.solution.gyro is not None and campaign.solution.accelerometer is not None
    if campaign.by_hand or not both or not campaign.position_sigma:
        return None
    upright: dict[str, bool] = {}
    for turn in campaign.inputs.turns:
        own = is_upright(turn.position, turn.about)
        upright[turn.position.name] = upright.get(turn.position.name, True) and own
    stood = {rest.position for _, rest, _ in campaign.static_forces}
    positions = tuple(name for name, there in upright.items() if there and name in stood)
    if not positions:
        return None
    of_gyros = dict.fromkeys(names_of(positions, OF_CASE), campaign.position_sigma)
    of_accelerometers = campaign.reference.sigma_of(names_of(positions, (*TILTS, *OF_AXIS)))
    sigmas = zip(SENSORS, (of_gyros, of_accelerometers), strict=True)
    return SharedTilts(
        positions, {s: np.array([*of.values()], np.float64) ** -2 for s, of in sigmas}
    )


def deviances(campaign: Campaign) -> dict[str, float]:
    """−2 log of the likelihood of each sensor without effects."""
    systems = {sensor: campaign.system(sensor, [], 1.0) for sensor in SENSORS}
    return {s: one.solve_shared().deviance for s, one in systems.items() if one is not None}


def deviance(campaign: Campaign) -> float:
    """The same of both; what both show of tilts counts once."""
    alone = sum(deviances(campaign).values())
    if (tilts := shared_tilts(campaign)) is None:
        return alone
    systems = campaign.systems([], 1.0, sharing=tilts.names)
    gyro, accel = (system.effect_information() for system in systems if system is not None)
    both = tilts.by_those_of_accelerometers(gyro, accel) + accel
    counted = gyro.deviance_as_errors(tilts.before["gyro"])
    counted += accel.deviance_as_errors(tilts.before["accel"])
    return alone - counted + both.deviance_as_errors(tilts.before["accel"])
