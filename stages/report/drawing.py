"""How a figure is drawn: colours, type and lines, and the SVG that goes into the page.

The same figure gives the same bytes on every machine: letters are set in
matplotlib's own DejaVu Sans, which the page brings along, and neither a date nor
a random identifier enters.
"""

import io
import re
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, MaxNLocator, NullLocator
from numpy.typing import NDArray

from inertial.tables import STATIC_PHASES
from inertial.text.messages import language
from inertial.text.typography import typeset
from inertial.text.units import DEGREES_PER_HOUR, DEGREES_PER_SECOND, METRES, MILLIMETRES, Unit
from stages.report.tables import Record

Array = NDArray[np.float64]

LETTERS = re.compile(r"(<text[^>]*>)([^<]*)")
WIDTH = 7.1  # inches: the text width of the printed page

INK = "#1f2933"
QUIET = "#5f6c7b"
RULE = "#d5dbe2"
# Okabe and Ito, "Color Universal Design" (2008): distinct with every kind of colour vision.
AXIS_COLOUR = {"x": "#d55e00", "y": "#009e73", "z": "#0072b2"}
AXIS_MARK = {"x": "o", "y": "s", "z": "^"}
PHASE_COLOUR = {
    "rest": "#e6eaef",
    "spin-up": "#fbe3b8",
    "steady": "#dcecf8",
    "spin-down": "#fbe3b8",
    "settling": "#fbe3b8",
}
GRID_COLUMNS = 3
COLUMN_GAP = 0.06  # inches to the right of a column of panels that belong to it
SMALL_RATE = 0.2 * DEGREES_PER_SECOND.size
MISSING = "#8e2a5b"
MASKED = "#7d8894"

_STYLE: Any = {
    "axes.axisbelow": True,
    "axes.edgecolor": QUIET,
    "axes.grid": True,
    "axes.labelcolor": INK,
    "axes.labelsize": 7.5,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.titlelocation": "left",
    "axes.titlepad": 4,
    "axes.titlesize": 7.5,
    "axes.titley": 1.0,  # titles stand still, which saves measuring every label
    "axes.unicode_minus": True,
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "grid.color": RULE,
    "grid.linewidth": 0.4,
    "hatch.linewidth": 0.4,
    "legend.fontsize": 7,
    "legend.frameon": False,
    "lines.linewidth": 1.0,
    "patch.linewidth": 0.0,
    "svg.fonttype": "none",  # letters stay letters: searchable, and light
    "text.color": INK,
    "text.parse_math": False,  # a name may hold a dollar sign
    "xtick.color": QUIET,
    "xtick.labelsize": 7,
    "xtick.major.size": 2.5,
    "xtick.major.width": 0.5,
    "xtick.minor.size": 1.5,
    "xtick.minor.width": 0.4,
    "ytick.color": QUIET,
    "ytick.labelsize": 7,
    "ytick.major.size": 2.5,
    "ytick.major.width": 0.5,
    "ytick.minor.size": 1.5,
    "ytick.minor.width": 0.4,
}


@contextmanager
def style() -> Iterator[None]:
    """Draw within this: the report's type, lines and colours, whatever matplotlibrc says."""
    with mpl.rc_context(), warnings.catch_warnings():
        # A name may hold letters that the font lacks; they are drawn as boxes.
        warnings.filterwarnings("ignore", message="Glyph .* missing from font")
        mpl.rcdefaults()
        mpl.rcParams.update(_STYLE)
        yield


@dataclass(frozen=True)
class Margins:
    """Space around and between panels, inches."""

    left: float = 0.46
    right: float = 0.1
    top: float = 0.22
    bottom: float = 0.4
    across: float = 0.62
    down: float = 0.24


def panels(
    rows: int, columns: int, height: float, margins: Margins, *, sharex: bool = True
) -> tuple[Figure, list[list[Axes]]]:
    """An empty figure of panels, row by row; `height` of one panel in inches."""
    total = margins.top + rows * height + (rows - 1) * margins.down + margins.bottom
    figure = Figure(figsize=(WIDTH, total))
    FigureCanvasSVG(figure)
    width = (WIDTH - margins.left - margins.right - (columns - 1) * margins.across) / columns
    figure.subplots_adjust(
        left=margins.left / WIDTH,
        right=1 - margins.right / WIDTH,
        top=1 - margins.top / total,
        bottom=margins.bottom / total,
        wspace=margins.across / width,
        hspace=margins.down / height,
    )
    axes = figure.subplots(rows, columns, sharex=sharex, squeeze=False)
    return figure, [list(row) for row in axes]


def side_by_side(
    widths: Sequence[float], height: float, margins: Margins
) -> tuple[Figure, list[Axes]]:
    """An empty figure of panels in one row, whose widths are as `widths` to each other."""
    total = margins.top + height + margins.bottom
    figure = Figure(figsize=(WIDTH, total))
    FigureCanvasSVG(figure)
    room = WIDTH - margins.left - margins.right - (len(widths) - 1) * margins.across
    axes = []
    left = margins.left
    for share in widths:
        width = room * share / sum(widths)
        place = (left / WIDTH, margins.bottom / total, width / WIDTH, height / total)
        axes.append(figure.add_axes(place))
        left += width + margins.across
    return figure, axes


GRID_MARGINS = Margins(left=0.45, across=0.5, down=0.3)


def grid(
    names: Sequence[str],
    draw: Callable[[Axes, str], None],
    height: float,
    label: str,
    key: str,
    margins: Margins = GRID_MARGINS,
) -> str:
    """A panel for each name, three in a row, `label` below the lowest of each column."""
    lines = -(-len(names) // GRID_COLUMNS)
    with style():
        figure, axes = panels(lines, GRID_COLUMNS, height, margins)
        each = [panel for line in axes for panel in line]
        for panel, name in zip(each, names, strict=False):
            draw(panel, name)
        for panel in each[len(names) :]:
            panel.set_visible(False)
        for panel in each[max(0, len(names) - GRID_COLUMNS) : len(names)]:
            panel.tick_params(labelbottom=True)
            panel.set_xlabel(label)
        return svg(figure, key)


def band(
    panel: Axes, x: Sequence[float] | Array, low: Array, high: Array, colour: str, **look: Any
) -> None:
    """The area from `low` to `high`."""
    panel.fill_between(x, low, high, color=colour, **{"linewidth": 0.5} | look)


def around(
    panel: Axes, x: Sequence[float] | Array, value: Array, sigma: Array, colour: str, alpha: float
) -> None:
    """The area within ± σ of a value."""
    band(panel, x, value - sigma, value + sigma, colour, alpha=alpha, linewidth=0)


def ticks(panel: Axes, y: int, x: int | None = None) -> None:
    """At most so many ticks on each axis."""
    panel.yaxis.set_major_locator(MaxNLocator(y))
    if x is not None:
        panel.xaxis.set_major_locator(MaxNLocator(x))


def readable(sensor: str, largest: float, most_per_hour: float = SMALL_RATE) -> Unit:
    """The unit in which the largest of some readings, rad/s or m/s², has few digits."""
    if sensor == "gyro":
        return DEGREES_PER_HOUR if largest < most_per_hour else DEGREES_PER_SECOND
    return MILLIMETRES if largest < 1.0 else METRES


def name_axis(panel: Axes, axis: str, text: str = "") -> None:
    """The axis of the sensor, in its colour, above a panel."""
    panel.set_title(text or axis, loc="right", color=AXIS_COLOUR[axis], fontsize=6.5, pad=2)


def write_inside(panel: Axes, text: str) -> None:
    """Why a panel is empty."""
    panel.annotate(
        text, (0.5, 0.5), xycoords="axes fraction", ha="center", va="center", color=QUIET
    )


def plain_numbers(axis: Axis) -> None:
    """Tick labels of a logarithmic axis as plain numbers, at 1, 2 and 5 of a decade."""
    axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0), numticks=12))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))


def svg(figure: Figure, key: str) -> str:
    """`figure` as an element of the page; `key`, a plain word, keeps its identifiers apart.

    Behind it stands each of its columns of panels alone, for screens that are too narrow for all.
    """
    text = io.StringIO()
    with mpl.rc_context({"svg.hashsalt": key}):
        nothing = dict.fromkeys(("Date", "Creator", "Format", "Type"))
        figure.savefig(text, format="svg", metadata=nothing, transparent=True)
    drawn = LETTERS.sub(lambda part: part[1] + typeset(part[2]), light(text.getvalue(), key))
    edges = _columns(figure)
    if len(edges) < 3:
        return drawn
    name = f"{key.replace(' ', '-')}-whole"
    points = 72 * figure.get_size_inches()
    size = f'width="{points[0]:g}" height="{points[1]:g}"'
    columns = [
        f'<svg class="column" aria-hidden="true" viewBox="{left * points[0]:.1f} 0 '
        f'{(right - left) * points[0]:.1f} {points[1]:g}"><use href="#{name}" {size}/></svg>'
        for left, right in pairwise(edges)
    ]
    return drawn.replace("<svg ", f'<svg class="whole" id="{name}" ', 1) + "".join(columns)


def _columns(figure: Figure) -> list[float]:
    """The edges of the columns of panels, labels to their left, as shares of the width."""
    spans = sorted(
        (panel.get_position().x0, panel.get_position().x1)
        for panel in figure.axes
        if panel.get_visible()
    )
    ends: list[float] = []
    for left, right in spans:
        if ends and left < ends[-1]:
            ends[-1] = max(ends[-1], right)
        else:
            ends.append(right)
    return [0.0, *(end + COLUMN_GAP / WIDTH for end in ends[:-1]), 1.0]


def shade(axes: Axes, phases: Sequence[Record], start: str = "start", end: str = "end") -> None:
    """Mark the phases of the table behind the curves; `start`, `end`: the keys of their span."""
    for row in phases:
        phase = "rest" if row["phase"] in STATIC_PHASES else row["phase"]
        colour = PHASE_COLOUR.get(phase, RULE)
        axes.axvspan(row[start], row[end], color=colour, zorder=0, linewidth=0)


def hatch_missing(
    axes: Axes, start: float, end: float, *, ymin: float = 0.0, ymax: float = 1.0
) -> None:
    """Mark a stretch that was not recorded; between heights in shares of the panel."""
    axes.axvspan(
        start,
        end,
        ymin,
        ymax,
        facecolor="#f6ebf1",
        edgecolor=MISSING,
        hatch="///",
        linewidth=0.6,
        zorder=3,
    )


def hatch_masked(axes: Axes, start: float, end: float) -> None:
    """Mark a stretch that was recorded but is not used."""
    axes.axvspan(
        start, end, facecolor="#ffffff", edgecolor=MASKED, hatch="xxxx", linewidth=0.4, zorder=1
    )


def mark_place(axes: Axes, start: float, end: float) -> None:
    """Mark a place in a curve: a band, and above it a wedge for where it is narrow."""
    axes.axvspan(start, end, color=MISSING, alpha=0.18, linewidth=0.8, zorder=1.5)
    axes.plot(
        (start + end) / 2,
        1.0,
        marker="v",
        markersize=4.5,
        color=MISSING,
        transform=axes.get_xaxis_transform(),
        clip_on=False,
        zorder=5,
    )


# ---- A figure of matplotlib's as an element of the page, of no more parts than it needs.
#
# Every part costs time where the page is shown, and three times where it becomes a PDF.

# The last ones of the machine: a page does not bring Chinese letters along.
FAMILIES = (
    "Report, 'Report Chinese', 'Noto Sans CJK SC', 'Source Han Sans SC', 'PingFang SC', "
    "'Microsoft YaHei', 'WenQuanYi Micro Hei', sans-serif"
    if language() == "zh"
    else "Report"
)
NUMBER = r"-?\d+(?:\.\d+)?"
# A straight line; a mark that is one; and where the mark stands.
LINE = rf"M {NUMBER} {NUMBER}L {NUMBER} {NUMBER}"
DRAWN = re.compile(
    rf'<path d="({LINE})"((?: clip-path="[^"]*")?) style="(fill: none; stroke: [^"]*)"/>'
)
MARK = re.compile(rf'<path id="([^"]+)" d="({LINE})" style="([^"]*)"/>')
USED = re.compile(rf'<use xlink:href="#([^"]+)" x="({NUMBER})" y="({NUMBER})"/>')
BETWEEN = ("<text", "<use", "<defs", "</defs", "<path id=")  # lines that are joined
INVISIBLE = re.compile(r'<path d="[^"]*" style="fill: none"/>\n')


def light(drawn: str, key: str) -> str:
    """The svg element alone, without comments, with short numbers and identifiers of its own.

    `drawn`: a file of matplotlib's; `key`: a plain word that the identifiers begin with.
    """
    element = drawn[drawn.index("<svg") :]
    for left_out in (r"<!--.*?-->", r"<metadata>.*?</metadata>", r"<style.*?</style>"):
        element = re.sub(left_out, "", element, flags=re.DOTALL)
    element = element.replace("'DejaVu Sans'", FAMILIES).replace("rotate(-0 ", "rotate(0 ")
    element = re.sub(r' transform="rotate\(0 [^"]*"', "", element)
    used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', element))
    element = re.sub(
        r' id="([^"]+)"', lambda m: f' id="{key}-{m[1]}"' if m[1] in used else "", element
    )
    element = re.sub(r'(href="#|url\(#)', rf"\1{key}-", element)
    element = _without_idle_groups(element).replace("<defs>\n</defs>", "")
    element = _rounded(_styled_once(element))
    return _joined(re.sub(r"\n\s*", "\n", element).strip())


def _without_idle_groups(element: str) -> str:
    """Groups that say nothing about what is in them left out; they are most of the elements."""
    open_groups: list[bool] = []

    def tag(match: re.Match[str]) -> str:
        if match[0].endswith("/>"):  # empty: of a line without points
            return ""
        if match[0].startswith("</"):
            return match[0] if open_groups.pop() else ""
        open_groups.append(match[0] != "<g>")
        return match[0] if open_groups[-1] else ""

    return re.sub(r"<g( [^>]*)?>|</g>", tag, element)


def _styled_once(element: str) -> str:
    """The style of a mark where it is defined, not wherever it is used, if it is but one."""
    styles: dict[str, set[str]] = {}
    for mark, style in re.findall(r'<use xlink:href="#([^"]+)"[^>]* style="([^"]*)"/>', element):
        styles.setdefault(mark, set()).add(style)
    moved: set[str] = set()

    def definition(match: re.Match[str]) -> str:
        own = styles.get(match[2], set())
        if len(own) != 1:
            return match[0]
        moved.add(match[2])
        # What the definition says itself counts for more, as it did.
        return f'{match[1]}{own.pop()}; {match[3]}"'

    def use(match: re.Match[str]) -> str:
        return f"{match[1]}/>" if match[2] in moved else match[0]

    element = re.sub(r'(<path id="([^"]+)"[^>]* style=")([^"]*)"', definition, element)
    return re.sub(r'(<use xlink:href="#([^"]+)"[^>]*?) style="[^"]*"/>', use, element)


def _rounded(element: str) -> str:
    """Coordinates to a hundredth of a point, finer than any printer, with no needless space."""

    def path(match: re.Match[str]) -> str:
        short = re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}", match[2])
        return match[1] + re.sub(r"\s*\n\s*", "", short) + '"'

    return re.sub(r'( (?:d|x|y)=")([^"]*)"', path, element)


def _joined(element: str) -> str:
    """Straight lines of one look as one path: grids, and the marks of axes.

    Names and marks may stand between them, nothing else, so that nothing is drawn over another.
    """
    element = INVISIBLE.sub("", element)
    marks = {name: (course, style) for name, course, style in MARK.findall(element)}
    parts: list[str] = []
    begun: dict[tuple[str, str], tuple[int, list[str]]] = {}

    def end() -> None:
        for (clip, style), (place, courses) in begun.items():
            parts[place] = f'<path d="{"".join(courses)}"{clip} style="{style}"/>'
        begun.clear()

    for part in element.split("\n"):
        if line := _line(part, marks):
            course, *look = line
            if (key := (look[0], look[1])) not in begun:
                begun[key] = (len(parts), [])
                parts.append("")
            begun[key][1].append(course)
            continue
        if not part.startswith(BETWEEN):
            end()
        parts.append(part)
    end()
    return _without_idle_marks("\n".join(parts))


def _line(part: str, marks: dict[str, tuple[str, str]]) -> tuple[str, str, str] | None:
    """Course, clip and style of a straight line, or of a mark that is one, where it stands."""
    if (drawn := DRAWN.fullmatch(part)) and "dasharray" not in part and "opacity" not in part:
        return drawn[1], drawn[2], drawn[3]
    if (used := USED.fullmatch(part)) and used[1] in marks:
        course, style = marks[used[1]]
        numbers = [float(number) for number in re.findall(NUMBER, course)]
        x, y = float(used[2]), float(used[3])
        from_x, from_y, to_x, to_y = (
            f"{number + shift:.2f}".removesuffix(".00")
            for number, shift in zip(numbers, (x, y, x, y), strict=True)
        )
        return f"M {from_x} {from_y}L {to_x} {to_y}", "", style
    return None


def _without_idle_marks(element: str) -> str:
    """Definitions of marks that nothing uses any more left out."""
    used = set(re.findall(r'href="#([^"]+)"', element))
    kept = [
        part
        for part in element.split("\n")
        if not (mark := MARK.fullmatch(part)) or mark[1] in used
    ]
    return "\n".join(kept).replace("<defs>\n</defs>\n", "")
