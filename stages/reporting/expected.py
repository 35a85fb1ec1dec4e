"""What was found against what was expected, where a finding is about one number."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import pandas as pd
from matplotlib.axes import Axes

from inertial.text import numbers
from inertial.text.units import DEGREES, DEGREES_PER_SECOND
from stages.reporting.drawing import (
    INK,
    MISSING,
    QUIET,
    RULE,
    Margins,
    hatch_missing,
    side_by_side,
    style,
    svg,
)
from stages.reporting.outline import Figure
from stages.reporting.rows import Record, records

BAR = 0.62  # of the distance between bars
SIDES = (-0.5, 1.5)  # of the panel, in which the bars are at 0 and 1
LOWEST, HIGHEST = 0.25 - BAR / 4, 0.25 + BAR / 4  # of the lower bar, in shares of the panel
NEAR = (
    0.2  # relative: numbers that differ by less are dots on a scale of their own, not bars from 0
)
OF_RATE = frozenset({"wrong_rate", "wrong_direction"})
SIGMA = "σ"
NOISE_ALONE = 1.0  # what residuals are, in their sigma, where nothing is wrong


@dataclass(frozen=True)
class Stated:
    """What the campaign says of itself: gravity, m/s², and sample rate, Hz; or none."""

    gravity: float | None
    rate: float | None


@dataclass(frozen=True)
class Compared:
    """Two numbers in one unit; `missing` is what the second lacks of the first, if it is told."""

    quantity: str
    unit: str
    expected: float
    found: float
    missing: float = 0.0

    @property
    def near(self) -> bool:
        """Whether bars from 0 would look alike."""
        return abs(self.found - self.expected) < NEAR * abs(self.expected) and not self.missing


def stated(known: pd.DataFrame, rate: float | None) -> Stated:
    """What is taken as known of gravity, and the rate of the campaign."""
    values = {row["quantity"]: row["value"] for row in records(known)}
    return Stated(values.get("gravity"), rate)


def compared(
    row: Record,
    manoeuvres: Mapping[str, Record],
    performed: Mapping[str, Record],
    campaign: Stated,
) -> Compared | None:
    """The two numbers that a finding is about; none where it is not about such."""
    plan, done = manoeuvres.get(row["manoeuvre"], {}), performed.get(row["manoeuvre"], {})
    cause, size = row["cause"], row["size"]
    if cause == "incomplete_turn" and plan.get("angle") and done.get("angle"):
        angles = (plan["angle"], done["angle"], done.get("missing_angle") or 0.0)
        return Compared("angle", "°", *(float(DEGREES.of(angle) or 0.0) for angle in angles))
    if cause in OF_RATE and plan.get("rate") and done.get("rate"):
        rates = (plan["rate"], done["rate"])
        return Compared(
            "rate", "°/s", *(float(DEGREES_PER_SECOND.of(rate) or 0.0) for rate in rates)
        )
    if size is None:
        return None
    if cause == "unexplained":
        return Compared("residuals", SIGMA, NOISE_ALONE, size)
    if cause == "rate_off" and campaign.rate:
        return Compared("samples per second", "Hz", campaign.rate, campaign.rate * size)
    gravity = campaign.gravity
    if cause == "wrong_scale_factor" and row["sensor"] == "accel" and gravity:
        return Compared("specific force at rest", "m/s²", gravity, gravity * size)
    if cause == "gravity_error" and gravity:
        return Compared("gravity", "m/s²", gravity - size, gravity)
    return None


def figure(shown: Compared, key: str) -> Figure:
    """Two bars, one below the other; or two dots, where bars would look alike."""
    expected, found = (_written(value, shown) for value in (shown.expected, shown.found))
    lacking = ""
    if shown.missing:
        lacking = f" Hatched: {_written(shown.missing, shown)} not recorded."
    caption = f"{shown.quantity.capitalize()}: {found} found, {expected} expected.{lacking}"
    return Figure(caption, _draw(shown, (expected, found), key), caption)


def _written(value: float, shown: Compared) -> str:
    digits = 7 if shown.near else 2 if shown.unit == SIGMA else 4
    return f"{numbers.significant(value, digits)} {shown.unit}".replace(" °", "°")


def _draw(shown: Compared, texts: tuple[str, str], key: str) -> str:
    with style():
        drawn, (panel,) = side_by_side((1.0,), 0.36, Margins(left=0.75, right=1.2, top=0.06))
        if shown.near:
            _dots(panel, shown)
        else:
            _bars(panel, shown)
        panel.set_yticks([1, 0], ["expected", "found"])
        panel.set_ylim(*SIDES)
        for side, text in zip((1, 0), texts, strict=True):
            panel.annotate(
                text,
                (1.0, side),
                xycoords=("axes fraction", "data"),
                xytext=(4, 0),
                textcoords="offset points",
                va="center",
            )
        panel.set_xlabel(f"{shown.quantity}, {shown.unit}")
        panel.grid(visible=False, axis="y")
        return svg(drawn, key)


def _bars(panel: Axes, shown: Compared) -> None:
    panel.barh([1, 0], [shown.expected, shown.found], BAR, color=[RULE, QUIET])
    if shown.missing:
        hatch_missing(panel, shown.found, shown.found + shown.missing, ymin=LOWEST, ymax=HIGHEST)
    panel.axvline(0, color=INK, linewidth=0.6)
    ends = (shown.expected, shown.found, shown.found + shown.missing, 0.0)
    panel.set_xlim(min(ends), max(ends))
    if shown.expected < 0:
        panel.invert_xaxis()  # what was expected runs to the right


def _dots(panel: Axes, shown: Compared) -> None:
    for side, value, colour in ((1, shown.expected, QUIET), (0, shown.found, MISSING)):
        panel.axvline(value, color=colour, linewidth=0.5, dashes=(3, 3))
        panel.plot([value], [side], "o", color=colour, markersize=5)
    panel.margins(x=0.3)
    panel.ticklabel_format(axis="x", useOffset=False, style="plain")
