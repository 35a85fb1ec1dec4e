"""The functions of temperature of one sensor: degrees, knots, lag, random walk.

The order of the estimates matters, for what is estimated too late is imitated by what came before:

1. degrees of polynomials, given the knots that are known;
2. knots, each searched given all other functions and compared with polynomials; both steps in turn
   until the same functions have a knot;
3. the lag of the sensors behind the thermometer, given these functions;
4. the random walk of the biases that remains beside all polynomials and these knots. Beside
   polynomials alone it would contain what they leave of a bend, and then explain the bend;
5. with a random walk all of it again.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from inertial.arrays import Array
from inertial.campaign.equations import Campaign
from inertial.campaign.scatter_given_effects import NAMED_PRIOR_SIZE, likely_walk
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
from inertial.estimation.temperature import Columns, SensorEquations, best_knots, orders, with_knots
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, Cause
from inertial.model_selection.evidence import Evidence
from inertial.physics.drift import without_clock
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from stages.criticism.effect_selection import select_with_scatter
from stages.criticism.rivals import MAX_LOG_ODDS
from stages.criticism.selection import Selection, walk_name

MAX_ROUNDS_OF_DEGREES = 4  # of degrees and knots in turn
KNOTS = 24  # tried at first
# Of the range, on either side of a knot: with less a side has no slope of its own, and the bend
# would be a step between a node at the end of the range and all others.
MIN_SIDE = 0.1
KNOT_DIGITS = 3  # of a knot in K: finer than any campaign determines it
LAGS = 10.0 * 2.0 ** np.arange(8)  # s, that are tried, of sensors and of thermometers
FINER = 3  # searches of a lag or a knot, each finer by four

Knots = Mapping[str, Sequence[float]]  # by function, K


@dataclass(frozen=True)
class Functions:
    """Degrees of the polynomials by function, and knots, K, of lines whose slope changes there."""

    degrees: Mapping[str, int]
    knots: Mapping[str, float]

    @property
    def pieces(self) -> list[Piece]:
        """Without the shifts of the knots."""
        return [
            *polynomials(self.degrees),
            *(Piece(f, power) for f in self.knots for power in (1, BEND)),
        ]


def functions_of(
    campaign: Campaign,
    sensor: str,
    others: Sequence[Effect],
    level: float,
    noise_degrees: float,
) -> TemperatureModel | None:
    """The functions of the parameters of one sensor; None where all are constant.

    `others`: effects that are fitted as well; `level`: accepted probability of any degree that is
    not there; `noise_degrees`: of freedom of the noise.
    """
    campaign = campaign.without_random_walks()
    search = _Search(campaign, sensor, others, level, noise_degrees)
    if campaign.system(sensor, [], 1.0) is None:
        return None
    search, found = search.with_lag()
    fitted = [*search.models({f: [at] for f, at in found.knots.items()}, (BEND, SHIFT)), *others]
    if walk := likely_walk(campaign, sensor, fitted, NAMED_PRIOR_SIZE):
        walks = (walk, 0.0) if sensor == "gyro" else (0.0, walk)
        again = replace(search, campaign=campaign.with_random_walks(walks), lag=0.0)
        search, found = again.with_lag()
    return search.model(found) if found.pieces else None


@dataclass(frozen=True)
class _Search:
    """The search of the functions of one sensor in the equations of a campaign."""

    campaign: Campaign
    sensor: str
    others: Sequence[Effect]
    level: float
    noise_degrees: float
    lag: float = 0.0

    def models(self, bends: Knots, powers: Sequence[int] = (BEND,)) -> list[TemperatureModel]:
        """All polynomials, then by function the pieces of each of some knots."""
        every = polynomials(dict.fromkeys(FUNCTIONS, MAX_ORDER))
        bent = [
            TemperatureModel(
                self.sensor, [Piece(f, power) for power in powers], {f: at}, self.lag
            ).fixed(at)
            for f, knots in bends.items()
            for at in knots
        ]
        return [TemperatureModel(self.sensor, every, lag=self.lag), *bent]

    def model(self, found: Functions) -> TemperatureModel:
        """The functions with the shifts of their knots, where the data determine these.

        Where no reading is on one side between the ends of the range, a knot there may be anywhere:
        the line and its bend are determined only for one that is given.
        """

        def with_shifts(of: Iterable[str]) -> TemperatureModel:
            pieces = sorted([*found.pieces, *(Piece(f, SHIFT) for f in of)])
            return TemperatureModel(self.sensor, pieces, found.knots, self.lag)

        full = with_shifts(found.knots)
        tested, column = self._tested([full])
        own = [column[name] for name in full.columns]
        values, covariance = tested.equations.estimate([*own, *tested.given])
        place = {piece: i for i, piece in enumerate(full.pieces)}
        span = float(np.ptp(self.campaign.motion.temperature))

        def determined(f: str) -> bool:
            shift, bend = place[Piece(f, SHIFT)], place[Piece(f, BEND)]
            return bool(covariance[shift, shift] < (values[bend] * span) ** 2)  # not where NaN

        return with_shifts(filter(determined, found.knots))

    def with_lag(self) -> "tuple[_Search, Functions]":
        """The same with the lag of the sensors, and the functions with it."""
        found = self.functions()
        if not found.pieces or without_clock(self.campaign.motion):
            return self, found
        if lag := self._lag(found):
            late = replace(self, lag=lag)
            return late, late.functions()
        return self, found

    def functions(self) -> Functions:
        """Degrees and knots in turn, until the same functions have a knot."""
        knots: dict[str, float] = {}
        for _round in range(MAX_ROUNDS_OF_DEGREES):
            tested, columns = self._polynomials_and({f: [at] for f, at in knots.items()})
            lines = [i for f, at in knots.items() for i in columns.line(f, at)]
            smooth = {f: own for f, own in columns.powers.items() if f not in knots}
            degrees = orders(replace(tested, given=(*tested.given, *lines)), smooth)
            found = Functions(degrees, knots)
            knots = self._knots(found)
            if knots.keys() == found.knots.keys():
                return Functions(degrees, knots)
        return found

    def _knots(self, found: Functions) -> dict[str, float]:
        """By function the best knot, where it is better than a polynomial.

        Until that is decided every other bend is a cubic, which is nearest to any of them.
        """
        bent = [*found.knots, *(f for f, order in found.degrees.items() if order > 1)]
        if not bent:
            return {}
        temperature = self.campaign.motion.temperature
        low, high = np.quantile([temperature.min(), temperature.max()], [MIN_SIDE, 1 - MIN_SIDE])
        step = (high - low) / (KNOTS - 1)
        known = {f: [at] for f, at in found.knots.items()}
        around = {f: np.linspace(low, high, KNOTS) for f in bent}
        for _finer in range(1 + FINER):
            tried = {f: _rounded(own) for f, own in around.items()}
            tested, columns = self._polynomials_and(known, tried)
            degrees = {**found.degrees, **dict.fromkeys(bent, MAX_ORDER)}
            cubic = {f: columns.powers[f][:order] for f, order in degrees.items()}
            lines = {f: columns.line(f, at) for f, at in found.knots.items()}
            best = best_knots(tested, columns, {**cubic, **lines}, tried)
            step /= 4
            around = {f: np.clip(at + step * np.arange(-4, 5), low, high) for f, at in best.items()}
        return with_knots(tested, columns, cubic, best)

    def _polynomials_and(
        self, known: Knots, tried: Knots = MappingProxyType({})
    ) -> tuple[SensorEquations, Columns]:
        """The equations of all polynomials and of changes of slope at knots, known or tried.

        What these leave without the knots that are tried is the noise.
        """
        full, *bent = known_ones = self.models(known)
        new = {f: [at for at in own if at not in known.get(f, ())] for f, own in tried.items()}
        bent += self.models(new)[1:]
        tested, column = self._tested([full, *bent], len(known_ones))
        powers = {
            f: [column[f"{full.label}.{Piece(f, n).name}"] for n in range(1, MAX_ORDER + 1)]
            for f in FUNCTIONS
        }
        bends: dict[str, dict[float, int]] = {f: {} for f in FUNCTIONS}
        for model in bent:
            ((f, at),) = model.knots.items()
            bends[f][at] = column[f"{model.label}.{Piece(f, BEND).name}"]
        return tested, Columns(powers, bends)

    def _lag(self, found: Functions) -> float:
        """The lag of the sensors behind their thermometer, s; 0 where none is significant."""
        lags = np.sort(np.concatenate([[0.0], LAGS, -LAGS]))
        best = 0.0
        for _finer in range(FINER):
            family = [
                TemperatureModel(self.sensor, found.pieces, found.knots, lag)
                for lag in lags.tolist()
            ]
            drops, threshold = self._drops(family)
            if drops.max() - drops[int(np.argmin(np.abs(lags)))] < threshold:
                return best
            place = int(np.argmax(drops))
            best = float(lags[place])
            low, high = lags[max(place - 1, 0)], lags[min(place + 1, len(lags) - 1)]
            lags = np.append(np.linspace(low, high, 9), 0.0)
        return best

    def _drops(self, family: Sequence[TemperatureModel]) -> tuple[Array, float]:
        """The reduction of chi-squared by each of a family, and that which noise exceeds."""
        labelled = [one.fixed(float(number)) for number, one in enumerate(family)]
        tested, column = self._tested(labelled)
        drops = [tested.drop([column[name] for name in one.columns])[0] for one in labelled]
        # Against what the best of them leaves, not the first.
        tested, _column = self._tested([labelled[int(np.argmax(drops))]])
        return np.array(drops), tested.threshold(1, len(family))

    def _tested(
        self, models: Sequence[TemperatureModel], first: int = 1
    ) -> tuple[SensorEquations, dict[str, int]]:
        """The normal equations of the sensor; the noise is what the first models leave."""
        found = self.campaign.information(self.sensor, [*models, *self.others])
        assert found is not None  # else there is no search
        whole, raw, _ = found
        degrees = self.campaign.noise_degrees(self.sensor, self.noise_degrees)
        equations = Evidence((whole,), (self.sensor,), (degrees,), raw[None]).observable()
        own = equations.sensors[0]
        column = {name: i for i, name in enumerate(own.names)}
        given = tuple(column[name] for effect in self.others for name in effect.columns)
        fitted = [column[name] for model in models[:first] for name in model.columns]
        ((excess, noise_degrees),) = equations.excesses([*fitted, *given])
        return SensorEquations(own, raw, excess, noise_degrees, self.level, given), column


def _rounded(knots: Array) -> list[float]:
    return list(dict.fromkeys(round(float(at), KNOT_DIGITS) for at in knots))


# ---- Selection of the parameters that are functions of temperature, before other effects are
# searched.
#
# Over more than a few kelvin a curve of the temperature would be named as several effects, or as a
# drift, that resemble it. So the functions of all twelve parameters of each sensor are selected
# first, and the other effects are searched given them. Over a few kelvin only straight lines can
# show, which are effects of the catalogue and searched among the others.
#
# What depends on the temperature may also depend on time, for it seldom changes at random. So the
# selection with these functions is weighed against the search without any, by evidence, and where
# both are as likely they are one class.

STRAIGHT_LINES = ("bias_temperature", "scale_temperature")  # ends of names in the catalogue
MIN_SPAN = 10.0  # K; over less even a consumer sensor's curve is a straight line within its noise
MAX_ROUNDS_OF_EFFECTS = 3  # of the functions of temperature and the other effects in turn


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
    # A curve of a temperature that rises may be a course in time beside straight lines.
    pieces = [(one.sensor, [each for each in one.pieces if each.power == 1]) for one in models]
    lines = [TemperatureModel(sensor, own) for sensor, own in pieces if own]
    if lines and _pieces(lines) < _pieces(models):
        selection = _weighed(selection, selected(lines))
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
    for _round in range(MAX_ROUNDS_OF_EFFECTS):
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
        family = functions.families.get(cause.effect, ())  # none of a drift without a law
        if not any(isinstance(one, TemperatureModel) for one in family):
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
