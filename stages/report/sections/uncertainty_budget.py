"""Where the uncertainties of the result come from, and how they belong together."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.figure import Figure as Drawn

from inertial.campaign.records import grouped
from inertial.sensors import SINGULAR
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.parameters import MIXTURE
from inertial.text.typography import capital
from stages.report.drawing import Margins, panels, style, svg
from stages.report.outline import (
    Column,
    Figure,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
    columns,
    table_row,
)
from stages.report.results import (
    KIND_IN_A_SENTENCE,
    RESULT_TABLES,
    by_kind,
    final_results,
    kind_of,
    quantity_of,
    symbol,
)
from stages.report.tables import Record, Tables
from stages.report.words import with_mount

SOURCES = {
    "noise": _("white noise"),
    "drift": _("drift of the bias in the noise"),
    "switch_on": _("bias from switch-on to switch-on"),
    "scatter": _("scatter of manoeuvres"),
    "random_walk": _("random walk of the bias"),
    "position": _("table, position"),
    "angle": _("table, angle"),
    "rate": _("table, each rate"),
    "table_rate": _("table, all rates alike"),
    "interpolation": _("interpolated gaps"),
    "clock": _("rate of the clock"),
    "azimuth": _("azimuth"),
    "gravity": _("gravity"),
    "latitude": _("latitude"),
}
MIN_SHARE = 5e-4  # of a variance, below which a share is written as nothing
MIN_SHARED = 0.9  # of the variance of a scale error, from which gravity makes them correlated
MIN_LABELLED = 25  # parameters of a sensor, from which a picture has no names


def parts(tables: Tables) -> Iterator[Part]:
    """A row per sensor and kind of parameter; the correlations of each sensor as a picture."""
    rows = tables.rows("uncertainty_budget")
    yield from _not_split(tables, rows)
    if not rows:
        return
    there = [source for source in SOURCES if any(row["source"] == source for row in rows)]
    groups = grouped(rows, lambda row: (row["sensor"], row["mount"], kind_of(row["quantity"])))
    yield Table(
        _("Shares of the variance, in %, as the mean over the parameters of a kind."),
        (
            Column(_("Parameters"), "text"),
            Column(_("largest σ"), "number"),
            Column(_("unit"), "unit"),
            *columns("number", *(SOURCES[source] for source in there)),
        ),
        [_shares(key, own, there) for key, own in sorted(groups.items(), key=_in_order)],
        note=_("–: less than 0.05 %."),
    )
    yield from _correlations(tables)


SECTION = Section(
    "budget",
    _("Uncertainty budget"),
    _("Which source of error the uncertainty of each kind of parameter comes from."),
    _(
        "All sources that the estimation knows of; their shares add up to 100 %. Errors that "
        "it does not know of are not in them, nor in any σ: a scale error of clock or encoder "
        "that no standard excludes is part of the scale factors of the gyros."
    ),
    ("uncertainty_budget", "covariance", *RESULT_TABLES),
    parts,
)


OF_A_MEAN = _(
    "the result is a mean over models, and what these differ by is none of the sources below"
)
OF_MORE = _(
    "its σ differs by more than a tenth from that of the equations that the shares are of; they "
    "hold neither the form nor the moment of an effect, nor positions by hand"
)


def _not_split(tables: Tables, rows: Sequence[Record]) -> Iterator[Paragraph]:
    """By sensor the parameters of the result with a sigma that has no shares, and why."""
    split = {(row["mount"], row["sensor"], row["quantity"]) for row in rows}
    for result in final_results(tables):
        known = [row for row in result.determined if row["sigma"]]
        own = [r for r in known if (r["mount"], r["sensor"], r["parameter"]) not in split]
        if own:
            names = listed([symbol(row["parameter"]) for row in own])
            text = _(
                "{sensor}, not split: {parameters}; {reason}.",
                sensor=result.sensor,
                parameters=_("all parameters") if len(own) == len(known) else names,
                reason=OF_A_MEAN if result.method == MIXTURE else OF_MORE,
            )
            yield Paragraph(text, "fair")


def _in_order(item: tuple[tuple[str, str, str], list[Record]]) -> tuple[str, str, int]:
    (sensor, mount, kind), _rows = item
    return sensor, mount, list(KIND_IN_A_SENTENCE).index(kind)


def _shares(key: tuple[str, str, str], rows: Sequence[Record], there: Sequence[str]) -> Row:
    sensor, mount, kind = key
    names = dict.fromkeys(row["quantity"] for row in rows)
    variances = [sum(r["sigma"] ** 2 for r in rows if r["quantity"] == name) for name in names]
    unit = quantity_of({"parameter": rows[0]["quantity"], "unit": rows[0]["unit"]}).shown
    shares = [
        float(np.mean([row["share"] for row in rows if row["source"] == source] or [0.0]))
        for source in there
    ]
    return table_row(
        with_mount(f"{capital(SINGULAR[sensor])}, {KIND_IN_A_SENTENCE[kind]}", mount),
        significant(unit.of(float(np.sqrt(max(variances)))), 2),
        unit.name,
        *("–" if share < MIN_SHARE else significant(100 * share, 2) for share in shares),
    )


def _correlations(tables: Tables) -> Iterator[Figure]:
    """The correlations of the parameters and effects of each sensor, from −1 to 1."""
    known = {(row["first"], row["second"]): row["covariance"] for row in tables.rows("covariance")}
    each = []
    for result in final_results(tables):
        rows = by_kind([*result.calibration.values(), *result.effects])
        rows = [row for row in rows if (row["id"], row["id"]) in known]
        if len(rows) > 1:
            each.append((result.sensor, rows))
    if not each:
        return
    with style():
        margins = Margins(left=0.5, across=0.5, bottom=0.35, top=0.3, right=0.6)
        figure, axes = panels(1, len(each), 2.9, margins, sharex=False)
        for panel, (name, rows) in zip(axes[0], each, strict=True):
            drawn_matrix = _matrix(panel, name, rows, known)
        _colour_bar(figure, axes[0][-1], drawn_matrix)
        drawn = svg(figure, "correlations")
    yield Figure(
        " ".join([_CORRELATIONS] + [_BY_GRAVITY] * _of_gravity(tables)),
        drawn,
        _("The matrix of the correlations of all parameters of each sensor."),
    )


_CORRELATIONS = _(
    "Correlations of the parameters, red positive and blue negative: what two of them have in "
    "common adds up, or cancels, where both are used."
)
_BY_GRAVITY = _(
    "The accelerometers' scale errors share the error of gravity, so they are correlated by nearly "
    "+1: differences between them are known far better than each of them."
)


def _of_gravity(tables: Tables) -> bool:
    """Whether the error of gravity is most of the variance of scale errors."""
    return any(
        row["source"] == "gravity"
        and row["share"] > MIN_SHARED
        and kind_of(row["quantity"]) == "scale"
        for row in tables.rows("uncertainty_budget")
    )


def _colour_bar(figure: Drawn, beside: Axes, matrix: QuadMesh) -> None:
    """From −1 to 1, to the right of the last matrix."""
    place = beside.get_position()
    panel = figure.add_axes((place.x1 + 0.01, place.y0, 0.012, place.height))
    bar = figure.colorbar(matrix, cax=panel, ticks=[-1, 0, 1])
    bar.ax.set_yticklabels(["−1", "0", "+1"], fontsize=6.0)
    bar.outline.set_visible(False)
    panel.tick_params(length=0)
    panel.grid(visible=False)


def _matrix(
    panel: Axes, name: str, rows: Sequence[Record], known: dict[tuple[str, str], float]
) -> QuadMesh:
    ids = [row["id"] for row in rows]
    covariance = np.array(
        [[known.get((a, b), known.get((b, a), 0.0)) for b in ids] for a in ids], np.float64
    )
    sigma = np.sqrt(np.diag(covariance))
    drawn = panel.pcolormesh(
        covariance / np.outer(sigma, sigma), cmap="RdBu_r", vmin=-1, vmax=1, rasterized=False
    )
    panel.invert_yaxis()
    panel.set_aspect("equal")
    panel.grid(visible=False)
    panel.set_title(name, loc="left", pad=2)
    labels = [symbol(row["parameter"]).replace("_", "") for row in rows]
    size = 6.0 if len(rows) < MIN_LABELLED else 4.0
    places = np.arange(len(ids)) + 0.5
    panel.set_yticks(places, labels, fontsize=size)
    panel.set_xticks(places, labels, fontsize=size, rotation=90)
    panel.tick_params(length=0)
    return drawn
