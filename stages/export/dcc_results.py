"""The results of a DCC: the parameters of three sensors with covariance, noise, conformity."""

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from inertial.campaign.records import Row
from inertial.tables import AXES
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.parameters import STAGES
from inertial.text.statements import NOT_STATED, RULES, STATEMENTS
from stages.export.calibration import NOT_USABLE
from stages.export.d_si import Value, add, add_list, add_real, values_of

MEASURED = "basic_measuredValue"
NO_VALUES = _("No values")
CONFORMS = {"conforms": "pass", "does_not_conform": "fail"}  # not_assessed: neither


def add_text(parent: Element, tag: str, text: str | None) -> None:
    """A name; `not stated` where there is none."""
    add(add(parent, tag), "dcc:content", text or NOT_STATED)


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
    add_text(result, "dcc:name", _("Parameters of the {sensors}", sensors=sensors))
    if unusable(triad):
        add_data(result, triad["sentence"])
        return
    data = add_data(result, *_sentences(triad))
    own = _parameters(triad)
    names = [name.rpartition("/")[2] for name in triad["covariance"]["names"]]
    if names:
        quantity = add(data, "dcc:quantity", id=identifier, refType=MEASURED)
        add_text(
            quantity, "dcc:name", _("Matrix M, bias, and effects of the {sensors}", sensors=sensors)
        )
        add_list(quantity, [own.pop(name) for name in names], triad["covariance"]["value"])
    if triad["inverse"]["value"] is not None:
        quantity = add(data, "dcc:quantity", refType=MEASURED)
        add_text(quantity, "dcc:name", _("Inverse of M"))
        add_list(quantity, [*_matrix("inverse", triad["inverse"]).values()])
    for value in own.values():  # constants of effects
        add_real(add(data, "dcc:quantity"), value)


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
    add_text(result, "dcc:name", _("Noise of the readings"))
    only = add(add(result, "dcc:results"), "dcc:result")
    add_text(only, "dcc:name", _("White noise of each channel, density"))
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
        add_text(one, "dcc:name", f"{kind}, {row['quantity']}")
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
