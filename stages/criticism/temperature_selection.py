"""Selection of the parameters that are functions of temperature, before other effects are searched.

Over more than a few kelvin a curve of the temperature would be named as several effects, or as a
drift, that resemble it. So the functions of all twelve parameters of each sensor are selected
first, and the other effects are searched given them. Over a few kelvin only straight lines can
show, which are effects of the catalogue and searched among the others.

What depends on the temperature may also depend on time, for it seldom changes at random. So the
selection with these functions is weighed against the search without any, by evidence, and where
both are as likely they are one class.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.scatter_of_positions import PRIOR_SIZE, likely_walk
from inertial.effects import OF_TEMPERATURE_CYCLES
from inertial.effects.temperature_model import (
    BEND,
    FUNCTIONS,
    MAX_ORDER,
    SHIFT,
    Piece,
    TemperatureModel,
    polynomials,
)
from inertial.estimation.temperature import SensorEquations, knots, orders
from inertial.model_selection import walk_odds
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Cause
from inertial.physics.drift import without_clock
from inertial.physics.effect import Array, Effect
from stages.criticism.selection import (
    MAX_LOG_ODDS,
    SENSORS,
    Selection,
    select_with_scatter,
    walk_name,
)
from stages.criticism.selection import (
    columns_of as names_of,
)

STRAIGHT_LINES = ("bias_temperature", "scale_temperature")  # ends of names in the catalogue
MIN_SPAN = 10.0  # K; over less even a consumer sensor's curve is a straight line within its noise
MAX_ROUNDS = 3  # of the functions of temperature and the other effects in turn
KNOTS = 12  # tried between the coldest and the warmest tenth
LAGS = 10.0 * 2.0 ** np.arange(8)  # s, that are tried, of sensors and of thermometers
FINER = 3  # searches of a lag or a knot, each finer by four


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

    models = temperature_models(campaign, [], temperature_level, noise_degrees)
    if not models:
        return selected([])
    selection = selected(models)
    for _round in range(MAX_ROUNDS):
        others = [each for each in selection.effects if not isinstance(each, TemperatureModel)]
        again = temperature_models(campaign, others, temperature_level, noise_degrees)
        if [model.key for model in again] == [model.key for model in models]:
            break
        models, selection = again, selected(again)
    if any(model.lag for model in models):  # hysteresis may look the same
        at_once = [TemperatureModel(one.sensor, one.pieces, one.knots) for one in models]
        selection = _weighed(selection, selected(at_once))
    if not models:
        return selection
    straight = {f"{one.sensor}_{what}" for one in models for what in STRAIGHT_LINES}
    without = [effect for effect in effects if effect.name not in straight]
    plain = select_with_scatter(campaign, without, level, noise_degrees)
    # What is named without functions of temperature may leave fewer of them, or none.
    fewer = temperature_models(campaign, plain.effects, temperature_level, noise_degrees)
    if not fewer:
        return _weighed(selection, plain)
    if _pieces(fewer) < _pieces(models):
        rival = selected(fewer)
        selection = selection if _score(selection) - _score(rival) > MAX_LOG_ODDS else rival
    return _weighed(selection, plain)


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
    every = {
        sensor: TemperatureModel(sensor, polynomials(dict.fromkeys(FUNCTIONS, MAX_ORDER)))
        for sensor in SENSORS
    }
    return [
        model
        for sensor in SENSORS
        if (model := _model(campaign, every[sensor], others, level / 2, noise_degrees))
    ]


def _model(
    campaign: Campaign,
    full: TemperatureModel,
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> TemperatureModel | None:
    """With the random walk that remains beside all functions: else it would bend them.

    A lag looks like a random walk, too, so it is estimated first, and tested beside the walk.
    """
    sensor = full.sensor
    others = [one for one in others if not one.name.endswith(STRAIGHT_LINES)]
    campaign = campaign.without_random_walks()
    found = _orders(campaign, full, others, level, noise_degrees)
    if found is None:
        return None
    lag, full, found = _with_lag(campaign, full, found, others, level, noise_degrees)
    if walk := likely_walk(campaign, sensor, [full, *others], PRIOR_SIZE):
        walks = (walk, 0.0) if sensor == "gyro" else (0.0, walk)
        campaign = campaign.with_random_walks(walks)
        full = TemperatureModel(sensor, full.pieces)
        found = _orders(campaign, full, others, level, noise_degrees) or found
        lag, full, found = _with_lag(campaign, full, found, others, level, noise_degrees)
    if not any(found.values()):
        return None
    pieces = list(polynomials(found))
    low, high = campaign.motion.temperature.min(), campaign.motion.temperature.max()
    grid = np.linspace(low, high, KNOTS + 2)[1:-1]
    at = _knots(campaign, full, found, grid, others, level, noise_degrees)
    for function in at:
        pieces = [p for p in pieces if p.function != function or p.power == 1]
        pieces.append(Piece(function, BEND))
    for function in at:
        at |= {function: _finer_knot(campaign, sensor, pieces, at, function, lag, others)}
    pieces += [Piece(function, SHIFT) for function in at]
    return TemperatureModel(sensor, sorted(pieces), at, lag)


def _with_lag(
    campaign: Campaign,
    full: TemperatureModel,
    found: dict[str, int],
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> tuple[float, TemperatureModel, dict[str, int]]:
    """The lag, and all functions and their degrees with it."""
    if not any(found.values()):
        return 0.0, full, found
    lag = _lag(campaign, full.sensor, found, others, level, noise_degrees)
    if lag:
        full = TemperatureModel(full.sensor, full.pieces, lag=lag)
        found = _orders(campaign, full, others, level, noise_degrees) or found
    return lag, full, found


def _orders(
    campaign: Campaign,
    full: TemperatureModel,
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> dict[str, int] | None:
    """The degree of each function; None where the sensor has no equations."""
    tested, column = _tested(campaign, full.sensor, [full], others, level, noise_degrees)
    return None if tested is None else orders(tested, _columns(full, column))


def _columns(full: TemperatureModel, column: Mapping[str, int]) -> dict[str, list[int]]:
    """The columns of each function, of degree 1, 2, 3."""
    return {
        f: [column[f"{full.label}.{Piece(f, n).name}"] for n in range(1, MAX_ORDER + 1)]
        for f in FUNCTIONS
    }


def _lag(
    campaign: Campaign,
    sensor: str,
    found: Mapping[str, int],
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> float:
    """The lag of a sensor behind its thermometer, s; 0 where none is significant."""
    if without_clock(campaign.motion):
        return 0.0
    lags = np.sort(np.concatenate([[0.0], LAGS, -LAGS]))
    best = 0.0
    for _finer in range(FINER):
        family = [TemperatureModel(sensor, polynomials(found), lag=lag) for lag in lags.tolist()]
        drops, threshold = _drops(campaign, family, others, level, noise_degrees)
        if drops.max() - drops[int(np.argmin(np.abs(lags)))] < threshold:
            return best
        place = int(np.argmax(drops))
        best = float(lags[place])
        low, high = lags[max(place - 1, 0)], lags[min(place + 1, len(lags) - 1)]
        lags = np.append(np.linspace(low, high, 9), 0.0)
    return best


def _finer_knot(
    campaign: Campaign,
    sensor: str,
    pieces: Sequence[Piece],
    at: Mapping[str, float],
    function: str,
    lag: float,
    others: Sequence[Effect],
) -> float:
    """The knot of a function, from steps of its grid to a hundredth of them."""
    temperature = campaign.motion.temperature
    knot, step = at[function], np.ptp(temperature) / (KNOTS + 1)
    for _finer in range(FINER):
        grid = np.clip(
            knot + np.linspace(-step, step, 9), temperature.min() + step / 4, temperature.max()
        )
        family = [
            TemperatureModel(sensor, pieces, {**at, function: here}, lag) for here in grid.tolist()
        ]
        drops, _threshold = _drops(campaign, family, others, 1.0, np.inf)
        knot, step = float(grid[int(np.argmax(drops))]), step / 4
    return knot


def _drops(
    campaign: Campaign,
    family: Sequence[TemperatureModel],
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> tuple[Array, float]:
    """The reduction of chi-squared by each of a family, and that which noise exceeds."""
    labelled = [one.fixed(float(number)) for number, one in enumerate(family)]
    tested, column = _tested(campaign, family[0].sensor, labelled, others, level, noise_degrees)
    assert tested is not None  # else nothing was found
    drops = [tested.drop([column[name] for name in names_of(one)])[0] for one in labelled]
    best = labelled[int(np.argmax(drops))]
    # Against what the best of them leaves, not the first.
    tested, _column = _tested(campaign, best.sensor, [best], others, level, noise_degrees)
    assert tested is not None
    return np.array(drops), tested.threshold(1, len(family))


def _knots(
    campaign: Campaign,
    full: TemperatureModel,
    found: Mapping[str, int],
    grid: Array,
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> dict[str, float]:
    """By function the best knot, where it is better than a polynomial."""
    curved = [f for f, order in found.items() if order > 1]
    if not curved:
        return {}
    bent = [
        TemperatureModel(
            full.sensor,
            [Piece(f, BEND) for f in curved],
            dict.fromkeys(curved, float(at)),
            full.lag,
        ).fixed(float(at))
        for at in grid
    ]
    tested, column = _tested(campaign, full.sensor, [full, *bent], others, level, noise_degrees)
    assert tested is not None  # else nothing was found
    columns = _columns(full, column)
    bends = {f: [column[f"{b.label}.{Piece(f, BEND).name}"] for b in bent] for f in curved}
    return {f: float(grid[i]) for f, i in knots(tested, columns, found, bends)}


def _tested(
    campaign: Campaign,
    sensor: str,
    models: Sequence[TemperatureModel],
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> tuple[SensorEquations | None, dict[str, int]]:
    """The normal equations of one sensor; the first model has all polynomials."""
    equations = evidence(campaign, [*models, *others], noise_degrees)
    if sensor not in equations.labels:
        return None, {}
    number = equations.labels.index(sensor)
    own = equations.sensors[number]
    column = {name: i for i, name in enumerate(own.names)}
    given = tuple(column[name] for effect in others for name in names_of(effect))
    whole = [column[name] for name in names_of(models[0])]
    excess, degrees = equations.excesses([*whole, *given])[number]
    assert equations.raw is not None
    return SensorEquations(own, equations.raw, excess, degrees, level, given), column


# ---- Functions of temperature against what else may be: drifts in time, a random walk.


def _weighed(functions: Selection, plain: Selection) -> Selection:
    """The likelier selection; where both are as likely, one class of both."""
    odds = _score(functions) - _score(plain)
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
            weights=(1 - share, *(share / len(rivals) for _ in rivals)),
            captured=(*cause.captured, *(1.0 for _ in rivals)),
        )

    causes = tuple(joined(cause) for cause in functions.named.causes)
    if all(one is other for one, other in zip(causes, functions.named.causes, strict=True)):
        return plain  # nothing else is named instead: they are not needed
    return replace(functions, named=replace(functions.named, causes=causes))


def _score(selection: Selection) -> float:
    """Log evidence of the named effects beside the random walks of a selection."""
    total = selection.evidence.observable().total
    start = walk_odds.Explained(0.0, walk_odds.Equations(total.information, total.right))
    effects = {cause.effect for cause in selection.named.causes}
    walks = sum(1 for size in selection.random_walks if size)
    return (
        selection.explained(effects, start)
        - selection.campaign.deviance([], []) / 2
        - walks * float(np.log(walk_odds.LOG_RANGE))
    )
