"""The evidence of the equations of a campaign on the effects of the catalogue."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.estimation.effect_information import (
    EffectInformation,
    deviance_as_errors,
    split,
    with_prior,
)
from inertial.estimation.elimination import OF_AXIS, OF_CASE, TILTS, Name, case_by_both, names_of
from inertial.estimation.gyroscope_equations import is_upright
from inertial.estimation.triad import linear_names
from inertial.model_selection.evidence import Evidence
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS

MIN_OBSERVABLE_SIGMAS = 5.0  # sigmas of an effect at its largest size; less is not observable
MIN_OWN_SIGMAS = 1.0  # the same, by one sensor of those that see it


def evidence(
    campaign: Campaign, effects: Sequence[Effect], noise_degrees: float = np.inf
) -> Evidence:
    """The information of gyros and accelerometers on the effects, other unknowns eliminated.

    The two share the tilts of the positions. That of the gyros is what they add to the
    accelerometers, so that the two are independent. The columns are named by label and parameter of
    an effect. The information is zero for an effect that is sought elsewhere, and where it is not
    observable at its largest size: there it could only absorb errors of the linearisation. So it is
    of a sensor by itself, where the other one sees it. That is judged against noise alone: a
    scatter by hand may be all effect. `noise_degrees`: of freedom of the noise estimate.
    """
    informative, raw = _informative(campaign, effects)
    quiet = campaign.without_scatter()
    against = informative if quiet is campaign else _informative(quiet, effects)[0]
    largest = np.array(
        [
            effect.largest_of(parameter)
            if effect.sought_in == "blocks" and not campaign.excludes(effect)
            else 0.0
            for effect in effects
            for parameter in effect.parameters
        ]
    )
    own = [largest**2 * np.diag(reduced.information) for _, reduced in against]
    observable = sum(own, np.zeros(1)) > MIN_OBSERVABLE_SIGMAS**2
    seen = [observable & (squares > MIN_OWN_SIGMAS**2) for squares in own]
    return Evidence(
        tuple(
            _restricted(reduced, columns.astype(np.float64))
            for (_, reduced), columns in zip(informative, seen, strict=True)
        ),
        tuple(sensor for sensor, _ in informative),
        tuple(campaign.noise_degrees(sensor, noise_degrees) for sensor, _ in informative),
        np.array([own[: len(largest)] for own in raw]),
    )


def _informative(
    campaign: Campaign, effects: Sequence[Effect]
) -> tuple[list[tuple[str, EffectInformation]], list[Array]]:
    """The information on the effects by sensor, made independent, and without other unknowns."""
    tilts = shared_tilts(campaign)
    errors = tilts.names if tilts else {}
    every = {s: campaign.information(s, effects, errors.get(s, ())) for s in SENSORS}
    there = {sensor: told for sensor, told in every.items() if told is not None}
    informative = {sensor: told.on_effects for sensor, told in there.items()}
    if tilts:
        gyro, accel = there["gyro"].on_errors, there["accel"].on_errors
        known, by_accel = split(
            with_prior(accel, tilts.before["accel"]), len(tilts.before["accel"])
        )
        _, by_gyro = split(np.vstack([known, tilts.by_those_of_accelerometers(gyro)]), len(known))
        for sensor, rows in (("gyro", by_gyro), ("accel", by_accel)):
            informative[sensor] = informative[sensor].with_rows(rows)
    return list(informative.items()), [told.raw for told in there.values()]


def _restricted(reduced: EffectInformation, observable: Array) -> EffectInformation:
    """The same with zeros in the columns that are not observable, (k,)."""
    return replace(
        reduced,
        information=reduced.information * np.outer(observable, observable),
        right=reduced.right * observable,
    )


# ---- The tilts of positions that gyros and accelerometers both show, and the likelihood that
# follows.
#
# Gyros in a turn about the vertical show the part that is fixed to the case; see `elimination`.
# So their equations are written in the unknowns of the accelerometers, and what both show counts
# once.


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

    def by_those_of_accelerometers(self, of_gyros: Array) -> Array:
        """Rows of gyros, of which the first columns are their tilts, by those of both."""
        tilts = 2 * len(self.positions)
        by_both = of_gyros[:, :tilts] @ case_by_both(len(self.positions))
        return np.hstack([by_both, of_gyros[:, tilts:]])


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
    told = (campaign.information(sensor, [], tilts.names[sensor]) for sensor in SENSORS)
    gyro, accel = (own.on_errors for own in told if own is not None)
    both = np.vstack([accel, tilts.by_those_of_accelerometers(gyro)])
    counted = deviance_as_errors(gyro, tilts.before["gyro"])
    counted += deviance_as_errors(accel, tilts.before["accel"])
    return alone - counted + deviance_as_errors(both, tilts.before["accel"])


# ---- How far an effect that is not detected moves the parameters of the result.
#
# The sigma of a parameter holds the noise and what is known of table and site, no effect that
# nobody named. One that is as large as its detection limit moves the estimate by the fit of its
# trace to the readings: in geodesy the external reliability of a network, beside the internal one,
# which the detection limit is.
#
# Source: Baarda, A testing procedure for use in geodetic networks, Delft 1968.


@dataclass(frozen=True)
class Moved:
    """The parameter of a sensor that an effect moves most, and by how many of its sigmas."""

    sensor: str
    parameter: str
    sigmas: float


NOTHING = Moved("", "", 0.0)


def most_moved(
    campaign: Campaign, named: Sequence[Effect], tested: Sequence[Effect]
) -> list[list[Moved]]:
    """What each parameter of each tested effect moves most, by an effect of the size one, in SI.

    `named`: effects that are estimated beside the parameters.
    """
    found = [[NOTHING] * len(effect.parameters) for effect in tested]
    for sensor in SENSORS:
        system = campaign.system(sensor, [*named, *tested], PRIOR_SIZE)
        if system is None:
            continue
        names, shifts = system.shifts(sum(len(effect.parameters) for effect in named))
        columns = iter(np.abs(shifts).T)
        for own in found:
            for i, before in enumerate(own):
                own[i] = max(
                    before, _largest(sensor, names, next(columns)), key=attrgetter("sigmas")
                )
    return found


def _largest(sensor: str, names: Sequence[str], sigmas: Array) -> Moved:
    if not len(sigmas):
        return NOTHING
    worst = int(np.argmax(sigmas))
    own = names[worst]
    parameter = linear_names()[int(own)] if own.isdigit() else own
    return Moved(sensor, parameter, float(sigmas[worst]))
