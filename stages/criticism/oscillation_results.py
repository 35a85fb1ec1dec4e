"""Rows of the oscillations in the full-rate residuals of the rate segments."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import sqrt

import numpy as np
from scipy.special import expit

from inertial.arrays import Array, nearest_axis
from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.effects import CATALOGUE
from inertial.effects.table_ripple import HIGHEST, LOWEST, STEP
from inertial.estimation.periodic_in_angle import MIN_DETECTION_SIGMAS, Ripple
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.model_selection.detection_limits import NOT_EXCITED, VISIBLE
from inertial.tables import AXES
from stages.criticism import oscillation_sentences as sentences
from stages.criticism.finding_rows import (
    TableRow,
    finding_id,
    finding_row,
    member_rows,
    parameter_row,
    snr_of,
)
from stages.criticism.oscillation_fits import ECCENTRICITY_ORDER, TABLE, TurnLine
from stages.criticism.oscillation_hypotheses import ECCENTRICITY, IN_TIME, RIPPLE
from stages.criticism.oscillation_search import Oscillation, SearchResult

EFFECTS = (IN_TIME, RIPPLE, ECCENTRICITY)
SIZES = {IN_TIME: ("amplitude",), RIPPLE: ("a", "b"), ECCENTRICITY: ("a", "b")}
# A frequency or an order, and two parts: of the search in one turn, or by one a and one b.
DEGREES = {IN_TIME: 3, RIPPLE: 3, ECCENTRICITY: 2}


@dataclass(frozen=True)
class NamedOscillation:
    """An oscillation with its finding.

    `moves`: the largest shift of a parameter by it, in sigma, where it is known.
    """

    oscillation: Oscillation
    finding: str
    moves: float | None

    @property
    def effect(self) -> str:
        """The likeliest effect."""
        return self.oscillation.effects[0]

    @property
    def ripple(self) -> Ripple | None:
        """Its order against the table's angle, where that is the likeliest."""
        return self.oscillation.ripple if self.effect != IN_TIME else None

    @property
    def statistic(self) -> float:
        """Reduction of chi-squared by it in all turns."""
        if step := self.oscillation.step:  # of the size that is stated, the whole of it
            return (step.size / step.sigma) ** 2
        if self.ripple:
            return self.ripple.drop + (0.0 if self.ripple.common else self.ripple.apart)
        return sum(line.drop for line in self.oscillation.lines)

    @property
    def degrees(self) -> int:
        """Of freedom of the statistic: a frequency or an order, and two parts of each amplitude."""
        if self.ripple and self.ripple.common:
            return DEGREES[self.effect]
        return 1 + 2 * (self.ripple.turns if self.ripple else len(self.oscillation.lines))

    @property
    def snr(self) -> float:
        """Signal-to-noise ratio."""
        return snr_of(self.statistic, self.degrees)

    @property
    def verdict(self) -> str:
        """Whether the data distinguish the effects that it may be."""
        return FOUND if len(self.oscillation.effects) == 1 else ONE_OF_CLASS


class OscillationResults:
    """The rows of one mount; `moves`: of each oscillation, as in `NamedOscillation`."""

    def __init__(
        self, result: SearchResult, mount: str, moves: Sequence[float | None] | None = None
    ) -> None:
        self.result, self.mount = result, mount
        self.named: list[NamedOscillation] = []
        known = moves or [None] * len(result.oscillations)
        for oscillation, moved in zip(result.oscillations, known, strict=True):
            effect = oscillation.effects[0]
            before = sum(other.effect == effect for other in self.named)
            number = [str(before + 1)] if before else []
            finding = finding_id(effect, mount, *number)
            self.named.append(NamedOscillation(oscillation, finding, moved))

    def rows(self) -> Iterator[TableRow]:
        """Scores, parameters, detection limits, spectral lines, and findings."""
        for name in EFFECTS:
            yield self._score(name)
            yield from self._parameters(name)
            yield from self._limits(name)
        for named in self.named:
            yield from self._finding(named)
        yield from self._lines()

    def _first(self, name: str) -> NamedOscillation | None:
        """The first oscillation that is an effect."""
        return next((named for named in self.named if named.effect == name), None)

    def _score(self, name: str) -> TableRow:
        """The test of each of the three effects; none where no turn can show it."""
        first, row = self._first(name), dict[str, object]()
        if first:
            scan = CATALOGUE[name].scan
            row |= {"statistic": first.statistic, "p_value": first.oscillation.p_value}
            row["snr"] = first.snr
            row["scan_value"] = first.ripple.order if scan and first.ripple else None
            row["scan_unit"] = scan.unit if scan else None
        else:
            remaining = [d for d in self.result.remaining if _kind(d.order) == name]
            best = min(remaining, key=lambda detection: detection.p_value, default=None)
            row |= {"statistic": best.drop if best else None, "snr": None}
            row |= {"p_value": best.p_value if best else None, "scan_value": None}
            row["scan_unit"] = None
        tested = limit_of(self.result, name) is not None
        return "scores", row | {
            "mount": self.mount,
            "effect": name,
            "cause": CATALOGUE[name].cause,
            "sought_in": "spectrum",
            "finding": first.finding if first else None,
            "degrees": first.degrees if first else DEGREES[name] if tested else None,
            "named": first is not None,
            "verdict": first.verdict if first else "",
            "sentence": self._sentence(first.oscillation) if first else self._not_named(name),
        }

    def _finding(self, named: NamedOscillation) -> Iterator[TableRow]:
        oscillation, ripple, members = named.oscillation, named.ripple, named.oscillation.effects
        several = len(members) > 1
        turns = {line.manoeuvre for line in oscillation.lines}
        yield finding_row(
            named.effect,
            self.mount,
            id=named.finding,
            sensor="gyro",
            manoeuvre=next(iter(turns)) if len(turns) == 1 else None,
            size=_size_of(oscillation, ripple),
            unit="rad" if ripple else "rad/s",
            p_value=oscillation.p_value,
            sentence=self._sentence(oscillation),
            consequence=sentences.consequence(oscillation),
            action=sentences.action(oscillation),
            verdict=named.verdict,
            statistic=named.statistic,
            degrees=named.degrees,
            snr=named.snr,
            moves=named.moves,
            split_manoeuvre=sentences.SPLIT if several else None,
            split_snr=sqrt(named.statistic / len(oscillation.lines)) if several else None,
            split_stated=False if several else None,
        )
        likelier = float(expit(oscillation.log_odds))
        probability = (likelier, 1 - likelier) if several else (1.0,)
        yield from member_rows(named.finding, self.mount, members, probability)

    def _parameters(self, name: str) -> Iterator[TableRow]:
        """The parameters of each oscillation that is this effect; or their detection limits."""
        effect, limit = CATALOGUE[name], self._limit_of(name)
        scan = effect.scan
        own: list[NamedOscillation | None] = [named for named in self.named if named.effect == name]
        for named in own or [None]:
            values = _estimates(name, named.oscillation) if named else {}
            described = [(p.name, p.unit, p.meaning) for p in effect.parameters]
            if scan and named:
                described.append((scan.name, scan.unit, scan.meaning))
            if named and named.oscillation.step:  # of which its ripples are parts
                described.insert(0, ("step", "rad", sentences.STEP_MEANING))
            finding = named.finding if named else None
            for parameter, unit, meaning in described:
                value, sigma = values.get(parameter, (None, None))
                size = limit.size if limit and parameter in SIZES[name] else None
                estimated = Estimated(parameter, unit, meaning, value, sigma, size)
                yield parameter_row(
                    self.mount, name, estimated, finding, finding or finding_id(name, self.mount)
                )

    def _limits(self, name: str) -> Iterator[TableRow]:
        """A row for each parameter that is a size; any frequency and any order is detectable."""
        limit = self._limit_of(name)
        for parameter in CATALOGUE[name].parameters:
            if parameter.name not in SIZES[name]:
                continue
            why = None if limit else self._why_no_limit(name)
            remark = _remark(self.result, name) if limit else None
            yield (
                "detection_limits",
                {
                    "mount": self.mount,
                    "effect": name,
                    "parameter": parameter.name,
                    "limit": limit.size if limit else None,
                    "smallest": limit.smallest if limit else None,
                    "largest": limit.largest if limit else None,
                    "unit": parameter.unit,
                    **dict.fromkeys(("moves", "moved_sensor", "moved_parameter")),
                    "reason": VISIBLE if limit else NOT_EXCITED,
                    "explanation": why,
                    "remark": remark,
                    "sentence": sentences.limit(
                        name, parameter.name, _limit(self.result, name), why
                    )
                    + (f" {remark}" if remark else ""),
                },
            )

    def _limit_of(self, name: str) -> "Limit | None":
        """From which size on it is detected; None too of what the search did not come to."""
        if self.result.truncated and not self._first(name):
            return None
        return limit_of(self.result, name)

    def _why_no_limit(self, name: str) -> str:
        """Why no size of it is detected, without its name where no turn shows any."""
        return unobservable(self.result, name) or not_named(self.result, name)

    def _lines(self) -> Iterator[TableRow]:
        """The strongest line of each axis in each turn; then other lines of oscillations."""
        turns = {turn.name: turn for turn in self.result.turns}
        listed = set()
        for line in self.result.strongest:
            turn = turns[line.manoeuvre]
            parts = ((part, n) for n in self.named for part in n.oscillation.parts)
            part, named = next(((p, n) for p, n in parts if _is(line, p, turn)), (None, None))
            listed.add((line.manoeuvre, line.axis, id(part)))
            yield self._line(line, turn, named)
        for named in self.named:
            for part in named.oscillation.parts:
                for line in part.lines:
                    turn = turns[line.manoeuvre]
                    if (line.manoeuvre, _axis(line, turn), id(part)) not in listed:
                        yield self._line(line, turn, named)

    def _line(self, line: TurnLine, turn: SteadyTurn, named: NamedOscillation | None) -> TableRow:
        frequency = line.line.frequency
        return "lines", {
            "manoeuvre": line.manoeuvre,
            "mount": self.mount,
            "axis": _axis(line, turn),
            "frequency": frequency,
            "frequency_sigma": line.line.sigma_frequency,
            "amplitude": line.line.amplitude,
            "amplitude_sigma": line.line.sigma_amplitude,
            "p_value": line.line.p_value,
            "order": frequency / turn.hertz(1.0) if np.isfinite(turn.rate) else None,
            "finding": named.finding if named else None,
            "effect": named.effect if named else None,
        }

    def _sentence(self, oscillation: Oscillation) -> str:
        if oscillation.effects[0] != IN_TIME and oscillation.ripple:
            return sentences.of_ripple(oscillation, oscillation.ripple, self.result.turns)
        return sentences.of_oscillation(oscillation, self.result.turns)

    def _not_named(self, name: str) -> str:
        for named in self.named:
            if name in named.oscillation.effects:
                return sentences.may_be(named.effect, name)
        return not_named(self.result, name)


def _size_of(oscillation: Oscillation, ripple: Ripple | None) -> float:
    """Of a step by how much the angle jumps, of a ripple its amplitude, rad; in time rad/s."""
    if oscillation.step:
        return abs(oscillation.step.size)
    return ripple.amplitude if ripple else oscillation.mean.amplitude


def _kind(order: float | None) -> str:
    """Which effect a search for an order, or without one for a frequency, is for."""
    if order is None:
        return IN_TIME
    return ECCENTRICITY if order == ECCENTRICITY_ORDER else RIPPLE


def _is(line: TurnLine, oscillation: Oscillation, turn: SteadyTurn) -> bool:
    """Whether a line is that of an oscillation: within a bin."""
    frequency = oscillation.likeliest.frequencies.get(turn.name, np.inf)
    return abs(line.line.frequency - frequency) < 1 / turn.seconds


def _axis(line: TurnLine, turn: SteadyTurn) -> str:
    """The axis of the case that is nearest to that of the line."""
    return line.axis if line.axis != TABLE else AXES[nearest_axis(turn.about)]


def _estimates(name: str, oscillation: Oscillation) -> dict[str, tuple[float, float]]:
    """Value and sigma of each parameter: Hz and rad/s, or rad and periods per revolution.

    Of turns with an a and b of their own only the order is one number.
    """
    if name == IN_TIME:
        return {
            "frequency": (oscillation.mean.frequency, oscillation.mean.frequency_sigma),
            "amplitude": (oscillation.mean.amplitude, oscillation.mean.amplitude_sigma),
        }
    ripple = oscillation.ripple
    assert ripple is not None  # for it is named
    sigmas = np.sqrt(np.diag(ripple.covariance))
    estimates = {
        part: (float(value), float(sigma))
        for part, value, sigma in zip("ab", ripple.values, sigmas, strict=True)
        if ripple.common
    }
    if oscillation.step:
        estimates["step"] = (oscillation.step.size, oscillation.step.sigma)
    if name == RIPPLE:
        estimates["n"] = (ripple.order, ripple.order_sigma)
    return estimates


# ---- Detection limits of amplitudes, a and b.


@dataclass(frozen=True)
class Limit:
    """Size from which a parameter is detected: at a usual order, and at the best and worst."""

    size: float
    smallest: float
    largest: float


def limit_of(result: SearchResult, name: str) -> Limit | None:
    """Of one of the three effects; None where no turn shows any size."""
    if name == IN_TIME:
        sizes = MIN_DETECTION_SIGMAS * np.array(
            [line.line.sigma_amplitude for line in result.strongest]
        )
    elif result.orders is None:
        return None
    else:
        sizes = result.orders.sigma * result.sigmas
        sizes = (
            sizes[:1]
            if name == ECCENTRICITY
            else np.interp(orders_of(result), result.orders.order, sizes)
        )
    sizes = sizes[np.isfinite(sizes)]
    if not len(sizes):
        return None
    return Limit(float(np.median(sizes)), float(sizes.min()), float(sizes.max()))


def orders_of(result: SearchResult) -> Array:
    """The orders of the catalogue's ripple that the sample rate resolves."""
    assert result.orders is not None  # else there is no limit
    tried = np.arange(LOWEST, HIGHEST + STEP / 2, STEP)
    return np.asarray(tried[tried <= result.orders.order[-1]])


def unobservable(result: SearchResult, name: str) -> str:
    """Why no turn shows any size of an effect; empty where one does."""
    if result.truncated or (result.strongest if name == IN_TIME else result.orders is not None):
        return ""
    if name == IN_TIME:
        return sentences.NO_TURN_IN_TIME
    return sentences.NO_ANGLE if result.turns else sentences.NO_TURN


def not_named(result: SearchResult, name: str) -> str:
    """Why an effect is not named, in a sentence."""
    if result.truncated and any(one.step for one in result.oscillations):
        return sentences.in_step(name)
    if result.truncated:
        return sentences.not_searched(name, len(result.oscillations))
    if reason := unobservable(result, name):
        return sentences.not_observable(name, reason)
    if name == IN_TIME:
        return sentences.not_significant(name, after_others=bool(result.oscillations))
    detectable = _limit(result, name)
    if not detectable:
        return f"{sentences.not_significant(name)} {sentences.SINGLE_TURN}"
    remark = _remark(result, name)
    it_would = sentences.would_be(detectable)
    return " ".join(filter(None, [sentences.not_significant(name), it_would, remark]))


def _limit(result: SearchResult, name: str) -> str:
    """From which size on an effect is detected; empty where none is."""
    limit = limit_of(result, name)
    if limit is None:
        return ""
    if name == IN_TIME:
        return sentences.from_amplitude(limit.size)
    if name == ECCENTRICITY:
        return sentences.from_angle(limit.size)
    return sentences.from_angle_by_order(
        (limit.size, limit.largest, limit.smallest), orders_of(result)
    )


def _remark(result: SearchResult, name: str) -> str | None:
    """What short turns do to the limit of an eccentricity."""
    if name != ECCENTRICITY:
        return None
    longest = max(t.seconds * t.hertz(1.0) for t in result.turns if np.isfinite(t.rate))
    return sentences.of_short_turn(longest)
