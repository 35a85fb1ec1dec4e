"""The courses of the parameters over the dates, with what the next calibration may find."""

from collections.abc import Iterator, Sequence
from datetime import date, timedelta

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator

from inertial.sensors import SENSORS, SINGULAR, unit_of
from inertial.text.messages import _
from inertial.text.parameters import AXES, BIAS, CROSS, PARTS, SCALE
from inertial.text.typography import capital
from inertial.text.units import Unit, quantity
from overviews.units import Imu
from stages.history.repeatability import UNKNOWN, YEAR, Observed
from stages.report import outline
from stages.report.drawing import (
    AXIS_COLOUR,
    AXIS_MARK,
    INK,
    MISSING,
    QUIET,
    Margins,
    grid,
    name_axis,
    ticks,
)
from stages.report.results import KIND
from stages.report.tables import Record

KINDS = {"bias": BIAS, "scale": SCALE, "cross": CROSS}
MARGINS = Margins(left=0.52, down=0.36, across=0.62, bottom=0.3)
HEIGHT = 1.0  # inches, of a panel
SURE = 2.0  # sigmas, from which a drift is drawn
EPOCH = date(2000, 1, 1)  # beside which a year of 365.25 days keeps the months


def figures(imu: Imu) -> Iterator[outline.Figure]:
    """A figure for each sensor and kind of parameter, a panel for each parameter."""
    forecast = {(row["sensor"], row["quantity"]): row for row in imu.tables.rows("forecast")}
    jumps = {(row["sensor"], row["quantity"]): row for row in imu.tables.rows("jumps")}
    for sensor in SENSORS:
        for kind, names in KINDS.items():
            series = {name: _dated(imu.series.get((sensor, name), [])) for name in names}
            there = [name for name, values in series.items() if values]
            if not there:
                continue
            unit = quantity(there[0], unit_of(sensor, there[0])).laboratory

            def draw(
                panel: Axes,
                name: str,
                series: dict[str, list[Observed]] = series,
                sensor: str = sensor,
                unit: Unit = unit,
            ) -> None:
                key = (sensor, name)
                _panel(panel, name, series[name], unit, forecast.get(key), jumps.get(key))

            drawn = grid(there, draw, HEIGHT, MARGINS, "", f"{sensor}-{kind}-{imu.simulated:d}")
            what = _(
                "{kind} of the {sensor}, {unit}",
                kind=KIND[kind],
                sensor=SINGULAR[sensor],
                unit=unit.name,
            )
            yield outline.Figure(
                _(
                    "{what}: value ± σ over the dates; the bar at the right: the 95 % interval of "
                    "the next calibration; dashed: the drift, where it exceeds 2 σ; dotted: a "
                    "jump; grey: what the tolerance allows about the last value.",
                    what=what,
                ),
                drawn,
                capital(_("{what} over the dates of the calibrations.", what=what)),
            )


def _dated(values: Sequence[Observed]) -> list[Observed]:
    return [value for value in values if value.date != UNKNOWN]


def _panel(
    panel: Axes,
    name: str,
    values: Sequence[Observed],
    unit: Unit,
    forecast: Record | None,
    jump: Record | None,
) -> None:
    axes = PARTS[name].axes
    colour, mark = AXIS_COLOUR[axes[0]], AXIS_MARK[axes[0]]
    days = [_number(value.date) for value in values]
    panel.errorbar(
        days,
        [value.value / unit.size for value in values],
        [value.sigma / unit.size for value in values],
        color=colour,
        marker=mark,
        markersize=3,
        linestyle="none",
        elinewidth=0.8,
        capsize=2,
    )
    if forecast is not None and forecast["low"] is not None:
        _next(panel, values, days, unit, forecast)
    if jump is not None:
        panel.axvline(
            (_number(jump["after"]) + _number(jump["until"])) / 2,
            color=MISSING,
            linestyle=":",
            linewidth=1.2,
        )
    if len(set(days)) == 1:
        panel.set_xlim(days[0] - 0.5, days[0] + 0.5)
    ticks(panel, 4)
    panel.xaxis.set_major_locator(MaxNLocator(3, steps=(1, 2.5, 5, 10)))
    panel.xaxis.set_major_formatter(FuncFormatter(lambda year, _place: _month(year)))
    panel.tick_params(labelbottom=True)
    panel.margins(x=0.08)
    name_axis(panel, axes[0] if axes[0] in AXES else "", name.replace("_", " "))


def _next(
    panel: Axes, values: Sequence[Observed], days: Sequence[float], unit: Unit, row: Record
) -> None:
    """What the next calibration may find, the drift, and what the tolerance allows."""
    at = _number(row["at"])
    low, high = row["low"] / unit.size, row["high"] / unit.size
    panel.plot([at, at], [low, high], color=QUIET, linewidth=4, alpha=0.45, solid_capstyle="butt")
    panel.plot(at, row["median"] / unit.size, marker="_", markersize=7, color=INK)
    if abs(row["drift"]) > SURE * row["drift_sigma"]:
        weights = [1 / value.sigma**2 for value in values]
        day = sum(w * d for w, d in zip(weights, days, strict=True)) / sum(weights)
        mean = sum(w * v.value for w, v in zip(weights, values, strict=True)) / sum(weights)
        ends = [days[0], at]
        course = [(mean + row["drift"] * (end - day)) / unit.size for end in ends]
        panel.plot(ends, course, color=QUIET, linestyle="--", linewidth=0.8)
    if row["tolerance"] is not None:
        last, most = values[-1].value / unit.size, row["tolerance"] / unit.size
        panel.axhspan(last - most, last + most, color=QUIET, alpha=0.1, linewidth=0, zorder=0)


def _number(day: str) -> float:
    """A date in years: 2025.0 is the first of January."""
    return EPOCH.year + (date.fromisoformat(day) - EPOCH).days / YEAR


def _month(year: float) -> str:
    """The month of a date in years."""
    return f"{EPOCH + timedelta(days=round((year - EPOCH.year) * YEAR)):%Y-%m}"
