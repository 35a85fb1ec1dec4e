"""How well the calibrations of this IMU repeat, its jumps, and what the next may find."""

from collections.abc import Iterator, Sequence

from inertial.sensors import SINGULAR
from inertial.tables import AXES, UNITS
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.parameters import JOINT
from inertial.text.typography import capital
from inertial.text.units import Unit, quantity
from stages.report import outline
from stages.report.tables import Record, Tables
from stages.report.words import parameter

FIRST = ("repeatability", "within")  # columns; what is left are components
NAMES = {
    "repeatability": _("repeatability"),
    "within": _("within campaigns"),
    "day": _("day"),
    "mounting": _("mounting"),
    "switch_on": _("switch-on"),
    "stability": _("bias stability"),
}
WITHIN = ("stability", "power_cycle")  # components within this campaign
Series = tuple[str, str]  # sensor and quantity


def parts(tables: Tables) -> Iterator[outline.Part]:
    """Jumps, the components of each parameter, the next calibration, bias stability."""
    rows = tables.rows("repeatability")
    for row in tables.rows("jumps"):
        yield outline.Paragraph(row["sentence"], "fair")
    between = [row for row in rows if row["component"] not in WITHIN]
    if between:
        yield _components(between)
        reasons = dict.fromkeys(row["reason"] for row in between if row["reason"])
        if reasons:
            yield outline.Sentences(tuple(f"{reason.capitalize()}." for reason in reasons))
    if forecast := tables.rows("forecast"):
        yield from _forecast(forecast)
    if cycles := [row for row in rows if row["component"] == "power_cycle"]:
        yield _power_cycles(cycles)
        yield from _switch_ons(tables)
    if stability := [row for row in rows if row["component"] == "stability"]:
        yield _stability(stability)


SECTION = outline.Section(
    "repeatability",
    _("Repeatability and drift"),
    _(
        "How the calibrations of this instrument differ beyond their own sigmas, what the next one "
        "may find, and the bias stability within this campaign."
    ),
    "",
    (
        *("repeatability", "jumps", "forecast", "manoeuvres"),
        *("gyroscope_switch_ons", "accelerometer_switch_ons"),
    ),
    parts,
)


def _unit(row: Record) -> Unit:
    return quantity(row["quantity"], row["unit"]).shown


def _components(rows: Sequence[Record]) -> outline.Table:
    """A row for each parameter, a column for each component."""
    series: dict[Series, dict[str, Record]] = {}
    for row in rows:
        series.setdefault((row["sensor"], row["quantity"]), {})[row["component"]] = row
    found = dict.fromkeys(row["component"] for row in rows if not row["reason"])
    names = [*FIRST, *(name for name in found if name not in FIRST)]
    lines = []
    for (sensor, name), own in series.items():
        unit = _unit(next(iter(own.values())))
        lines.append(
            outline.table_row(
                parameter(sensor, name),
                numbers.whole(own["within"]["calibrations"]),
                *(_cell(own.get(component), unit) for component in names),
                unit.name,
            )
        )
    return outline.Table(
        _("Standard deviations between calibrations."),
        (
            outline.Column(_("Parameter"), "name"),
            outline.Column(_("values"), "number"),
            *outline.columns("number", *(_title(name) for name in names)),
            outline.Column(_("unit"), "unit"),
        ),
        lines,
        note=_(
            "Repeatability is the standard deviation of all values (IEEE Std 528; for gyros JJF "
            "1535-2015, 3.2). A component is value ± σ by restricted likelihood, the sigmas within "
            "campaigns taken off, or below its 95 % limit. Gravity and latitude that calibrations "
            "share are the same error in all of them, so these are in no difference and in no σ "
            "here. Components joined by + divide these calibrations in the same way, so they are "
            "one number. Campaigns that share a mounting or a switch-on say so in their files; "
            "parts of one campaign are those between its power cycles."
        ),
    )


def _title(component: str) -> str:
    return " + ".join(NAMES[name] for name in component.split(" + "))


def _cell(row: Record | None, unit: Unit) -> str:
    """A value ± sigma, or below its limit."""
    if row is None or row["value"] is None:
        return "—"
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    if row["component"] == "within":
        return numbers.significant(value, 2)
    if sigma is None or row["value"] < row["sigma"]:
        return f"< {numbers.significant(unit.of(row['upper']), 2)}"
    return numbers.plus_minus(value, sigma)


HOW = _(
    "The interval allows for a scatter of the days, a random walk and a drift, each of which may "
    "be absent: it is the mean over all of them by their probabilities, so it need not lie about "
    "the straight line of the drift."
)


def _forecast(rows: Sequence[Record]) -> Iterator[outline.Part]:
    """Drift and the interval of the next calibration; why there is none, once."""
    known = [row for row in rows if row["low"] is not None]
    if known:
        due = [row["due"] for row in known if row["due"] is not None]
        first = [_("The first is due on {date}.", date=min(due))] if due else []
        yield outline.Table(
            _("Drift by weighted regression, and what the next calibration may find."),
            (
                outline.Column(_("Parameter"), "name"),
                *outline.value_and_sigma(_("drift in a year")),
                outline.Column(_("next on"), "name"),
                *outline.columns("number", _("from"), _("to"), group=_("95 % interval")),
                outline.Column(_("unit"), "unit"),
                outline.Column(_("due"), "name"),
            ),
            [_forecast_row(row) for row in known],
            note=" ".join([*first, HOW]),
        )
    reasons = {row["reason"]: row["due"] for row in rows if row["reason"]}
    yield outline.Sentences(
        tuple(
            _("Due —: {reason}.", reason=text) if due is None else f"{text.capitalize()}."
            for reason, due in reasons.items()
            for text in [numbers.shortened(reason, 200)]
        )
    )


def _forecast_row(row: Record) -> outline.Row:
    unit = _unit(row)
    decimals = numbers.decimals_of(unit.of(row["drift_sigma"]))
    width = unit.of(row["high"] - row["low"])
    return outline.table_row(
        parameter(row["sensor"], row["quantity"]),
        *numbers.with_sigma(unit.of(row["drift"]), unit.of(row["drift_sigma"]), decimals),
        row["at"],
        *(numbers.fixed(unit.of(row[k]), numbers.decimals_of(width) or 0) for k in ("low", "high")),
        unit.name,
        row["due"] or "—",
        tone="fair" if row["due"] is not None and row["reason"] else "",
    )


def _power_cycles(rows: Sequence[Record]) -> outline.Table:
    return outline.Table(
        _(
            "Turn-on to turn-on: what the biases differ by between the power cycles of this "
            "campaign."
        ),
        (
            outline.Column(_("Parameter"), "name"),
            outline.Column(_("standard deviation"), "number"),
            outline.Column(_("at most (95 %)"), "number"),
            outline.Column(_("unit"), "unit"),
            outline.Column(_("switch-ons"), "number"),
        ),
        [
            outline.table_row(
                parameter(row["sensor"], row["quantity"]),
                _cell(row, _unit(row)),
                numbers.significant(_unit(row).of(row["upper"]), 2),
                _unit(row).name,
                numbers.whole(row["groups"]),
            )
            for row in rows
        ],
        note=_(
            "The noise is taken off. The σ of a bias of the result is that of the mean over these "
            "switch-ons, by Student's distribution for so few; the bias after the next one differs "
            "from it by the standard deviation of this table."
        ),
    )


def _switch_ons(tables: Tables) -> Iterator[outline.Table]:
    """The bias after each switch-on, of each sensor that has several."""
    first: dict[int, str] = {}
    for row in tables.rows("manoeuvres"):
        first.setdefault(row["switch_on"], row["manoeuvre"])
    for sensor, table in (("gyro", "gyroscope"), ("accel", "accelerometer")):
        found = {
            (row["switch_on"], row["axis"]): row
            for row in tables.rows(f"{table}_switch_ons")
            if row["method"] == JOINT
        }
        unit = quantity("bias_x", UNITS[sensor]).shown
        if not found:
            continue
        yield outline.Table(
            _(
                "{sensor}: bias after each switch-on less that of the joint fit, {unit}.",
                sensor=capital(SINGULAR[sensor]),
                unit=unit.name,
            ),
            (
                outline.Column(_("switch-on before"), "name"),
                *(column for axis in AXES for column in outline.value_and_sigma(axis)),
            ),
            [
                outline.table_row(
                    numbers.shortened(name, 60),
                    *(
                        cell
                        for axis in AXES
                        for cell in _value_and_sigma(found.get((number, axis)), unit)
                    ),
                )
                for number, name in first.items()
            ],
            note=_("σ is that of the difference, so it contains that of the mean over all."),
        )


def _value_and_sigma(row: Record | None, unit: Unit) -> tuple[str, str]:
    if row is None:
        return "—", "—"
    value, sigma = unit.of(row["value"]), unit.of(row["sigma"])
    return numbers.with_own_sigma(value, sigma)


def _stability(rows: Sequence[Record]) -> outline.Table:
    return outline.Table(
        _(
            "Bias stability: standard deviation of means over 10 s in the longest rest of this "
            "campaign (IEEE Std 528; for gyros JJF 1535-2015, 3.3)."
        ),
        (
            outline.Column(_("Parameter"), "name"),
            *outline.value_and_sigma(unit=True),
            outline.Column(_("means"), "number"),
        ),
        [
            outline.table_row(
                parameter(row["sensor"], row["quantity"]),
                *numbers.with_sigma(
                    _unit(row).of(row["value"]),
                    _unit(row).of(row["sigma"]),
                    numbers.decimals_of(_unit(row).of(row["sigma"])),
                ),
                _unit(row).name,
                numbers.whole(row["groups"]),
            )
            for row in rows
        ],
    )
