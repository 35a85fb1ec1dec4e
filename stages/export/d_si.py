"""Quantities as D-SI 2.2.0 writes them: numbers as in the JSON, units by the names of the SI.

D-SI: the Digital System of Units (PTB, doi.org/10.5281/zenodo.3366901), on which a DCC rests.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from scipy.stats import chi2

from inertial.text.statements import NOT_STATED
from inertial.text.units import COVERAGE_FACTOR

NAMES = {
    "m": r"\metre", "s": r"\second", "rad": r"\radian", "K": r"\kelvin", "Hz": r"\hertz",
    "°C": r"\degreecelsius", "%": r"\percent", "min": r"\minute",
}  # fmt: skip
COVERAGE_PROBABILITY = 0.95  # of U with k = 2, about
NORMAL = "normal"
EXPONENTS = {"²": 2, "³": 3, "⁴": 4}
_TOKEN = re.compile(r"[√()/·²³⁴]|[^√()/·²³⁴]+")
_NOT_IN_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
Powers = dict[str, Fraction]  # unit → exponent


@dataclass(frozen=True)
class Value:
    """A number by its label, without blanks; `sigma`: its standard uncertainty, if it has one."""

    label: str
    value: float
    sigma: float | None
    unit: str


def number(value: float | None) -> str:
    """As it stands in the JSON, to the last bit; NaN where it is not known."""
    return "NaN" if value is None else repr(float(value))


def expanded(sigma: float | None) -> float | None:
    """U = k σ; k is a power of two, so σ = U / k to the last bit."""
    return None if sigma is None else COVERAGE_FACTOR * sigma


def unit(text: str) -> str:
    """A unit such as (m/s²)/√Hz in the notation of D-SI."""
    return _notation(_powers(text))


def _powers(text: str) -> Powers:
    return _product(_TOKEN.findall(text or "1"))


def _notation(powers: Powers) -> str:
    return "".join(
        NAMES[name] + ("" if power == 1 else rf"\tothe{{{float(power):g}}}")
        for name, power in powers.items()
        if power
    ) or r"\one"  # fmt: skip


def _product(tokens: list[str]) -> Powers:
    powers = _factor(tokens)
    while tokens and tokens[0] in "/·":
        sign = -1 if tokens.pop(0) == "/" else 1
        powers = _times(powers, {name: sign * p for name, p in _factor(tokens).items()})
    return powers


def _factor(tokens: list[str]) -> Powers:
    token, power = tokens.pop(0), Fraction(1)
    if token == "√":
        token, power = tokens.pop(0), Fraction(1, 2)
    if token == "(":
        powers = _product(tokens)
        tokens.pop(0)
    else:
        powers = {} if token == "1" else {token: Fraction(1)}
    if tokens and tokens[0] in EXPONENTS:
        power *= EXPONENTS[tokens.pop(0)]
    return {name: power * p for name, p in powers.items()}


def _times(first: Powers, second: Powers) -> Powers:
    names = [*first, *(name for name in second if name not in first)]
    return {name: first.get(name, Fraction()) + second.get(name, Fraction()) for name in names}


# ---- elements


def add(parent: Element, tag: str, text: str | None = None, **attributes: str) -> Element:
    """A new element at the end of `parent`; `text` without what XML cannot hold."""
    element = SubElement(parent, tag, attributes)
    element.text = None if text is None else _NOT_IN_XML.sub("\ufffd", text)
    return element


def add_line(parent: Element, tag: str, text: str | None, **attributes: str) -> None:
    """The same of a text that must be one line and not empty."""
    add(parent, tag, " ".join((text or "").split()) or NOT_STATED, **attributes)


def add_real(parent: Element, one: Value, uncertainty: float | None = None) -> None:
    """One number; `uncertainty`: its U with k = 2, where it is not to be had from its sigma."""
    real = add(parent, "si:real")
    add_line(real, "si:label", one.label)
    add(real, "si:value", number(one.value))
    add(real, "si:unit", unit(one.unit))
    spread = expanded(one.sigma) if uncertainty is None else uncertainty
    if spread is not None:
        own = add(add(real, "si:measurementUncertaintyUnivariate"), "si:expandedMU")
        add(own, "si:valueExpandedMU", number(spread))
        add(own, "si:coverageFactor", number(COVERAGE_FACTOR))
        add(own, "si:coverageProbability", number(COVERAGE_PROBABILITY))
        add(own, "si:distribution", NORMAL)


def add_list(
    parent: Element, values: Sequence[Value], covariance: Sequence[Sequence[float]] | None = None
) -> None:
    """Numbers with U each; `covariance`, (n, n), in the products of their units.

    The ellipsoid that contains all n with 95 % has k = √χ²(0.95; n) (JCGM 102:2011, 7.7.2), larger
    than the 2 of each.
    """
    own = add(parent, "si:realListXMLList")

    def row(of: Element, tag: str, words: Sequence[str]) -> None:
        add(of, f"si:{tag}XMLList", " ".join(words))

    row(own, "label", [one.label for one in values])
    row(own, "value", [number(one.value) for one in values])
    row(own, "unit", [unit(one.unit) for one in values])
    count = len(values)
    if any(one.sigma is not None for one in values):
        inside = add(own, "si:measurementUncertaintyUnivariateXMLList")
        each = add(inside, "si:expandedMUXMLList")
        row(each, "valueExpandedMU", [number(expanded(one.sigma)) for one in values])
        row(each, "coverageFactor", [number(COVERAGE_FACTOR)] * count)
        row(each, "coverageProbability", [number(COVERAGE_PROBABILITY)] * count)
        row(each, "distribution", [NORMAL] * count)
    if covariance is not None:
        inside = add(own, "si:measurementUncertaintyMultivariateXMLList")
        region = add(inside, "si:ellipsoidalRegionMUXMLList")
        matrix = add(region, "si:covarianceMatrixXMLList")
        powers = [_powers(one.unit) for one in values]
        for j, of_column in enumerate(powers):
            column = add(add(matrix, "si:columnXMLList"), "si:covarianceXMLList")
            row(column, "value", [number(covariance[i][j]) for i in range(count)])
            row(column, "unit", [_notation(_times(of_row, of_column)) for of_row in powers])
        row(region, "coverageFactor", [number(sqrt(chi2.ppf(COVERAGE_PROBABILITY, count)))])
        row(region, "coverageProbability", [number(COVERAGE_PROBABILITY)])
        row(region, "distribution", [NORMAL])


def values_of(rows: Sequence[Mapping[str, Any]]) -> list[Value]:
    """Numbers of the JSON that have a value: name, value, sigma, unit."""
    return [
        Value(row["name"], row["value"], row["sigma"], row["unit"])
        for row in rows
        if row["value"] is not None
    ]
