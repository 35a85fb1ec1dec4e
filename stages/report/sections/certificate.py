"""The certificate on pages one and two, with the items of ISO/IEC 17025:2017, 7.8."""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np
from matplotlib.figure import Figure as Drawn

from inertial.sensors import PLURAL
from inertial.tables import AXES, BODY
from inertial.text import numbers
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.parameters import STAGES
from inertial.text.statements import (
    IN_FULL_ONLY,
    NOT_STATED,
    REALISES,
    THIS_ITEM_ONLY,
    TRACEABILITY,
)
from inertial.text.typography import capital
from inertial.text.units import COVERAGE_FACTOR, DEGREES, ICE_POINT
from stages.report.drawing import AXIS_COLOUR, INK, style, svg
from stages.report.outline import (
    Equation,
    Facts,
    Figure,
    Heading,
    Level,
    Paragraph,
    Part,
    Section,
    Sentences,
    Signatures,
    Table,
    columns,
    table_row,
)
from stages.report.results import (
    RESULT_TABLES,
    final_results,
    withheld,
)
from stages.report.sections import basis, unmodelled_effects
from stages.report.sections.certified_values import (
    NOT_USABLE,
    conformity,
    earlier_values,
    frame_of,
    further_terms,
    of_classes,
    values,
)
from stages.report.sections.comparisons import changed_in_words
from stages.report.sections.findings import causes, spoils
from stages.report.sections.verdict import guesses, verdict_in_words, verdict_sentences
from stages.report.tables import Record, Tables, once
from stages.report.words import count_in_words, term, with_mount

ITEMS = {  # of the left and of the right column, each with the items that it joins
    _("Laboratory"): ("laboratory.name", "laboratory.address", "laboratory.accreditation"),
    _("Place of calibration"): ("laboratory.place",),
    _("Customer"): ("customer.name", "customer.address"),
    _("Condition of the item"): ("item.condition",),
    _("Axes of the case"): ("item.axes",),
    _("Received"): ("received",),
    _("Calibrated"): ("calibrated",),
    _("Issued"): ("issued",),
    _("Procedure"): ("procedure.name", "procedure.version"),
    _("Deviations from the procedure"): ("procedure.deviations",),
    _("Air temperature"): ("conditions.temperature",),
    _("Relative humidity"): ("conditions.humidity",),
    _("Warm-up"): ("conditions.warm_up",),
    _("Measured with"): ("conditions.measured_with",),
}
IF_STATED = {"laboratory.place", "item.axes", "conditions.humidity", "conditions.measured_with"}
# Of the errors of the table those on which the results rest, by their sources in the budget.
TABLE_ERRORS = {"position": "position", "turn_angle": "angle"}
MIN_UNCORRECTED = 0.1  # σ of a parameter, from which a cause that is not corrected is stated


def certificate_number(tables: Tables) -> str:
    """Its number; the name of the campaign where none is stated."""
    return str(_stated(tables).get("number") or tables.row("campaign")["campaign"])


def _certifies(tables: Tables) -> bool:
    """Whether a laboratory is stated that stands by the result."""
    return "laboratory.name" in _stated(tables)


def section(tables: Tables) -> Section:
    """The section, under the name that it has in this report."""
    return SECTION if _certifies(tables) else replace(SECTION, title=_("Result"))


def title_of(tables: Tables, number: str) -> str:
    """A certificate has a laboratory that stands by it; without one it is a report."""
    if _certifies(tables):
        return _("Calibration certificate {number}", number=number)
    return _("Calibration report {number}", number=number)


def parts(tables: Tables) -> Iterator[Part]:
    """What 7.8 asks for: who, what, how, with which standards; then results and statements."""
    yield Level(*verdict_in_words(tables))
    misfits = (
        f"{capital(result.sensor)}: {result.fit_in_words()[0]}."
        for result in final_results(tables)
        if result.misfit
    )
    yield Sentences((*verdict_sentences(tables), *misfits))
    if guessed := guesses(tables):
        yield Paragraph(guessed, "fair")
    yield Facts(tuple(_facts(tables)))
    yield _standards(tables)
    if frame_of(final_results(tables)) == BODY:
        yield Figure(
            _("Axes of the case: right-handed; the axis that points up reads +g."),
            axes_of_case(),
            _("The axes x, y and z of the case, at right angles to each other."),
            small=True,
        )
    yield Equation(
        _("reading = (I + S + N) · truth + b"),
        _(
            "S: scale errors s on the diagonal; N: cross-axis terms m off it. Truth: specific "
            "force, the axis that points up reads +g; angular rate by the right-hand rule. "
            "Further terms are added to the reading."
        ),
    )
    yield Equation(
        _("truth = (I + S + N)⁻¹ · (reading − b − further terms)"),
        _(
            "The correction of a reading. The inverse stands ready, with its sigmas, in "
            "{campaign}.calibration.json beside this report.",
            campaign=tables.row("campaign")["campaign"],
        ),
    )
    yield Heading(_("Results"), breaks=True)
    earlier = earlier_values(tables)
    shown = [result for result in final_results(tables) if result.place not in withheld(tables)]
    for mount in dict.fromkeys(result.mount for result in shown):
        own = [result for result in shown if result.mount == mount]
        yield values(own, mount, earlier)
        if effects := [row for result in own for row in result.effects]:
            yield further_terms(effects, of_classes(tables), tables.rows("effects"))
    yield from _not_for_use(tables)
    yield from conformity(tables)
    yield Sentences(tuple(_statements(tables, earlier)))
    if _certifies(tables):
        yield Signatures(
            tuple(_signatures(tables)), _("End of the certificate. What follows is its evidence.")
        )


def _not_for_use(tables: Tables) -> Iterator[Paragraph]:
    """Of each sensor that is not usable, whether its values are withheld, or mere evidence."""
    given = {result.place for result in final_results(tables) if result.determined}
    for row in tables.rows("verdict"):
        place = STAGES[row["sensor"]], row["mount"]
        sensor = capital(with_mount(PLURAL[row["sensor"]], row["mount"]))
        if place in withheld(tables):
            yield Paragraph(
                _(
                    "{sensor}: the result is withheld, for the verdict above; nothing is assessed "
                    "or exported. The values by method in “Parameters” are evidence, not for use.",
                    sensor=sensor,
                ),
                "poor",
            )
        elif row["verdict"] == NOT_USABLE and place in given:
            yield Paragraph(
                _(
                    "{sensor}: not usable. The values above are evidence, not for use; none is "
                    "assessed or exported.",
                    sensor=sensor,
                ),
                "poor",
            )


# ---- Who, what, how.


@once
def _stated(tables: Tables) -> Mapping[str, str]:
    """The items that are stated, in words."""
    texts = {row["item"]: _text(row) for row in tables.rows("certificate")}
    return {item: text for item, text in texts.items() if text}


def _text(row: Record) -> str | None:
    """What is stated: a text, or a value with its expanded uncertainty."""
    if row["value"] is None:
        return None if row["text"] is None else str(row["text"])
    spread = row["expanded_uncertainty"]
    decimals = numbers.decimals_of(spread)
    value = numbers.significant(row["value"], 3)
    if decimals is None:
        return f"{value} {row['unit']}"
    value, spread = numbers.with_sigma(row["value"], spread, decimals)
    return f"({value} ± {spread}) {row['unit']}"


def _facts(tables: Tables) -> Iterator[tuple[str, str]]:
    campaign, stated = tables.row("campaign"), _stated(tables)
    yield _("Number"), certificate_number(tables)
    yield _("Campaign"), campaign["campaign"]
    maker, part, firmware = (stated.get(f"item.{key}") for key in ("maker", "part", "firmware"))
    guessed = any(row["part"] == "instrument" for row in tables.rows("guesses"))
    kind = campaign["instrument"] + (_(" (guessed)") if guessed else "")
    item = [kind, _("serial {serial}", serial=campaign["serial"])]
    item += [_("part {part}", part=part)] if part else []
    item += [_("firmware {firmware}", firmware=firmware)] if firmware else []
    if maker and not str(campaign["instrument"]).lower().startswith(maker.lower()):
        item.insert(0, maker)
    yield _("Item"), ", ".join(item)
    missing = []
    for name, items in ITEMS.items():
        if texts := [stated[one] for one in items if one in stated]:
            yield name, "; ".join(texts)
        elif not IF_STATED.issuperset(items):
            missing.append(name)
    yield _("Recorded"), _recorded(tables)
    yield _("Temperature of the IMU"), _temperature(tables)
    yield _("Remarks"), campaign["notes"] or _("none")
    if missing:
        yield capital(NOT_STATED), ", ".join(missing)


def _recorded(tables: Tables) -> str:
    dates = sorted({row["recorded_on"] for row in tables.rows("clocks") if row["recorded_on"]})
    if not dates:
        return _("not known: the logs have no absolute clock")
    return " … ".join(dict.fromkeys((dates[0], dates[-1]))) + " (UTC)"


def _temperature(tables: Tables) -> str:
    """The range that the blocks, or the plan, state."""
    frames = (tables.frame(name)["temperature"].dropna() for name in ("blocks", "manoeuvres"))
    kelvin = next((column for column in frames if len(column)), None)
    if kelvin is None:
        return _("not recorded")
    low, high = (numbers.fixed(limit - ICE_POINT, 1) for limit in (kelvin.min(), kelvin.max()))
    return f"{low} … {high} °C" if low != high else f"{low} °C"


def _standards(tables: Tables) -> Table:
    """The standards, and the known quantities that results rest on."""
    rows = [
        table_row(
            capital(REALISES[row["realises"]]),
            row["name"] + (f", {row['identification']}" if row["identification"] else ""),
            ", ".join(filter(None, (row["certificate"], row["issued_by"]))) or NOT_STATED,
            row["valid_until"] or NOT_STATED,
        )
        for row in tables.rows("standards")
    ]
    there = {row["realises"] for row in tables.rows("standards")}
    if "angle" not in there and "rate" not in there:
        table = tables.row("campaign")["table"]
        rows.append(table_row(_("Angle, rotation rate"), table, NOT_STATED, NOT_STATED))
    rows += [table_row(*cells, "–") for cells in _known(tables)]
    return Table(
        _(
            "Standards used, and quantities taken as known. U: expanded uncertainty, k = 2, about "
            "95 %."
        ),
        columns("text", _("Quantity"), _("Standard or value"), _("Certificate or origin"))
        + columns("name", _("Valid until")),
        rows,
    )


def _known(tables: Tables) -> Iterator[tuple[str, str, str]]:
    """Name, value and origin of gravity, latitude, and the errors of the table that count."""
    known = {row["quantity"]: row for row in tables.rows("known")}
    gravity = known.get("gravity")
    if gravity is not None and gravity["value"] is not None:
        spread = COVERAGE_FACTOR * gravity["sigma"] if gravity["sigma"] else None
        value, error = numbers.with_own_sigma(gravity["value"], spread)
        text = f"{value} m/s²" + (f", U = {error} m/s²" if spread else "")
        yield capital(term("gravity")), text, gravity["origin"]
    if latitude := known.get("latitude"):
        spread = DEGREES.of(COVERAGE_FACTOR * latitude["sigma"])
        value, error = numbers.with_own_sigma(DEGREES.of(latitude["value"]), spread)
        yield capital(term("latitude")), f"{value}°, U = {error}°", latitude["origin"]
    sources = {row["source"] for row in tables.rows("uncertainty_budget")}
    for quantity, source in TABLE_ERRORS.items():
        row = known.get(quantity)
        counts = source in sources or not sources  # without a budget nothing says which do
        if counts and row is not None and row["sigma"]:
            unit = basis.UNIT[quantity]
            spread = numbers.significant(unit.of(COVERAGE_FACTOR * row["sigma"]), 2)
            text = _("as set, U = {spread} {unit}", spread=spread, unit=unit.name)
            yield capital(basis.NAME[quantity]), text, row["origin"]


# ---- Statements.


def _statements(tables: Tables, earlier: Mapping[str, Record]) -> Iterator[str]:
    stated = _stated(tables)
    for row in causes(tables):
        moves = row["moves"]
        if row["cure"] == "none" and moves and moves > MIN_UNCORRECTED and not spoils(tables, row):
            yield _(
                "Not corrected, and no component of U: {cause}, which shifts no parameter by more "
                "than {share} U.",
                cause=in_words(row["cause"]),
                share=numbers.significant(moves / COVERAGE_FACTOR, 2),
            )
    shifting, every = unmodelled_effects.shifts_beyond(tables, COVERAGE_FACTOR)
    if shifting:
        yield _(
            "No component of U: effects that were not detected. {shifting} of {every} would shift "
            "a parameter by more than U if they were as large as their detection limits, which "
            "“Unmodelled effects” states.",
            shifting=capital(count_in_words(shifting)),
            every=count_in_words(every),
        )
    if changed := changed_in_words(tables):
        yield changed
    if earlier:
        before = next(iter(earlier.values()))
        yield _(
            "Change: this result less that of {date} ({campaign}). Of an IMU that was used with "
            "the earlier result, the change is the error as found; as left, this result is its "
            "own.",
            date=before["date"],
            campaign=before["campaign"],
        )
        if before["table"] != (table := tables.row("campaign")["table"]):
            yield _(
                "It was on another table, {before}, and this one on {table}: an error of either "
                "is in the change.",
                before=before["table"],
                table=table,
            )
    else:
        yield _(
            "No earlier calibration of this item is on file, so no as-found values can be stated."
        )
    yield stated.get("traceability", TRACEABILITY)
    yield THIS_ITEM_ONLY
    if _certifies(tables):
        yield IN_FULL_ONLY
    if "opinions" in stated:
        yield _("Opinion, not a result: {opinions}", opinions=stated["opinions"])


def _signatures(tables: Tables) -> Iterator[tuple[str, str]]:
    stated = _stated(tables)
    yield _("Calibrated by"), stated.get("calibrated_by", NOT_STATED)
    yield _("Released by"), stated.get("released_by", NOT_STATED)


SECTION = Section(
    "certificate",
    _("Certificate"),
    _("What was calibrated, how, and with which result."),
    "",
    (
        *RESULT_TABLES,
        *("campaign", "certificate", "guesses", "standards", "known", "clocks", "blocks"),
        *(
            "manoeuvres",
            "conformity",
            "earlier",
            "changes",
            "causes",
            "verdict",
            "uncertainty_budget",
        ),
        *unmodelled_effects.LIMIT_TABLES,
    ),
    parts,
)


# ---- A small drawing of the axes of the case.

# Towards the right and up on paper: x to the front left, y to the right, z up.
ON_PAPER = np.array([[-0.55, -0.42], [0.94, -0.2], [0.0, 1.0]])
BOX = np.array([1.0, 1.2, 0.55])  # edges of the case along x, y, z
ARROW = 0.55  # beyond the case


def axes_of_case() -> str:
    """A box with the axes through its sides, as SVG."""
    with style():
        figure = Drawn(figsize=(1.7, 1.5))
        axes = figure.add_axes((0, 0, 1, 1))
        half = BOX / 2
        for side in range(3):
            across, up = (one for one in range(3) if one != side)
            corners = np.full((5, 3), half)
            corners[:, across] *= [1, -1, -1, 1, 1]
            corners[:, up] *= [1, 1, -1, -1, 1]
            axes.plot(*(corners @ ON_PAPER).T, color=INK, linewidth=0.7)
        for side, name in enumerate(AXES):
            start = np.zeros(3)
            start[side] = half[side]
            end = start.copy()
            end[side] += ARROW
            first, last = start @ ON_PAPER, end @ ON_PAPER
            axes.annotate(
                "",
                last,
                first,
                arrowprops={
                    "arrowstyle": "-|>",
                    "color": AXIS_COLOUR[name],
                    "linewidth": 1.4,
                    "shrinkA": 0,
                    "shrinkB": 0,
                },
            )
            across, up = last + 0.16 * (last - first) / np.linalg.norm(last - first)
            axes.text(across, up, name, ha="center", va="center")
        axes.set_aspect("equal")
        axes.set_xlim(-1.1, 1.35)
        axes.set_ylim(-1.0, 1.05)
        axes.set_axis_off()
        return svg(figure, "axes of the case")
