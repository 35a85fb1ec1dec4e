"""Residuals by manoeuvre: of the joint model without and with effects, and of the final result."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Drawn
from matplotlib.ticker import MaxNLocator
from numpy.typing import NDArray

from inertial.sensors import PLURAL
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import fixed, p_is, shortened, whole
from inertial.text.typography import capital, columns_of
from inertial.text.units import DEGREE, DEGREES_PER_HOUR, ICE_POINT, MICRO_G, Unit
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
from stages.report.sections.effect_sentences import FITTED, HELD_OUT, about_effect
from stages.report.sections.effect_tables import SMOOTH, TESTS, channel, place
from stages.report.tables import Record, Tables, arrays, gains, once

UNIT = {"gyro": DEGREES_PER_HOUR, "accel": MICRO_G}
MOST_NAMES = 24  # manoeuvres whose names have room beside each other
LETTER = 0.046  # inches that each letter of an upright name takes
PIECES = 5  # of a rest, so that what changes within it is seen
APART = 0.04  # of a manoeuvre, between its axes
MOST_STRUCTURES = 3
MAX_USUAL_SIGMAS = 3.0  # from which a point does not stretch the picture
MAX_CHANCE = 4.0  # σ of the mean square of n values over its expectation, √(2/n)
MIN_EXCESS_RATIO = 1.05  # of an rms over σ: that of the noise level itself is not known better
# What a picture of each test goes along, its unit, and where that begins in SI.
ALONG = {
    "time": (_("Time"), Unit("min", 60.0), 0.0),
    "angle": (_("Angle of the table"), Unit("°", DEGREE), 0.0),
    "rate": (_("Rate"), Unit("°/s", DEGREE), 0.0),
    "attitude": (_("Angle of the axis from the vertical"), Unit("°", DEGREE), 0.0),
    "temperature": (_("Temperature"), Unit("°C", 1.0), ICE_POINT),
    "change": (_("Time"), Unit("min", 60.0), 0.0),
}


def beyond_noise(ratio: float, count: int) -> bool:
    """Whether an rms of so many residuals, over that of the noise, is more than chance makes it."""
    chance = MAX_CHANCE * np.sqrt(2 / count) if count else np.inf
    return bool(ratio > MIN_EXCESS_RATIO and ratio**2 > 1 + chance)


@dataclass(frozen=True)
class Residual:
    """Mean residuals of a sensor in one manoeuvre, of a rest in a few pieces.

    `mean`, `sigma`: (pieces, 3), and what noise alone would give.
    """

    manoeuvre: str
    mean: Array
    sigma: Array


@once
def mean_residuals(tables: Tables) -> dict[str, list[Residual]]:
    """By sensor, in the order of the plan: means over whole turns and over pieces of rests."""
    noise = {(r["manoeuvre"], r["channel"]): r["noise_rms"] for r in tables.rows("fidelity")}
    channels = [f"{sensor}_{axis}" for sensor in UNIT for axis in AXES]
    residuals = [f"residual_{name}" for name in channels]
    sums: dict[str, list[tuple[Array, Array]]] = {}  # of each manoeuvre sums and counts, (k, 6)
    for batch in tables.stream("simulated").columns(["manoeuvre", "phase", *residuals]):
        for name, own in batch.to_pandas().groupby("manoeuvre", sort=False):
            values = own[residuals].to_numpy(np.float64)
            counts = np.isfinite(values).astype(np.float64)
            if (own["phase"] != "rest").any():  # samples of a turn
                values = np.nansum(values, axis=0)[np.newaxis]
                counts = counts.sum(axis=0)[np.newaxis]
            sums.setdefault(str(name), []).append((values, counts))
    by_sensor: dict[str, list[Residual]] = {sensor: [] for sensor in UNIT}
    for name in tables.frame("manoeuvres")["manoeuvre"]:
        if name not in sums:
            continue
        values, counts = (np.concatenate(each) for each in zip(*sums[name], strict=True))
        pieces = [np.arange(len(values))] if (counts > 1).any() else pieces_of(len(values))
        totals, counts = (
            np.array([np.nansum(each[piece], axis=0) for piece in pieces])
            for each in (values, counts)
        )
        level = np.array([noise.get((name, each), np.nan) for each in channels], np.float64)
        with np.errstate(invalid="ignore", divide="ignore"):
            mean, sigma = totals / counts, level / np.sqrt(counts)
        for sensor, own in (("gyro", slice(3)), ("accel", slice(3, 6))):
            by_sensor[sensor].append(Residual(name, mean[:, own], sigma[:, own]))
    return by_sensor


def pieces_of(blocks: int) -> list[NDArray[np.int64]]:
    """The blocks of a rest in a few pieces of equal length."""
    return [piece for piece in np.array_split(np.arange(blocks), PIECES) if len(piece)]


def by_manoeuvre(tables: Tables, finding: Record, mount: str, key: str) -> Figure | None:
    """The residuals of each manoeuvre, and those of each axis without and with effects."""
    sensor = finding["sensor"] or ""
    mounts = {row["manoeuvre"]: row["mount"] for row in tables.rows("manoeuvres")}
    shown = [
        residual
        for residual in mean_residuals(tables).get(sensor, ())
        if np.isfinite(residual.mean).any()
        and (not mount or mounts.get(residual.manoeuvre) == mount)
    ]
    if not shown:
        return None
    changes = _changes(about_effect(gains(tables), finding["cause"], mount), sensor)
    caption = _(
        "Residuals of the {sensors} with the joint model: means over turns and over "
        "fifths of static positions, ± σ of the noise alone.",
        sensors=PLURAL[sensor],
    )
    if changes:
        scope = (
            _("held out")
            if any(row["scope"] == HELD_OUT for row in changes.values())
            else _("fitted")
        )
        caption += _(
            " Right: the residuals of each axis without (hollow) and with effects in "
            "the model (filled), root mean square over static positions and whole "
            "turns that were {scope}; dashed: noise alone.",
            scope=scope,
        )
    with drawing.style():
        drawn, panels = draw_by_manoeuvre(sensor, shown, beside=1.0 if changes else 0.0)
        if changes:
            _axes(panels[1], changes)
        picture = drawing.svg(drawn, key)
    words = _("Mean residuals of each manoeuvre, and residuals of each axis before and after.")
    return Figure(caption, picture, words)


def _changes(gain: Sequence[Record], sensor: str) -> dict[str, Record]:
    """By axis the row of the gain: on held-out data where there is one."""
    changes: dict[str, Record] = {}
    for scope in (FITTED, HELD_OUT):
        for row in gain:
            own, axis = row["sensor"], row["axis"] or ""
            known = None not in (row["rms_before"], row["rms_after"])
            if known and (own, row["scope"], row["unit"]) == (sensor, scope, "sigma"):
                changes[axis] = row
    return {axis: changes[axis] for axis in AXES if axis in changes}


def draw_by_manoeuvre(
    sensor: str, shown: Sequence[Residual], *, beside: float = 0.0, band: float = 0.0
) -> tuple[Drawn, list[Axes]]:
    """The residuals of each manoeuvre in a panel, with a second one for something else.

    `beside`: the width of the second; `band`: how many σ of noise are shaded.
    """
    named = len(shown) <= MOST_NAMES
    letters = max((columns_of(_name(residual)) for residual in shown), default=0)
    bottom = 0.2 + LETTER * letters if named else 0.4
    margins = drawing.Margins(top=0.2, bottom=bottom, left=0.5, across=0.5)
    drawn, panels = drawing.side_by_side([2.6, beside] if beside else [1.0], 1.35, margins)
    _manoeuvres(panels[0], sensor, shown, named, band)
    return drawn, panels


def _manoeuvres(
    panel: Axes, sensor: str, shown: Sequence[Residual], named: bool, band: float
) -> None:
    unit = UNIT[sensor]
    for number, residual in enumerate(shown if band else ()):
        edge = band * np.nanmax(residual.sigma) / unit.size
        panel.fill_between(
            [number - 0.46, number + 0.46], -edge, edge, color=drawing.RULE, linewidth=0.0
        )
    for column, axis in enumerate(AXES):
        for number, residual in enumerate(shown):
            pieces = len(residual.mean)
            within = (np.arange(pieces) + 0.5) / pieces - 0.5
            panel.errorbar(
                number + 0.8 * within + APART * (column - 1),
                residual.mean[:, column] / unit.size,
                yerr=residual.sigma[:, column] / unit.size,
                fmt=drawing.AXIS_MARK[axis],
                linestyle="-",
                linewidth=0.5,
                color=drawing.AXIS_COLOUR[axis],
                markersize=2.4,
                elinewidth=0.6,
                label="_" if number else axis,
            )
    panel.axhline(0, color=drawing.QUIET, linewidth=0.5)
    panel.set_title(_("Residual, {name}", name=unit.name), pad=4)
    panel.legend(loc="lower right", bbox_to_anchor=(1.0, 0.97), ncols=3, handletextpad=0.1)
    drawing.ticks(panel, 5)
    panel.set_xlim(-0.6, len(shown) - 0.4)
    if named:
        panel.set_xticks(range(len(shown)), list(map(_name, shown)), rotation=90)
    else:
        panel.set_xlabel(_("Manoeuvre, in the order of the plan"))


def _name(residual: Residual) -> str:
    return shortened(residual.manoeuvre, 12)


def _axes(panel: Axes, changes: dict[str, Record]) -> None:
    for axis, row in changes.items():
        line, colour = AXES.index(axis), drawing.AXIS_COLOUR[axis]
        before, after = row["rms_before"], row["rms_after"]
        panel.plot([before, after], [line, line], color=colour, linewidth=0.9)
        panel.plot(before, line, marker="o", color=colour, fillstyle="none", markersize=5)
        panel.plot(after, line, marker="o", color=colour, markersize=5)
    panel.axvline(1.0, color=drawing.QUIET, linewidth=0.7, dashes=(4, 2))
    panel.set_yticks(range(len(AXES)), list(AXES))
    panel.set_ylim(len(AXES) - 0.5, -0.5)
    panel.set_xlim(left=0.0)
    panel.xaxis.set_major_locator(MaxNLocator(5))
    panel.set_title(_("Without → with, σ"), pad=4)


# ---- structure


def structures(tables: Tables, finding: Record, mount: str, key: str) -> Iterator[Figure]:
    """The residuals of the sensor of a finding against what a test is about, the clearest first."""
    firing = [
        row
        for row in tables.rows("structures")
        if row["mount"] == mount and row["detected"] and row["sensor"] == finding["sensor"]
    ]
    firing.sort(key=lambda row: float(row["p_value"]))
    same = ("mount", "kind", "sensor", "axis")
    for number, row in enumerate(firing[:MOST_STRUCTURES], 1):
        own = [
            point
            for point in tables.rows("structure_points")
            if all(point[name] == row[name] for name in same)
        ]
        if own and row["kind"] in ALONG:
            yield _structure(row, own, f"{key}-structure-{number}")


def _structure(row: Record, points: Sequence[Record], key: str) -> Figure:
    along, at = TESTS[row["kind"]], place(row)
    where = f" ({at})" if at not in ("—", SMOOTH) else ""
    return Figure(
        _(
            "Residuals of the {channel} against {along}{where}: points ± σ, one for "
            "each bin of readings, all other terms as fitted; line: the structure "
            "that the test detects ({p_is}).",
            channel=channel(row),
            along=along,
            where=where,
            p_is=p_is(row["p_value"]),
        ),
        _draw_structure(row, points, key),
        _(
            "Residuals of the {row} against {along}, and the structure in them.",
            row=channel(row),
            along=along,
        ),
    )


def _draw_structure(row: Record, points: Sequence[Record], key: str) -> str:
    sensor, axis = row["sensor"], row["axis"]
    name, unit, zero = ALONG[row["kind"]]
    size = UNIT[sensor]
    points = sorted(points, key=lambda point: float(point["x"]))
    x, residual, sigma, structure = arrays(points, "x", "residual", "sigma", "structure")
    x = (x - zero) / unit.size
    with drawing.style():
        drawn, [panel] = drawing.side_by_side([1.0], 1.25, drawing.Margins(top=0.12, left=0.6))
        panel.errorbar(
            x,
            residual / size.size,
            yerr=sigma / size.size,
            fmt="o",
            color=drawing.AXIS_COLOUR.get(axis, drawing.QUIET),
            markersize=2.6,
            elinewidth=0.7,
            capsize=0,
        )
        panel.axhline(0, color=drawing.QUIET, linewidth=0.5)
        panel.plot(x, structure / size.size, color=drawing.INK, linewidth=1.1)
        # As high as the points that tell something: one of few readings does not stretch it.
        usual = sigma <= MAX_USUAL_SIGMAS * np.median(sigma)
        reach = (np.abs(residual[usual]) + sigma[usual], np.abs(structure))
        most = max(float(np.max(row, initial=0.0)) for row in reach) / size.size
        if most > 0:
            panel.set_ylim(-1.1 * most, 1.1 * most)
        drawing.ticks(panel, 5, 9)
        panel.set_ylabel(_("Residual, {name}", name=size.name), labelpad=2)
        panel.set_xlabel(f"{name}, {unit.name}")
        return drawing.svg(drawn, key)


# ---- Residuals of the result that counts: by manoeuvre with 3 σ, and as a histogram.

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
        "Effects of the table, the site or the mounting that are in the result are predicted, too; "
        "compensated readings still contain them. Left, fifths of each static position and whole "
        "steady rotations, with ±3 σ of white noise; right, the residuals of blocks and of seconds "
        "of rotation over their σ, of which noise alone leaves 0.3 % beyond 3; the outermost bins "
        "hold what is further out. Tilts of the positions are estimated with the result, and so is "
        "their azimuth where the table's heading is not known; in that case one direction of the "
        "gyros' residuals at rest is zero by the fit."
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
            "and the σ of the result are larger, are not in it, so that a ratio above 1 alone is "
            "not a finding."
        ),
        (
            Column(_("Sensor")),
            *columns("number", *headings, group=_("Static positions")),
            *columns("number", *headings, group=_("Steady rotation")),
        ),
        rows,
    )
