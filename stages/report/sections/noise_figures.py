"""The two figures of the noise: Allan deviation, and root of the power density, log-log."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from inertial.sensors import PLURAL, SENSORS
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.typography import capital
from inertial.text.units import DEGREES_PER_HOUR, MICRO_G, MILLI_G, RANDOM_WALK, Unit
from stages.report import drawing, outline
from stages.report.drawing import Array
from stages.report.tables import Record, arrays

HEIGHT = 1.95  # inches, of a panel
MARGINS = drawing.Margins(left=0.46, right=0.16, top=0.24, across=0.62, bottom=0.36)
LEGEND = 0.18  # inches above the panels
LOWEST = np.sqrt(2 * np.log(2) / np.pi)  # Allan deviation of a bias instability of 1
MANY_MICRO_G = 1000.0
MIN_DEGREES = 12.0  # of freedom of a point of the spectrum
POOLED_OVER = 10 ** (1 / 16)  # ratio of frequencies that are one point
NEAR = 10.0  # ratio to the data within which the level of a data sheet is shown
LEAST_RANGE = 6.0  # of highest to lowest of an axis, so that it has two numbers
FEW_DECADES = 2.7  # of an axis, of which each is labelled at 1, 2 and 5
MOST_LINES = 5  # named in one panel
SAME_LINE = 1.12  # ratio of two frequencies of one oscillation
DASHES = (4, 2.5)
LABEL_SIZE = 6.0
LABEL_SPAN = 2.5  # ratio of the frequencies where a label begins and ends
# What a data sheet states, as Allan deviation at tau, and as density of both sides at f.
Curve = Callable[[Array, float], Array]
ALLAN_OF: dict[str, Curve] = {
    "white_noise": lambda tau, n: n / np.sqrt(tau),
    "bias_instability": lambda tau, b: np.full_like(tau, LOWEST * b),
    "random_walk": lambda tau, k: k * np.sqrt(tau / 3),
}
ROOT_DENSITY_OF: dict[str, Curve] = {
    "white_noise": lambda f, n: np.full_like(f, n),
    "bias_instability": lambda f, b: b / np.sqrt(2 * np.pi * f),
    "random_walk": lambda f, k: k / (2 * np.pi * f),
}


def allan_figure(rows: Sequence[Record], sheet: Sequence[Record]) -> outline.Figure:
    """Overlapping Allan deviation against averaging time, one panel for each sensor."""
    drawn = _figure("allan", rows, sheet, _allan_panel, _("Averaging time, s"), legend=True)
    stretches = max(row["stretches"] for row in rows)
    of = _("one static stretch") if stretches == 1 else _("{n} static stretches", n=stretches)
    return outline.Figure(
        _(
            "Overlapping Allan deviation of {of}: points with their 1-σ interval; lines: the "
            "fitted terms of the noise.",
            of=of,
        ),
        drawn,
        _("Allan deviation of the gyros, left, and accelerometers, right, three axes each."),
    )


def spectrum_figure(rows: Sequence[Record], sheet: Sequence[Record]) -> outline.Figure:
    """Root of the power density against frequency, with the same terms, and oscillations."""
    drawn = _figure("spectrum", rows, sheet, _spectrum_panel, _("Frequency, Hz"))
    lines = any(row["line"] for row in rows)
    return outline.Figure(
        _(
            "Amplitude spectral density, the root of the two-sided power density, in units of N: "
            "pale the data, dark the same terms. White noise is level, at its N."
        )
        + (_(" Wedge: an oscillation, not fitted.") if lines else ""),
        drawn,
        _("Spectrum of the gyros, left, and accelerometers, right, three axes each."),
    )


def _figure(
    key: str,
    rows: Sequence[Record],
    sheet: Sequence[Record],
    draw: Callable[[Axes, str, Sequence[Record], Sequence[Record]], None],
    label: str,
    *,
    legend: bool = False,
) -> str:
    sensors = [s for s in SENSORS if any(row["channel"].startswith(s) for row in rows)]
    with drawing.style():
        margins = replace(MARGINS, top=MARGINS.top + LEGEND * legend)
        figure, axes = drawing.panels(1, len(sensors), HEIGHT, margins, sharex=False)
        for panel, sensor in zip(axes[0], sensors, strict=True):
            own = [row for row in rows if row["channel"].startswith(sensor)]
            draw(panel, sensor, own, [s for s in sheet if s["sensor"] == sensor])
            panel.set_xlabel(label)
        if legend:
            _legend(figure, [row for row in sheet if row["sensor"] in sensors])
        return drawing.svg(figure, key)


def _legend(figure: Figure, sheet: Sequence[Record]) -> None:
    """Axes, band, fit and data sheet in one line above the panels."""
    handles: list[Line2D | Patch] = [
        Line2D(
            [],
            [],
            color=drawing.AXIS_COLOUR[axis],
            marker=drawing.AXIS_MARK[axis],
            markersize=3.0,
            label=axis,
        )
        for axis in AXES
    ]
    handles.append(Patch(color=drawing.QUIET, alpha=0.25, label="± σ"))
    if any(_stated(sheet)):
        handles.append(
            Line2D([], [], color=drawing.INK, linewidth=0.9, dashes=DASHES, label=_("data sheet"))
        )
    figure.legend(
        handles=handles,
        loc="upper right",
        ncol=len(handles),
        columnspacing=1.6,
        handletextpad=0.5,
        borderaxespad=0.1,
        bbox_to_anchor=(1 - MARGINS.right / drawing.WIDTH, 1.0),
    )


def _allan_panel(panel: Axes, sensor: str, rows: Sequence[Record], sheet: Sequence[Record]) -> None:
    unit = _unit(sensor, [row["deviation"] for row in rows])
    for axis in AXES:
        own = _sorted(rows, f"{sensor}_{axis}", "tau")
        tau, deviation, lower, upper, model = arrays(
            own, "tau", "deviation", "lower", "upper", "model"
        )
        colour = drawing.AXIS_COLOUR[axis]
        drawing.band(
            panel, tau, lower / unit.size, upper / unit.size, colour, alpha=0.2, linewidth=0
        )
        panel.plot(
            tau,
            deviation / unit.size,
            linestyle="none",
            marker=drawing.AXIS_MARK[axis],
            markersize=2.2,
            markeredgewidth=0,
            color=colour,
        )
        panel.plot(tau, model / unit.size, color=colour, linewidth=0.9)
    _log_log(panel)
    _data_sheet(panel, sheet, unit, ALLAN_OF)
    panel.set_title(
        _(
            "{sensors}: Allan deviation, {unit}",
            sensors=capital(PLURAL[sensor]),
            unit=unit.name,
        ),
        pad=4,
    )


def _spectrum_panel(
    panel: Axes, sensor: str, rows: Sequence[Record], sheet: Sequence[Record]
) -> None:
    unit = RANDOM_WALK[sensor]
    for axis in AXES:
        own = _sorted(rows, f"{sensor}_{axis}", "frequency")
        place, model = arrays(own, "frequency", "model")
        frequency, density, degrees = pooled(own)
        root, part = np.sqrt(density) / unit.size, np.sqrt(2 / degrees) / 2
        colour = drawing.AXIS_COLOUR[axis]
        drawing.band(
            panel,
            frequency,
            root * np.exp(-part),
            root * np.exp(part),
            colour,
            alpha=0.16,
            linewidth=0,
        )
        panel.plot(frequency, root, color=colour, linewidth=0.6, alpha=0.55)
        panel.plot(place, np.sqrt(model) / unit.size, color=colour, linewidth=1.1)
    levels = [value / unit.size for term, value in _stated(sheet) if term == "white_noise"]
    _log_log(panel, levels)
    _data_sheet(panel, sheet, unit, ROOT_DENSITY_OF)
    ends: list[float] = []  # of the labels so far, in each line of them
    for frequency_of_line in _oscillations(rows):
        free = (i for i, end in enumerate(ends) if frequency_of_line > end)
        lane = next(free, len(ends))
        ends[lane : lane + 1] = [frequency_of_line * LABEL_SPAN]
        drawing.mark_place(panel, frequency_of_line / 1.01, frequency_of_line * 1.01)
        panel.annotate(
            f"{significant(frequency_of_line, 3)} Hz",
            (frequency_of_line, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(4, -1 - 1.2 * LABEL_SIZE * lane),
            textcoords="offset points",
            va="top",
            fontsize=LABEL_SIZE,
            color=drawing.MISSING,
        )
    panel.set_title(
        _(
            "{sensors}: amplitude spectral density, {unit}",
            sensors=capital(PLURAL[sensor]),
            unit=unit.name,
        ),
        pad=6,
    )


def pooled(rows: Sequence[Record]) -> tuple[Array, Array, Array]:
    """Frequencies, densities and degrees of freedom of neighbouring bins together.

    Those of an oscillation stay apart. A density of two degrees of freedom scatters over decades.
    """
    groups: list[list[Record]] = []
    for row in rows:
        last = groups[-1] if groups else []
        alone = not last or row["line"] or last[-1]["line"]
        enough = last and sum(each["degrees"] for each in last) >= MIN_DEGREES
        if alone or (enough and row["frequency"] > POOLED_OVER * last[0]["frequency"]):
            groups.append([row])
        else:
            last.append(row)
    points = []
    for group in groups:
        frequency, density, degrees = arrays(group, "frequency", "density", "degrees")
        middle = np.exp(np.average(np.log(frequency), weights=degrees))
        points.append((middle, np.average(density, weights=degrees), degrees.sum()))
    frequency, density, degrees = np.array(points, np.float64).reshape(-1, 3).T
    return frequency, density, degrees


def _unit(sensor: str, values: Sequence[float]) -> Unit:
    """°/h; µg, or mg where the lowest deviation has many of them."""
    if sensor == "gyro":
        return DEGREES_PER_HOUR
    return MILLI_G if min(values) > MANY_MICRO_G * MICRO_G.size else MICRO_G


def _log_log(panel: Axes, near: Iterable[float] = ()) -> None:
    """Both scales logarithmic with plain numbers, and a little room around the data.

    `near`: heights that are shown, too, where they are not far away.
    """
    panel.set_xscale("log")
    panel.set_yscale("log")
    panel.margins(x=0.02, y=0.06)
    panel.autoscale_view()
    low, high = panel.get_ylim()
    shown = [height for height in near if low / NEAR < height < high * NEAR]
    low, high = (
        min([low, *(height / 1.2 for height in shown)]),
        max([high, *(height * 1.2 for height in shown)]),
    )
    missing = max(1.0, float(np.sqrt(LEAST_RANGE * low / high)))
    panel.set_xlim(panel.get_xlim())  # what follows does not widen them
    panel.set_ylim(low / missing, high * missing)
    _ticks(panel.xaxis, panel.get_xlim())
    _ticks(panel.yaxis, panel.get_ylim())


def _ticks(axis: Axis, limits: tuple[float, float]) -> None:
    decades = np.log10(limits[1] / limits[0])
    if decades < FEW_DECADES:
        drawing.plain_numbers(axis)
        return
    axis.set_major_locator(LogLocator(numticks=12))
    axis.set_minor_locator(LogLocator(subs=tuple(range(2, 10)), numticks=12))
    axis.set_major_formatter(FuncFormatter(lambda value, _position: f"{value:g}"))
    axis.set_minor_formatter(NullFormatter())


def _stated(sheet: Sequence[Record]) -> Iterator[tuple[str, float]]:
    """Each figure of the data sheet once, by the term it is of."""
    figures = {(term, row[term]) for row in sheet for term in ALLAN_OF if row[term] is not None}
    yield from sorted(figures)


def _data_sheet(panel: Axes, sheet: Sequence[Record], unit: Unit, curves: dict[str, Curve]) -> None:
    """What the data sheet states, over the whole width of the panel."""
    place = np.geomspace(*panel.get_xlim(), 50)
    for term, value in _stated(sheet):
        shown = curves[term](place, value) / unit.size
        panel.plot(place, shown, color=drawing.INK, linewidth=0.9, dashes=DASHES, zorder=1.8)


def _oscillations(rows: Sequence[Record]) -> list[float]:
    """Frequencies of the strongest oscillations, Hz, neighbouring bins as one."""
    found = sorted((row for row in rows if row["line"]), key=lambda row: float(row["frequency"]))
    groups: list[list[Record]] = []
    for row in found:
        if groups and row["frequency"] < SAME_LINE * groups[-1][-1]["frequency"]:
            groups[-1].append(row)
        else:
            groups.append([row])
    peaks = [max(group, key=lambda row: float(row["density"])) for group in groups]
    peaks.sort(key=lambda row: -float(row["density"]))
    return sorted(float(row["frequency"]) for row in peaks[:MOST_LINES])


def _sorted(rows: Sequence[Record], channel: str, key: str) -> list[Record]:
    own = [row for row in rows if row["channel"] == channel]
    return sorted(own, key=lambda row: float(row[key]))
