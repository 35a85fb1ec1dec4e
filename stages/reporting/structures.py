"""Whether what the model leaves has a structure: the six tests, and a picture of what they see."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from inertial.text import numbers
from inertial.text.units import DEGREE, DEGREES_PER_HOUR, MICRO_G, Unit
from stages.reporting.certainty import listed
from stages.reporting.drawing import AXIS_COLOUR, INK, QUIET, Margins, side_by_side, style, svg
from stages.reporting.outline import Column, Figure, Paragraph, Part, Row, Table
from stages.reporting.rows import Record

MOST_FIGURES = 3
WIDE = 3.0  # usual sigmas from which a point does not stretch the picture
SENSOR = {"gyro": "gyro", "accel": "accelerometer"}
LEFT = {"gyro": DEGREES_PER_HOUR, "accel": MICRO_G}
ICE_POINT = 273.15  # K
COUNTS = ("no", "one", "two", "three", "four", "five", "six")
# What each test is for, what a picture of it goes along, its unit, and where that begins in SI.
ALONG = {
    "time": ("time", "Time", Unit("min", 60.0), 0.0),
    "angle": ("the angle of the table", "Angle of the table", Unit("°", DEGREE), 0.0),
    "rate": ("the rate of the turns", "Rate", Unit("°/s", DEGREE), 0.0),
    "attitude": ("the attitude", "Angle of the axis from upright", Unit("°", DEGREE), 0.0),
    "temperature": ("the temperature", "Temperature", Unit("°C", 1.0), ICE_POINT),
    "change": ("a change in time", "Time", Unit("min", 60.0), 0.0),
}


def tests(rows: Sequence[Record]) -> Iterator[Part]:
    """The six tests of each mount: in a line where they are silent, else as a table."""
    for method in dict.fromkeys(row["method"] for row in rows):
        own = [row for row in rows if row["method"] == method]
        mount = numbers.shortened(method.partition("@")[2], 60)
        where = f" (mount {mount})" if mount else ""
        if any(row["fires"] for row in own):
            yield _table(own, where)
        else:
            yield Paragraph(
                _silent(own, where), "good" if any(row["degrees"] for row in own) else ""
            )


def _silent(rows: Sequence[Record], where: str) -> str:
    asked = [row for row in rows if row["degrees"]]
    if not asked:
        return f"No test for structure in what is left could be asked{where}."
    least = min(asked, key=lambda row: float(row["p_value"]))
    kinds = listed([_kind(row) for row in rows])
    said = (
        f"{_count(rows)} tests for structure in what the model and the named effects leave{where}, "
        f"against {kinds}: none fires, smallest {numbers.p_is(least['p_value'])} "
        f"({_kind(least)}, {channel(least)})."
    )
    if idle := [_kind(row) for row in rows if not row["degrees"]]:
        said += f" Not asked against {listed(idle)}, for there is none in the recording."
    return said


def _count(rows: Sequence[Record]) -> str:
    return COUNTS[len(rows)].capitalize() if len(rows) < len(COUNTS) else str(len(rows))


def _table(rows: Sequence[Record], where: str) -> Table:
    """The tests, those that fire first."""
    rows = sorted(rows, key=lambda row: (not row["fires"], row["p_value"]))
    return Table(
        f"{_count(rows)} tests for structure in what the model and the named effects leave{where}. "
        "By chance any of them fires in one campaign of a hundred.",
        (
            Column("Against"),
            Column("Clearest in"),
            Column("Place"),
            Column("χ² drops by", "number"),
            Column("p", "number"),
            Column(""),
        ),
        tuple(
            Row(
                (_kind(row).capitalize(), channel(row), _place(row), *_numbers(row)),
                tone="fair" if row["fires"] else "",
            )
            for row in rows
        ),
    )


def _numbers(row: Record) -> tuple[str, str, str]:
    if not row["degrees"]:
        return "—", "—", "not recorded"
    p_value = numbers.probability(row["p_value"])
    return numbers.significant(row["statistic"]), p_value, "fires" if row["fires"] else "silent"


def _kind(row: Record) -> str:
    return ALONG.get(row["kind"], (numbers.shortened(row["kind"], 30),))[0]


def channel(row: Record) -> str:
    """Sensor and axis in words: x gyro."""
    sensor, _, axis = row["channel"].partition(" ")
    return f"{axis} {SENSOR.get(sensor, sensor)}" if axis else "—"


def _place(row: Record) -> str:
    place = row["place"]
    if place is None or not row["degrees"]:
        return "—"
    if row["kind"] == "change":
        return f"at {numbers.fixed(place / 60, 1)} min"
    if row["kind"] == "angle":
        return f"{numbers.significant(place, 3)} times in a turn" if place > 0 else "smooth"
    if row["kind"] == "time":
        return f"every {numbers.significant(1 / place, 3)} s" if place > 0 else "smooth"
    return "—"


def figures(
    finding: Record, mount: str, rows: Sequence[Record], points: Sequence[Record], key: str
) -> Iterator[Figure]:
    """What is left of the sensor of a finding along what a test sees, the clearest tests first."""
    method = f"joint@{mount}" if mount else "joint"
    firing = [
        row
        for row in rows
        if row["method"] == method
        and row["fires"]
        and row["channel"].split(" ")[0] == finding["sensor"]
    ]
    firing.sort(key=lambda row: float(row["p_value"]))
    for number, row in enumerate(firing[:MOST_FIGURES], 1):
        own = [
            point
            for point in points
            if all(point[name] == row[name] for name in ("method", "kind", "channel"))
        ]
        if own and row["kind"] in ALONG:
            yield _figure(row, own, f"{key}-structure-{number}")


def _figure(row: Record, points: Sequence[Record], key: str) -> Figure:
    along = ALONG[row["kind"]][0]
    at = _place(row)
    where = f" ({at})" if at not in ("—", "smooth") else ""
    return Figure(
        f"What is left of the {channel(row)} against {along}{where}: points ± σ, each bin of "
        f"readings by itself, all else as fitted; line: the structure that the test sees "
        f"({numbers.p_is(row['p_value'])}).",
        _draw(row, points, key),
        f"Residuals of the {channel(row)} against {along}, and the structure in them.",
    )


def _draw(row: Record, points: Sequence[Record], key: str) -> str:
    sensor, _, axis = row["channel"].partition(" ")
    _, name, unit, zero = ALONG[row["kind"]]
    size = LEFT[sensor]
    points = sorted(points, key=lambda point: float(point["x"]))
    x, left, sigma, structure = (
        np.array([point[column] for point in points], np.float64)
        for column in ("x", "left", "sigma", "structure")
    )
    x = (x - zero) / unit.size
    with style():
        drawn, [panel] = side_by_side([1.0], 1.25, Margins(top=0.12, left=0.6))
        panel.errorbar(
            x,
            left / size.size,
            yerr=sigma / size.size,
            fmt="o",
            color=AXIS_COLOUR.get(axis, QUIET),
            markersize=2.6,
            elinewidth=0.7,
            capsize=0,
        )
        panel.axhline(0, color=QUIET, linewidth=0.5)
        panel.plot(x, structure / size.size, color=INK, linewidth=1.1)
        _frame(panel, left, sigma, structure, size)
        panel.set_ylabel(f"Left, {size.name}", labelpad=2)
        panel.set_xlabel(f"{name}, {unit.name}")
        return svg(drawn, key)


def _frame(
    panel: Axes, left: np.ndarray, sigma: np.ndarray, structure: np.ndarray, size: Unit
) -> None:
    """As high as the points that tell something: one of few readings does not stretch it."""
    usual = sigma <= WIDE * np.median(sigma)
    reach = [np.abs(left[usual]) + sigma[usual], np.abs(structure)]
    most = max(float(np.max(one, initial=0.0)) for one in reach) / size.size
    if most > 0:
        panel.set_ylim(-1.1 * most, 1.1 * most)
    panel.yaxis.set_major_locator(MaxNLocator(5))
    panel.xaxis.set_major_locator(MaxNLocator(9))
