"""The page of a serial number: its calibrations, every parameter over them, and the next one."""

from argparse import Namespace
from collections.abc import Callable, Iterator, Sequence
from datetime import date, timedelta
from itertools import pairwise
from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator

from inertial.sensors import PLURAL, SENSORS, SINGULAR, unit_of
from inertial.tables.errors import Refusal
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.parameters import AXES, BIAS, CROSS, PARTS, SCALE, sign_of
from inertial.text.typography import capital
from inertial.text.units import Unit, quantity
from overviews.known import serials
from overviews.tables_of import made_from
from overviews.units import Imu, imus_of
from stages.history.repeatability import UNKNOWN, YEAR, Change, Observed, change, changes
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
from stages.report.page import page
from stages.report.results import KIND
from stages.report.sections.repeatability import SECTION as REPEATABILITY
from stages.report.sections.verdict import LEVELS
from stages.report.tables import Record, Tables

Parts = Callable[[Tables], Iterator[outline.Part]]


def documents(given: Namespace, code: str) -> dict[str, str]:
    """reports/history/<serial>.html.

    Raises
    ------
    Refusal
        where the archive has no calibration of this serial number
    """
    (serial,) = given.names
    settings = {"tolerance": {}} | given.settings["history"]
    imus = []
    if serial != UNKNOWN:  # those may be different IMUs
        imus = imus_of(given.archive, serial, given.derived, **settings)
    if not imus:
        raise Refusal(
            str(given.archive),
            _("serial number {serial}", serial=serial),
            _("no calibration of it"),
            _("one of {serials}", serials=", ".join(serials(given.archive)) or _("none")),
            _("name one that is there; a report puts its campaign into the archive"),
        )
    html = history_page(imus, given.archive, given.reports, code)
    return {f"history/{serial}.html": html}


def history_page(imus: Sequence[Imu], archive: Path, reports: Path, code: str) -> str:
    """One HTML page; chapters for each IMU with this serial number, as a rule a single one.

    `reports`: the folder of the pages, to which it leads where a campaign has one.
    """
    serial = numbers.shortened(imus[0].last.row["serial"], 80)
    several = len(imus) > 1
    tables = Tables({}, {})
    sections: list[tuple[outline.Section, Tables]] = []
    for number, imu in enumerate(imus):
        name = f": {imu.name}" + (_(", simulated") if imu.simulated else "") if several else ""
        key = f"-{number}" if number else ""
        sections += [
            (_summary(imu, reports, name, key), imu.tables),
            (_courses(imu, name, key), imu.tables),
            (_renamed(REPEATABILITY, name, key), imu.tables),
            (_values(imu, name, key), imu.tables),
        ]
    files = [archive / entry.file for imu in imus for entry in imu.calibrations]
    sections.append((made_from(files, code), tables))
    chapters: list[outline.Chapter] = []
    for section, own in sections:
        parts = list(section.parts(own))
        if parts:
            chapters.append(outline.Chapter(str(len(chapters) + 1), section, parts))
    return page(
        outline.Report(
            title=_("History of {serial}", serial=serial),
            campaign=serial,
            instrument=", ".join(dict.fromkeys(imu.name for imu in imus)),
            running=_("History of {serial}", serial=serial),
            simulated=all(imu.simulated for imu in imus),
            chapters=chapters,
        )
    )


def _renamed(section: outline.Section, name: str, key: str) -> outline.Section:
    return outline.Section(
        section.key + key,
        section.title + name,
        section.shows,
        section.reading,
        section.reads,
        section.parts,
    )


def _section(
    key: str,
    title: str,
    shows: str,
    reading: str,
    parts: Parts,
) -> outline.Section:
    return outline.Section(key, title, shows, reading, (), parts)


# ---- Calibrations, and when it is due.


def due_in_words(imu: Imu) -> tuple[str, outline.Tone]:
    """When the IMU is due, or why that is not known."""
    due = imu.due
    if due is None:
        return _("No due date: {reason}.", reason=imu.why_not_due or _("nothing is known")), ""
    rows = [row for row in imu.tables.rows("forecast") if row["due"] == due]
    of = ", ".join(f"{SINGULAR[row['sensor']]} {row['quantity'].replace('_', ' ')}" for row in rows)
    return _("Due on {due}, by {parameters}.", due=due, parameters=of), "fair"


def _summary(imu: Imu, reports: Path, name: str, key: str) -> outline.Section:
    def parts(_tables: Tables) -> Iterator[outline.Part]:
        yield outline.Paragraph(*due_in_words(imu))
        yield outline.Table(
            _("Calibrations, the newest last."),
            (
                outline.Column(_("Campaign")),
                outline.Column(_("Date"), "name"),
                outline.Column(_("Mounting")),
                outline.Column(_("Switch-on")),
                outline.Column(_("Table")),
                outline.Column(_("Changed since the last")),
                outline.Column(_("Verdict")),
            ),
            [
                _calibration(entry.row, changed, reports)
                for entry, changed in zip(imu.calibrations, _changed(imu), strict=True)
            ],
            note=_(
                "Changed by more than chance (Holm 1979), the errors of shared references taken "
                "out. Two of them beside each other, and whether the IMU was only mounted anew: "
                "make compare A=… B=…"
            ),
        )

    return _section(
        f"calibrations{key}",
        _("Calibrations") + name,
        _("All current calibrations of this instrument in the archive, and when it is due."),
        _(
            "A calibration that another one of the same campaign supersedes is left out. It is due "
            "on the day from which the 95 % interval of the next calibration leaves the last value "
            "by more than may_change of the last campaign, or history, tolerance of the settings, "
            "allows."
        ),
        parts,
    )


def _changed(imu: Imu) -> Iterator[str]:
    """What changed since the last, of each calibration."""
    yield "—"
    for before, after in pairwise(entry.row["campaign"] for entry in imu.calibrations):
        yield _in_words(changes(imu.series, before, after, imu.level))


def _in_words(compared: Sequence[Change]) -> str:
    """How many parameters changed, and the one that did most."""
    changed = [one for one in compared if one.beyond]
    if not changed:
        return _("none") if compared else "—"
    most = max(changed, key=lambda one: abs(one.size) / one.sigma)
    return _(
        "{changed} of {count}, most {parameter} of the {sensor}, by {sigmas} σ",
        changed=len(changed),
        count=len(compared),
        parameter=sign_of(most.quantity),
        sensor=PLURAL[most.sensor],
        sigmas=numbers.fixed(abs(most.size) / most.sigma, 1),
    )


def _calibration(row: dict[str, Any], changed: str, reports: Path) -> outline.Row:
    campaign = row["campaign"]
    verdicts = [one["verdict"] for one in row["verdicts"]]
    worst = next((level for level in LEVELS if level in verdicts), "")
    word, tone = LEVELS[worst][:2] if worst else ("—", "")
    return outline.Row(
        (
            numbers.shortened(campaign, 80),
            numbers.shortened(row["date"], 20),
            *(_label(row[which]) for which in ("mounting", "switch_on", "table")),
            changed,
            word,
        ),
        tone="" if tone == "good" else tone,
        href=f"../{campaign}.html" if (reports / f"{campaign}.html").is_file() else "",
    )


def _label(text: object) -> str:
    return numbers.shortened(text, 40) if isinstance(text, str) else "—"


# ---- Courses and values.


def _courses(imu: Imu, name: str, key: str) -> outline.Section:
    def parts(_tables: Tables) -> Iterator[outline.Part]:
        yield from figures(imu)

    return _section(
        f"courses{key}",
        _("Parameters over the dates") + name,
        _("Each of the 24 parameters by the result that counted, over its calibrations."),
        _(
            "A point is value ± σ. Calibrations at one table and place share the error of gravity "
            "and of the table, so that points may differ by less than their σ say."
        ),
        parts,
    )


def _values(imu: Imu, name: str, key: str) -> outline.Section:
    def parts(_tables: Tables) -> Iterator[outline.Part]:
        for sensor in SENSORS:
            rows = list(_rows(imu, sensor))
            if rows:
                yield outline.Table(
                    _("Values of the {sensor}s.", sensor=SINGULAR[sensor]),
                    (
                        outline.Column(_("Date"), "name"),
                        outline.Column(_("Campaign")),
                        *outline.value_and_sigma(unit=True),
                        outline.Column(_("change since the last, σ"), "number"),
                    ),
                    rows,
                )

    return _section(
        f"values{key}",
        _("Values") + name,
        _("The numbers behind the figures."),
        _(
            "The change since the last is in units of its σ, without the errors of references that "
            "both share."
        ),
        parts,
    )


def _rows(imu: Imu, sensor: str) -> Iterator[outline.Row]:
    for (of, parameter), values in imu.series.items():
        if of != sensor:
            continue
        unit = quantity(parameter, unit_of(sensor, parameter)).laboratory
        decimals = numbers.common_decimals(value.sigma / unit.size for value in values)
        yield outline.head(parameter.replace("_", " "))
        before: Observed | None = None
        for value in values:
            sigmas = None
            if before is not None:
                difference, sigma = change(before, value)
                sigmas = difference / sigma
            yield outline.table_row(
                value.date,
                numbers.shortened(value.campaign, 80),
                *numbers.with_sigma(value.value / unit.size, value.sigma / unit.size, decimals),
                unit.name,
                numbers.fixed(sigmas, 1),
            )
            before = value


# ---- Courses of the parameters over the dates, with what the next calibration may find.

NAMES_OF = {"bias": BIAS, "scale": SCALE, "cross": CROSS}
MARGINS = Margins(left=0.52, down=0.36, across=0.62, bottom=0.3)
HEIGHT = 1.0  # inches, of a panel
MIN_DRIFT_SIGMAS = 2.0  # sigmas, from which a drift is drawn
EPOCH = date(2000, 1, 1)  # beside which a year of 365.25 days keeps the months


def figures(imu: Imu) -> Iterator[outline.Figure]:
    """A figure for each sensor and kind of parameter, a panel for each parameter."""
    forecast = {(row["sensor"], row["quantity"]): row for row in imu.tables.rows("forecast")}
    jumps = {(row["sensor"], row["quantity"]): row for row in imu.tables.rows("jumps")}
    for sensor in SENSORS:
        for kind, names in NAMES_OF.items():
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

            drawn = grid(there, draw, HEIGHT, "", f"{sensor}-{kind}-{imu.simulated:d}", MARGINS)
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
    if abs(row["drift"]) > MIN_DRIFT_SIGMAS * row["drift_sigma"]:
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
