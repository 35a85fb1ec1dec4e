"""Residuals of the result that counts: by manoeuvre with 3 σ, and as a histogram."""

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes

from inertial.sensors import PLURAL
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import fixed, whole
from inertial.text.typography import capital
from stages.report import drawing
from stages.report.drawing import Array
from stages.report.outline import (
    Column,
    Figure,
    Paragraph,
    Part,
    Section,
    Table,
    columns,
    table_row,
)
from stages.report.sections.residual_figures import (
    UNIT,
    Residual,
    beyond_noise,
    draw_by_manoeuvre,
    pieces_of,
)
from stages.report.tables import Tables, once

STEADY = "steady"
MAX_SIGMAS = 3.0
REACH, BINS = 4.5, 36  # σ, of the histogram where nothing is beyond
FEW = 0.001  # of the values on either side that may be beyond a wider one
NO_ATTITUDE = _(
    "None: no attitude is known to predict readings by. In positions of unknown attitude "
    "“Compensation” compares |f| with gravity where all accelerometers are determined."
)


@once
def final_residuals(tables: Tables) -> dict[str, list[Residual]]:
    """By sensor, in the order of the plan: fifths of static positions, whole steady rotations."""
    frame = tables.frame("residuals")
    each = dict(list(frame.groupby("manoeuvre")))
    by_sensor: dict[str, list[Residual]] = {}
    for sensor in UNIT:
        names = [[f"{of}_{sensor}_{axis}" for axis in AXES] for of in ("residual", "sigma")]
        by_sensor[sensor] = []
        for name in tables.frame("manoeuvres")["manoeuvre"]:
            if name not in each:
                continue
            own = each[name][each[name]["phase"].isin(["rest", STEADY])]
            left, sigma = (own[own_columns].to_numpy(np.float64) for own_columns in names)
            there = np.isfinite(left).any(axis=1)
            if not there.any():
                continue
            turns = (own["phase"] == STEADY).all()
            count = int(there.sum())
            places = [np.arange(count)] if turns else pieces_of(count)
            weights = np.where(np.isfinite(left), sigma**-2.0, 0.0)[there]
            sums = np.nan_to_num(left)[there] * weights
            with np.errstate(invalid="ignore", divide="ignore"):
                total = np.array([weights[place].sum(axis=0) for place in places])
                mean = np.array([sums[place].sum(axis=0) for place in places]) / total
                by_sensor[sensor].append(Residual(name, mean, total**-0.5))
    return by_sensor


def parts(tables: Tables) -> Iterator[Part]:
    """A figure of each sensor, and how the residuals compare with the noise."""
    if not any(final_residuals(tables).values()):
        there = any(row["value"] is not None for row in tables.rows("result"))
        yield Paragraph(NO_ATTITUDE if there else _("None: there is no final result."), "fair")
        return
    for sensor, shown in final_residuals(tables).items():
        if shown:
            yield _figure(tables, sensor, shown)
    yield _table(tables)


SECTION = Section(
    "residuals",
    _("Residuals"),
    _(
        "Measured readings less those that the final result predicts, its terms of the sensors "
        "included."
    ),
    _(
        "Effects of the table, the site or the mounting are not taken off a reading, and appear "
        "here. Left, fifths of each static position and whole steady rotations, with ±3 σ of white "
        "noise; right, the residuals of blocks and of seconds of rotation over their σ, of which "
        "noise alone leaves 0.3 % beyond 3; the outermost bins hold what is further out. Where the "
        "table's heading is not known, the azimuth of each static position is estimated with the "
        "result, so one direction of the gyros' residuals at rest is fitted away."
    ),
    ("residuals", "manoeuvres", "result"),
    parts,
)


def _figure(tables: Tables, sensor: str, shown: Sequence[Residual]) -> Figure:
    with drawing.style():
        drawn, panels = draw_by_manoeuvre(sensor, shown, beside=1.0, band=MAX_SIGMAS)
        _histogram(panels[1], tables, sensor)
        picture = drawing.svg(drawn, f"residuals-{sensor}")
    sensors = PLURAL[sensor]
    return Figure(
        _(
            "Residuals of the {sensors} by manoeuvre, with ±3 σ of the noise, and their "
            "distribution.",
            sensors=sensors,
        ),
        picture,
        _("Mean residuals of the {sensors} by manoeuvre, and their histogram.", sensors=sensors),
    )


def _ratios(tables: Tables, sensor: str, axis: str) -> tuple[Array, Array]:
    """Residuals over σ: those at rest, those in rotation."""
    frame = tables.frame("residuals")
    left = frame[f"residual_{sensor}_{axis}"] / frame[f"sigma_{sensor}_{axis}"]
    turning = (frame["phase"] == STEADY).to_numpy()
    values = left.to_numpy(np.float64)
    rest, turn = values[~turning], values[turning]
    return rest[np.isfinite(rest)], turn[np.isfinite(turn)]


def reach_of(values: Array) -> float:
    """How far the histogram goes to either side, σ: as far as the values, but for a few."""
    if not len(values):
        return REACH
    return max(REACH, float(np.ceil(np.quantile(np.abs(values), 1 - FEW))))


def _histogram(panel: Axes, tables: Tables, sensor: str) -> None:
    each = {axis: np.concatenate(_ratios(tables, sensor, axis)) for axis in AXES}
    reach = reach_of(np.concatenate(list(each.values())))
    edges = np.linspace(-reach, reach, BINS + 1)
    width = edges[1] - edges[0]
    for axis, values in each.items():
        if len(values):  # what is beyond the ends is in the outermost bins
            counts, _edges = np.histogram(np.clip(values, edges[0], edges[-1]), edges)
            density = counts / len(values) / width
            panel.stairs(density, edges, color=drawing.AXIS_COLOUR[axis], linewidth=0.9)
    x = np.linspace(-reach, reach, 241)
    panel.plot(x, np.exp(-(x**2) / 2) / np.sqrt(2 * np.pi), color=drawing.INK, linewidth=0.7)
    for limit in (-MAX_SIGMAS, MAX_SIGMAS):
        panel.axvline(limit, color=drawing.QUIET, linewidth=0.6, dashes=(3, 2))
    panel.set_xlim(-reach, reach)
    panel.set_ylim(bottom=0.0)
    panel.set_yticks([])
    far = [] if reach == REACH else [round(0.9 * reach)]
    panel.set_xticks([*(-at for at in far), -3, 0, 3, *far])
    panel.set_title(_("Distribution, in σ"), pad=4)


def _table(tables: Tables) -> Table:
    rows = []
    for sensor in UNIT:
        for axis in AXES:
            cells, high = [], False
            for values in _ratios(tables, sensor, axis):
                if not len(values):
                    cells += ["—", "—", "—"]
                    continue
                ratio = float(np.sqrt(np.mean(values**2)))
                beyond = int((np.abs(values) > MAX_SIGMAS).sum())
                cells += [whole(len(values)), fixed(ratio, 2), whole(beyond)]
                high = high or beyond_noise(ratio, len(values))
            name = f"{capital(PLURAL[sensor])}, {axis}"
            rows.append(table_row(name, *cells, tone="fair" if high else ""))
    headings = (_("means"), _("rms, in σ"), _("beyond 3 σ"))
    return Table(
        _(
            "Root mean square of the residuals over σ, and how many are beyond 3 σ. σ is that of "
            "white noise alone: the errors of the table, of positions and of rates, by which tests "
            "and the σ of the result are larger, are not in it, so that more than 1 is no finding."
        ),
        (
            Column(_("Sensor")),
            *columns("number", *headings, group=_("Static positions")),
            *columns("number", *headings, group=_("Steady rotation")),
        ),
        rows,
    )
