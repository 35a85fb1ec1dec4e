"""Oscillations in the full-rate residuals of the turns: scores, findings, estimates."""

from collections.abc import Iterator, Sequence
from math import sqrt
from typing import Any

import numpy as np

from inertial.effects import CATALOGUE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS
from inertial.text.cause_names import in_words
from stages.criticism import oscillation_words as words
from stages.criticism.oscillation_fits import ECCENTRIC
from stages.criticism.oscillation_rows import (
    ECCENTRICITY,
    EFFECTS,
    IN_TIME,
    RIPPLE,
    SHOWN,
    blind_spots,
    listed,
    seen,
    silence,
)
from stages.criticism.oscillation_search import ANGLE, TABLE, Bound, Heard

Row = dict[str, Any]

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
        return blind_spots(self.heard, self.suffix)

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
