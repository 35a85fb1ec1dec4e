"""Rows of the oscillations in the residuals of the rate segments."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.effects import CATALOGUE
from inertial.effects.table_ripple import HIGHEST, LOWEST, STEP
from inertial.estimation.periodic_in_angle import SUFFICES
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.model_selection.detection_limits import NOT_EXCITED, VISIBLE
from inertial.tables import AXES
from inertial.text.cause_names import in_words
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND
from stages.criticism import oscillation_sentences as words
from stages.criticism.oscillation_fits import ECCENTRIC, TABLE, Ringing
from stages.criticism.oscillation_search import ANGLE, Bound, Heard

# ---- The oscillations as rows: the strongest of each axis, and the detection limits.

# ---- The lines of the turns as rows: the strongest of each axis, and what was found beneath them.

Row = dict[str, Any]


def listed(heard: Heard, named: Sequence[tuple[str, Bound]]) -> Iterator[Row]:
    """The strongest line of each axis in each turn; then others of what was found.

    named : each oscillation with the effect that it is taken for
    """
    turns = {turn.name: turn for turn in heard.turns}
    told = set()
    for ring in heard.strongest:
        turn = turns[ring.manoeuvre]
        effect = next((name for name, one in named if _is(ring, one, turn)), None)
        told.add((ring.manoeuvre, ring.axis, effect))
        yield _row(ring, turn, effect)
    for name, one in named:
        for ring in one.shown:
            turn = turns[ring.manoeuvre]
            if (ring.manoeuvre, _axis(ring, turn), name) not in told:
                yield _row(ring, turn, name)


def _is(ring: Ringing, one: Bound, turn: SteadyTurn) -> bool:
    """Whether a line is that of an oscillation: within a bin."""
    frequency = one.frequencies.get(turn.name, np.inf)
    return abs(ring.line.frequency - frequency) < 1 / turn.seconds


def _axis(ring: Ringing, turn: SteadyTurn) -> str:
    """The axis of the case that is nearest to that of the line."""
    return ring.axis if ring.axis != TABLE else AXES[int(np.argmax(np.abs(turn.about)))]


def _row(ring: Ringing, turn: SteadyTurn, effect: str | None) -> Row:
    return {
        "manoeuvre": ring.manoeuvre,
        "axis": _axis(ring, turn),
        "frequency": ring.line.frequency,
        "frequency_sigma": ring.line.sigma_frequency,
        "amplitude": ring.line.amplitude,
        "amplitude_sigma": ring.line.sigma_amplitude,
        "p_value": ring.line.p_value,
        "order": ring.line.frequency / turn.hertz(1.0) if np.isfinite(turn.rate) else None,
        "effect": effect,
    }


# ---- What the turns could have shown of oscillations: of amplitudes, a and b, and for which
# orders.

Array = NDArray[np.float64]

IN_TIME, RIPPLE, ECCENTRICITY = "oscillation", "table_ripple", "table_eccentricity"
EFFECTS = (IN_TIME, RIPPLE, ECCENTRICITY)
SHOWN = {IN_TIME: ("amplitude",), RIPPLE: ("a", "b"), ECCENTRICITY: ("a", "b")}


@dataclass(frozen=True)
class Seen:
    """From what size on a parameter is seen: at a usual order, at the best and at the worst."""

    size: float
    best: float
    worst: float


def seen(heard: Heard, name: str) -> Seen | None:
    """Of one of the three effects; none where no turn shows any size."""
    if name == IN_TIME:
        sizes = SUFFICES * np.array([ring.line.sigma_amplitude for ring in heard.strongest])
    elif heard.orders is None:
        return None
    else:
        sizes = heard.orders.sigma * heard.seen
        sizes = (
            sizes[:1]
            if name == ECCENTRICITY
            else np.interp(orders(heard), heard.orders.order, sizes)
        )
    sizes = sizes[np.isfinite(sizes)]
    if not len(sizes):
        return None
    return Seen(float(np.median(sizes)), float(sizes.min()), float(sizes.max()))


def orders(heard: Heard) -> Array:
    """The orders of the catalogue's ripple that sampling lets see."""
    assert heard.orders is not None  # else no one asks
    tried = np.arange(LOWEST, HIGHEST + STEP / 2, STEP)
    return np.asarray(tried[tried <= heard.orders.order[-1]])


def silence(heard: Heard, name: str) -> str:
    """Why an effect that is not named is not, in a sentence."""
    title = in_words(name)
    if heard.more:
        return f"Beside {len(heard.lines)} oscillations that are named no {title} was looked for."
    if name == IN_TIME:
        if not heard.strongest:
            return f"This campaign cannot show an oscillation: {words.NO_TURN}."
        if heard.lines:
            return "No oscillation is left beside what is named."
        return "No oscillation stands out of the noise of the turns."
    if heard.orders is None:
        reason = words.NO_ANGLE if heard.turns else words.NO_TURN
        return f"This campaign cannot show {title}: {reason}."
    size = seen(heard, name)
    told = f"No {title} stands out of the noise of the turns."
    if size is None:
        return f"{told} Noise so slow is told by how turns differ, and there is one only."
    return f"{told} It would be {_from(heard, name, size)}"


def limit_rows(heard: Heard, suffix: str) -> Iterator[Row]:
    """A row for each parameter that is a size; any frequency is heard, and any order."""
    for name in EFFECTS:
        size = seen(heard, name)
        for parameter in CATALOGUE[name].parameters:
            if parameter.name not in SHOWN[name]:
                continue
            title = f"{in_words(name)}, {parameter.name}"
            yield {
                "effect": f"{name}{suffix}",
                "parameter": parameter.name,
                "visible": size.size if size else None,
                "best": size.best if size else None,
                "worst": size.worst if size else None,
                "unit": parameter.unit,
                "reason": VISIBLE if size else NOT_EXCITED,
                "sentence": f"{title}: {_from(heard, name, size)}"
                if size
                else f"{title}: not seen. {silence(heard, name)}",
            }


def _from(heard: Heard, name: str, size: Seen) -> str:
    if name == IN_TIME:
        return f"seen from {significant(size.size, 2)} rad/s on in each turn."
    arcs = [significant(one / ARC_SECOND, 2) for one in (size.size, size.worst, size.best)]
    if name == ECCENTRICITY:
        longest = max(t.seconds * t.hertz(1.0) for t in heard.turns if np.isfinite(t.rate))
        return f"seen from {arcs[0]}″ on.{words.of_short_turn(longest)}"
    tried = [significant(one, 3) for one in orders(heard)[[0, -1]]]
    return (
        f"seen from {arcs[0]}″ on; from {arcs[1]}″ where it has {tried[0]} periods in a turn, from"
        f" {arcs[2]}″ where it has {tried[1]}."
    )


# ---- Oscillations in the full-rate residuals of the turns: scores, findings, estimates.

FREE = {IN_TIME: 3, RIPPLE: 3, ECCENTRICITY: 2}  # a frequency or an order, and two parts


class LinesOfTurns:
    """What is said of the turns of one mount, row by row."""

    def __init__(self, heard: Heard, suffix: str) -> None:
        self.heard, self.suffix = heard, suffix
        self.named = [(members_of(one), one) for one in heard.lines]

    def scores(self) -> Iterator[Row]:
        """How each of the three effects was judged."""
        for name in EFFECTS:
            first = self._first(name)
            statistic, p_value = self._judged(name, first)
            members = members_of(first) if first else []
            yield {
                "effect": name,
                "cause": CATALOGUE[name].cause,
                "sought_in": "spectrum",
                "statistic": statistic,
                "degrees": FREE[name] if seen(self.heard, name) else 0,
                "p_value": p_value,
                "named": first is not None,
                "verdict": _verdict(members),
                "members": ", ".join(members),
                "snr": sqrt(statistic) if first else None,
                "at": first.ripple.order if name == RIPPLE and first and first.ripple else None,
                "sentence": self._told(first) if first else self._silence(name),
            }

    def findings(self) -> Iterator[Row]:
        """One finding for each oscillation, the columns of every finding and those of a cause."""
        count = dict.fromkeys(EFFECTS, 0)
        for members, one in self.named:
            name = members[0]
            count[name] += 1
            number = f"/{count[name]}" if count[name] > 1 else ""
            statistic, _ = self._judged(name, one)
            ripple = one.ripple if name != IN_TIME else None
            told = _estimates(name, one).items()
            yield {
                "id": f"criticism/{name}{self.suffix}{number}",
                "cause": name,
                "sensor": "gyro",
                "count": 1,
                "size": ripple.amplitude if ripple else one.oscillating.amplitude,
                "unit": "rad" if ripple else "rad/s",
                "p_value": one.p_value,
                "severity": 2,
                "sentence": self._told(one),
                "consequence": words.consequence(one),
                "action": words.action(one),
                "verdict": _verdict(members),
                "members": ", ".join(members),
                "statistic": statistic,
                "degrees": FREE[name],
                "snr": sqrt(statistic),
                "parameters": "; ".join(
                    f"{part} = {value:.6g} ± {sigma:.2g} {unit}"
                    for part, (value, sigma, unit) in told
                ),
                "split_manoeuvre": words.SPLIT if len(members) > 1 else None,
                "split_snr": sqrt(statistic / len(one.shown)) if len(members) > 1 else None,
            }

    def effects(self) -> Iterator[Row]:
        """The parameters of each effect by its clearest line, and what could have been seen."""
        for name in EFFECTS:
            effect, first = CATALOGUE[name], self._first(name)
            values = _estimates(name, first) if first else {}
            size = seen(self.heard, name)
            told = [(p.name, p.unit, p.meaning) for p in effect.parameters]
            if effect.scan and first:
                told.append((effect.scan.name, effect.scan.unit, effect.scan.meaning))
            for parameter, unit, meaning in told:
                value, sigma, _ = values.get(parameter, (None, None, ""))
                yield {
                    "id": f"criticism/{name}{self.suffix}/{parameter}",
                    "effect": name,
                    "parameter": parameter,
                    "value": value,
                    "sigma": sigma,
                    "visible": size.size if size and parameter in SHOWN[name] else None,
                    "unit": unit,
                    "meaning": meaning,
                }

    def blind_spots(self) -> Iterator[Row]:
        """What the turns could have shown."""
        return limit_rows(self.heard, self.suffix)

    def lines(self) -> Iterator[Row]:
        """The lines of the turns, each with the effect that it is taken for."""
        return listed(self.heard, [(members[0], one) for members, one in self.named])

    def _first(self, name: str) -> Bound | None:
        """The first oscillation that is taken for an effect."""
        return next((one for members, one in self.named if members[0] == name), None)

    def _judged(self, name: str, one: Bound | None) -> tuple[float, float]:
        """Drop of chi-squared, and the chance of it with the search paid for."""
        left = [stands for stands in self.heard.left if _kind(stands.order) == name]
        if one is None:
            best = min(left, key=lambda o: o.p_value, default=None)
            return (best.drop, best.p_value) if best else (0.0, 1.0)
        if name == IN_TIME or one.ripple is None:
            return max(ring.drop for ring in one.shown), one.p_value
        return one.ripple.drop, one.p_value

    def _told(self, one: Bound) -> str:
        if one.bound == ANGLE and one.axis == TABLE and one.ripple is not None:
            return words.of_ripple(one, one.ripple, self.heard.turns)
        return words.of_oscillation(one, self.heard.turns)

    def _silence(self, name: str) -> str:
        for members, _ in self.named:
            if name in members:
                return f"What is named {in_words(members[0])} may be {in_words(name)} instead."
        return silence(self.heard, name)


def members_of(one: Bound) -> Sequence[str]:
    """The effects that an oscillation may be, the likeliest first."""
    of_table = RIPPLE
    if one.ripple is not None and words.eccentric(one.ripple):
        of_table = ECCENTRICITY
    if one.bound == ANGLE:
        first, second = (of_table if one.axis == TABLE else IN_TIME), IN_TIME
    else:
        first, second = IN_TIME, of_table
    return [first] if one.told or first == second else [first, second]


def _kind(order: float | None) -> str:
    """Which effect a search for an order, or without one for a frequency, is for."""
    if order is None:
        return IN_TIME
    return ECCENTRICITY if order == ECCENTRIC else RIPPLE


def _verdict(members: Sequence[str]) -> str:
    return ("", FOUND, ONE_OF_CLASS)[len(members)]


def _estimates(name: str, one: Bound) -> dict[str, tuple[float, float, str]]:
    """Value, sigma and unit of each parameter."""
    if name == IN_TIME:
        heard = one.oscillating
        return {
            "frequency": (heard.frequency, heard.frequency_sigma, "Hz"),
            "amplitude": (heard.amplitude, heard.amplitude_sigma, "rad/s"),
        }
    ripple = one.ripple
    assert ripple is not None  # for it is named
    sigmas = np.sqrt(np.diag(ripple.covariance))
    found = {
        part: (float(value), float(sigma), "rad")
        for part, value, sigma in zip("ab", ripple.values, sigmas, strict=True)
    }
    if name == RIPPLE:
        found["n"] = (ripple.order, ripple.order_sigma, "per turn")
    return found
