"""Selection of the parameters that are functions of temperature, before other effects are searched.

Over more than a few kelvin a curve of the temperature would be named as several effects, or as a
drift, that resemble it. So the functions of all twelve parameters of each sensor are selected
first, and the other effects are searched given them. Over a few kelvin only straight lines can
show, which are effects of the catalogue and searched among the others.

What depends on the temperature may also depend on time, for it seldom changes at random. So the
selection with these functions is weighed against the search without any, by evidence, and where
both are as likely they are one class.
"""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.effects import OF_TEMPERATURE_CYCLES
from inertial.effects.temperature_model import TemperatureModel
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Cause
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from stages.criticism.effect_selection import select_with_scatter
from stages.criticism.rivals import MAX_LOG_ODDS
from stages.criticism.selection import Selection, walk_name
from stages.criticism.temperature_functions import functions_of

STRAIGHT_LINES = ("bias_temperature", "scale_temperature")  # ends of names in the catalogue
MIN_SPAN = 10.0  # K; over less even a consumer sensor's curve is a straight line within its noise
MAX_ROUNDS = 3  # of the functions of temperature and the other effects in turn


def select_with_temperature(
    campaign: Campaign,
    effects: Sequence[Effect],
    level: float,
    temperature_level: float,
    noise_degrees: float,
) -> Selection:
    """The named effects, among them functions of temperature where the data ask for them.

    `temperature_level`: accepted probability of a function, or of a degree, that is not there.
    """

    if varies(campaign):
        effects = [*effects, *OF_TEMPERATURE_CYCLES.values()]

    def selected(models: Sequence[TemperatureModel]) -> Selection:
        return select_with_scatter(campaign, effects, level, noise_degrees, models)

    def functions(beside: Sequence[Effect]) -> list[TemperatureModel]:
        others = [effect for effect in beside if not isinstance(effect, TemperatureModel)]
        return temperature_models(campaign, others, temperature_level, noise_degrees)

    selection, models = _in_turn(selected, functions)
    if not models:
        return selection
    if any(model.lag for model in models):  # hysteresis may look the same
        at_once = [TemperatureModel(one.sensor, one.pieces, one.knots) for one in models]
        selection = _weighed(selection, selected(at_once))
    straight = {f"{one.sensor}_{what}" for one in models for what in STRAIGHT_LINES}
    without = [effect for effect in effects if effect.name not in straight]
    plain = select_with_scatter(campaign, without, level, noise_degrees)
    # What is named without functions of temperature may leave fewer of them, or none.
    fewer = functions(plain.effects)
    if fewer and _pieces(fewer) < _pieces(models):
        rival = selected(fewer)
        selection = max(selection, rival, key=lambda one: one.log_evidence)
    return _weighed(selection, plain)


def _in_turn(
    selected: Callable[[Sequence[TemperatureModel]], Selection],
    functions: Callable[[Sequence[Effect]], list[TemperatureModel]],
) -> tuple[Selection, list[TemperatureModel]]:
    """The functions of temperature and the other effects, each given the others."""
    models = functions([])
    selection = selected(models)
    for _round in range(MAX_ROUNDS):
        if not models or len(selection.effects) == len(models):  # no others
            break
        again = functions(selection.effects)
        if [model.key for model in again] == [model.key for model in models]:
            break
        models, selection = again, selected(again)
    return selection, models


def _pieces(models: Sequence[TemperatureModel]) -> int:
    return sum(len(model.pieces) for model in models)


def varies(campaign: Campaign) -> bool:
    """Whether the temperature varies by enough, on a table, to search functions of it."""
    if campaign.by_hand is not None or not campaign.recorded:
        return False
    temperature = campaign.motion.temperature
    return bool(np.isfinite(temperature).all() and np.ptp(temperature) >= MIN_SPAN)


def temperature_models(
    campaign: Campaign, others: Sequence[Effect], level: float, noise_degrees: float
) -> list[TemperatureModel]:
    """The functions of each sensor, where the temperature varies by enough.

    `others`: effects that are fitted as well.
    """
    if not varies(campaign):
        return []
    others = [one for one in others if not one.name.endswith(STRAIGHT_LINES)]
    models = (
        functions_of(campaign, sensor, others, level / len(SENSORS), noise_degrees)
        for sensor in SENSORS
    )
    return [model for model in models if model is not None]


# ---- Functions of temperature against what else may be: drifts in time, a random walk.


def _weighed(functions: Selection, plain: Selection) -> Selection:
    """The likelier selection; where both are as likely, one class of both."""
    odds = functions.log_evidence - plain.log_evidence
    if odds > MAX_LOG_ODDS:
        return functions
    if odds < -MAX_LOG_ODDS:
        return plain
    kept = {cause.effect for cause in functions.named.causes}
    share = 1 / (1 + float(np.exp(odds)))

    def joined(cause: Cause) -> Cause:
        sensor = functions.sensor(cause)
        if not isinstance(functions.families[cause.effect][0], TemperatureModel):
            return cause
        rivals = [
            member
            for other in plain.named.causes
            if other.effect not in kept and plain.sensor(other) == sensor
            for member in other.members
        ]
        if plain.random_walks[SENSORS.index(sensor)]:
            rivals.append(walk_name(SENSORS.index(sensor)))
        if not rivals:
            return cause
        rivals = list(dict.fromkeys(rivals))
        return replace(
            cause,
            verdict=ONE_OF_CLASS if cause.verdict == FOUND else cause.verdict,
            members=(*cause.members, *rivals),
            member_values=(*cause.member_values, *(0 for _ in rivals)),
            weights=(
                *(weight * (1 - share) for weight in cause.weights),
                *(share / len(rivals) for _ in rivals),
            ),
            captured=(*cause.captured, *(1.0 for _ in rivals)),
        )

    causes = tuple(joined(cause) for cause in functions.named.causes)
    if all(one is other for one, other in zip(causes, functions.named.causes, strict=True)):
        return plain  # nothing else is named instead: they are not needed
    return replace(functions, named=replace(functions.named, causes=causes))
