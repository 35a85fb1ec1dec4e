"""The results of a DCC: the parameters of three sensors with covariance, noise, conformity."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import pi, radians, sqrt
from typing import Any
from xml.etree.ElementTree import Element, SubElement

from inertial.campaign.records import Row
from inertial.estimation.probability import chi2_isf
from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.parameters import STAGES
from inertial.text.statements import NOT_STATED, RULES, STATEMENTS
from inertial.text.units import COVERAGE_FACTOR, STANDARD_GRAVITY
from stages.export.calibration import NOT_USABLE

# ---- Quantities as D-SI 2.2.0 writes them: numbers as in the JSON, units by the names of the SI.
#
# D-SI: the Digital System of Units (PTB, doi.org/10.5281/zenodo.3366901), on which a DCC rests.

NAMES = {
    "m": r"\metre", "s": r"\second", "rad": r"\radian", "K": r"\kelvin", "Hz": r"\hertz",
    "°C": r"\degreecelsius", "%": r"\percent", "min": r"\minute", "h": r"\hour",
}  # fmt: skip
# Units of the constants of laws and of a ripple that D-SI lacks, each in those that it has.
CONSTANTS = {
    "g": (STANDARD_GRAVITY, "m/s²"),
    "× 10 °/s": (radians(10), "rad/s"),
    "per turn": (1 / (2 * pi), "1/rad"),
}
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
        row(region, "coverageFactor", [number(sqrt(chi2_isf(1 - COVERAGE_PROBABILITY, count)))])
        row(region, "coverageProbability", [number(COVERAGE_PROBABILITY)])
        row(region, "distribution", [NORMAL])


def values_of(rows: Sequence[Mapping[str, Any]]) -> list[Value]:
    """Numbers of the JSON that have a value: name, value, sigma, unit."""
    return [
        Value(row["name"], row["value"], row["sigma"], row["unit"])
        for row in rows
        if row["value"] is not None
    ]


# ---- The results.

MEASURED = "basic_measuredValue"
NO_VALUES = _("No values")
CONFORMS = {"conforms": "pass", "does_not_conform": "fail"}  # not_assessed: neither


def add_name(parent: Element, text: str | None) -> None:
    """A name; `not stated` where there is none."""
    add(add(parent, "dcc:name"), "dcc:content", text or NOT_STATED)


def add_rich(parent: Element, tag: str, *paragraphs: str) -> None:
    """A description of several paragraphs."""
    own = add(parent, tag)
    for paragraph in paragraphs:
        add(own, "dcc:content", paragraph)


def add_data(parent: Element, *paragraphs: str) -> Element:
    """The data of a result, which begin with a text."""
    data = add(parent, "dcc:data")
    add_rich(data, "dcc:text", *paragraphs)
    return data


def unusable(triad: Row) -> bool:
    """Whether the verdict says that nothing of it is to be used."""
    return bool(triad["verdict"] == NOT_USABLE)


def add_result(parent: Element, identifier: str, sensors: str, triad: Row) -> None:
    """M, bias and effects of three sensors: values, U and covariance under their symbols."""
    result = add(parent, "dcc:result")
    add_name(result, _("Parameters of the {sensors}", sensors=sensors))
    if unusable(triad):
        add_data(result, triad["sentence"])
        return
    data = add_data(result, *_sentences(triad))
    own = _parameters(triad)
    names = [name.rpartition("/")[2] for name in triad["covariance"]["names"]]
    if names:
        quantity = add(data, "dcc:quantity", id=identifier, refType=MEASURED)
        add_name(quantity, _("Matrix M, bias, and effects of the {sensors}", sensors=sensors))
        add_list(quantity, [own.pop(name) for name in names], triad["covariance"]["value"])
    if triad["inverse"]["value"] is not None:
        quantity = add(data, "dcc:quantity", refType=MEASURED)
        add_name(quantity, _("Inverse of M"))
        add_list(quantity, [*_matrix("inverse", triad["inverse"]).values()])
    for value in own.values():  # constants of effects
        factor, its_unit = CONSTANTS.get(value.unit, (1.0, value.unit))
        scaled = replace(value, value=value.value * factor, unit=its_unit)
        add_real(add(data, "dcc:quantity"), scaled)


def _sentences(triad: Row) -> Iterator[str]:
    if triad["sentence"]:
        yield triad["sentence"]
    if triad["condition"]:
        yield triad["condition"]
    for axis, equation in triad["equation"].items():
        yield f"reading_{axis} = {equation}"
    for effect in triad["effects"]:
        yield f"{effect['name']}: {effect['not_in_equation'] or effect['cause']}"
    for row in triad["not_determined"]:
        yield f"{row['name']}: {row['reason']}"


def _parameters(triad: Row) -> dict[str, Value]:
    """Those with a value, by their names in the covariance; labels as in the equation."""
    found = _matrix("M", triad["matrix"])
    bias = triad["bias"]
    for i, axis in enumerate(AXES):
        label, sigma = f"bias_{axis}", bias["sigma"][i]
        found[label] = Value(label, bias["value"][i], sigma, bias["unit"])
    for effect in triad["effects"]:
        for value in values_of([*effect["parameters"], *effect["constants"]]):
            found[value.label] = value
    return {name: value for name, value in found.items() if value.value is not None}


def _matrix(symbol: str, matrix: Row) -> dict[str, Value]:
    return {
        f"scale_{a}" if a == b else f"cross_{a}{b}": Value(
            f"{symbol}_{a}{b}", matrix["value"][i][j], matrix["sigma"][i][j], matrix["unit"]
        )
        for i, a in enumerate(AXES)
        for j, b in enumerate(AXES)
    }


def add_noise(parent: Element, noise: Sequence[Row]) -> None:
    """White noise of each channel as density."""
    result = add(parent, "dcc:measurementResult")
    add_name(result, _("Noise of the readings"))
    only = add(add(result, "dcc:results"), "dcc:result")
    add_name(only, _("White noise of each channel, density"))
    quantity = add(add(only, "dcc:data"), "dcc:quantity", id="noise", refType=MEASURED)
    rows = [Value(row["channel"], row["density"], row["sigma"], row["unit"]) for row in noise]
    add_list(quantity, rows)


def add_conformity(parent: Element, rows: Sequence[Row], mount: Row, number: int) -> None:
    """Each parameter against its limit; refId: the list that contains it."""
    if not rows:
        return
    known = {kind: _parameters(mount[kind]) for kind in STAGES.values()}
    statements = add(parent, "dcc:measurementMetaData")
    for row in rows:
        kind = STAGES[row["sensor"]]
        value = known[kind].get(row["quantity"])
        listed = value is not None and not unusable(mount[kind])
        refers = {"refId": f"{kind}-{number}"} if listed else {}
        one = add(statements, "dcc:metaData", refType="basic_conformity", **refers)
        add_name(one, f"{kind}, {row['quantity']}")
        said = [STATEMENTS[row["statement"]]]
        if row["risk"] is not None:
            risk = numbers.probability(row["risk"])
            said.append(_("probability that it is wrong: {risk}", risk=risk))
        said.append(_("Decision rule: {rule}.", rule=RULES[row["decision_rule"]]))
        add_rich(one, "dcc:declaration", *said)
        if conformity := _conformity(row, value):
            add(one, "dcc:conformity", conformity)
        limit = Value("limit", row["limit"], None, row["unit"])
        add_real(add(add(one, "dcc:data"), "dcc:quantity"), limit)


def _conformity(row: Row, value: Value | None) -> str | None:
    """In the words of the schema; nearer to the limit than U it passes or fails conditionally."""
    if row["statement"] != "not_shown" or value is None:
        return CONFORMS.get(row["statement"])
    error = value.value - (1 if row["quantity"].startswith("scale") else 0)
    return "conditionalPass" if abs(error) <= row["limit"] else "conditionalFail"
