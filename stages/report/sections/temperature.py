"""Parameters as functions of the temperature: curves with sigma, knots, range, warm-up."""

from collections.abc import Iterator, Mapping, Sequence

from matplotlib.axes import Axes

from inertial.campaign.records import grouped
from inertial.sensors import PLURAL
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant
from inertial.text.parameters import sign_of
from inertial.text.typography import capital
from inertial.text.units import ICE_POINT, quantity
from stages.report import drawing, outline
from stages.report.results import symbol
from stages.report.tables import Record, Tables, arrays
from stages.report.words import with_mount

SAME = 0.99  # share of its span that the two ends of a curve without a turn differ by

MOST_PANELS = 12
DEGREES = {1: _("straight line"), 2: _("parabola"), 3: _("cubic")}
Curves = Mapping[str, Sequence[Record]]  # by parameter


def parts(tables: Tables) -> Iterator[outline.Part]:
    """A figure for each sensor and mount, a table of the curves; nothing where there is none."""
    groups = grouped(tables.rows("temperature_curves"), lambda row: (row["mount"], row["sensor"]))
    for number, ((mount, sensor), own) in enumerate(groups.items(), 1):
        curves = grouped(own, lambda row: str(row["parameter"]))
        yield _figure(with_mount(PLURAL[sensor], mount), f"temperature-{number}", curves)
        yield _table(with_mount(PLURAL[sensor], mount), curves)
    if sentences := [row["sentence"] for row in tables.rows("warm_up")]:
        yield outline.Sentences(tuple(sentences))


SECTION = outline.Section(
    "temperature",
    _("Temperature"),
    _("The parameters of the result that depend on the temperature, over the range recorded."),
    _(
        "The band is value ± σ, from the covariance of all coefficients; a dashed line is where "
        "the slope changes. Nothing is known beyond the ends of a curve, nor corrected there."
    ),
    ("temperature_curves", "warm_up"),
    parts,
)


def _figure(title: str, key: str, curves: Curves) -> outline.Figure:
    def panel_of(panel: Axes, name: str) -> None:
        rows = curves[name]
        unit = quantity(name, rows[0]["unit"]).shown
        at, value, sigma = arrays(rows, "temperature", "value", "sigma")
        at, value, sigma = at - ICE_POINT, value / unit.size, sigma / unit.size
        colour = drawing.AXIS_COLOUR[name.partition("_")[2][0]]
        drawing.around(panel, at, value, sigma, colour, 0.22)
        panel.plot(at, value, color=colour)
        if rows[0]["knot"] is not None:
            panel.axvline(rows[0]["knot"] - ICE_POINT, color=drawing.INK, dashes=(3, 2), lw=0.6)
        panel.set_title(f"{sign_of(name)}, {unit.name}", pad=3)
        drawing.ticks(panel, 4)

    shown = list(curves)[:MOST_PANELS]
    return outline.Figure(
        _("{title}: value ± σ against temperature.", title=capital(title)),
        drawing.grid(shown, panel_of, 0.95, _("Temperature, °C"), key),
        _(
            "{curves} of the {title}, each within its band of sigma.",
            curves=counted(len(shown), "curve"),
            title=title,
        ),
    )


def _table(title: str, curves: Curves) -> outline.Table:
    columns = (
        outline.Column(_("Parameter"), "symbol"),
        outline.Column(_("Curve")),
        *outline.columns("number", _("from"), _("to"), _("knot"), group="°C"),
        outline.Column(_("change"), "number"),
        outline.Column(_("unit"), "unit"),
        outline.Column(_("Remark"), "note"),
    )
    rows = [_row(name, own) for name, own in curves.items()]
    caption = _(
        "Curves of the {title}; change: the value at the highest temperature less that at the "
        "lowest.",
        title=title,
    )
    return outline.Table(caption, columns, rows)


def _change(values: Sequence[float]) -> str:
    """From the lowest to the highest temperature; of a curve that turns, by how much, unsigned."""
    change, span = values[-1] - values[0], max(values) - min(values)
    if abs(change) < SAME * span:
        return significant(span, 3)
    return f"{'+' if change > 0 else ''}{significant(change, 3)}"


def _row(name: str, rows: Sequence[Record]) -> outline.Row:
    first, last = rows[0], rows[-1]
    unit = quantity(name, first["unit"]).shown
    values = [row["value"] / unit.size for row in rows]
    knot = first["knot"]
    remark = ""
    if first["probability"] is not None:
        remark = _(
            "of this shape with a probability of {probability}; value and σ are those of the mean "
            "over all shapes",
            probability=fixed(first["probability"], 2),
        )
    if first["relative_to"] is not None:
        remark = _(
            "change from {reference} °C, its level is not known",
            reference=fixed(first["relative_to"] - ICE_POINT, 1),
        )
        if first["not_separated"]:
            remark = f"{remark}; {first['not_separated']}"
    return outline.table_row(
        symbol(name),
        _("two straight lines") if knot is not None else DEGREES[first["order"]],
        fixed(first["temperature"] - ICE_POINT, 1),
        fixed(last["temperature"] - ICE_POINT, 1),
        "" if knot is None else fixed(knot - ICE_POINT, 1),
        _change(values),
        unit.name,
        remark,
    )
