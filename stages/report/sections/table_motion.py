"""Studies of the table: its encoder against the gyros, and its angle against time."""

from collections.abc import Iterator, Sequence

from matplotlib.axes import Axes

from inertial.campaign.records import grouped
from inertial.text import numbers
from inertial.text.messages import _
from inertial.text.units import DEGREE, PPM, SECONDS_OF_ARC, Unit
from stages.report import drawing
from stages.report.outline import (
    Column,
    Equation,
    Figure,
    Heading,
    Paragraph,
    Part,
    Row,
    Table,
    more,
    table_row,
    value_and_sigma,
)
from stages.report.tables import Record, Tables, arrays

# ---- the encoder

QUANTITIES = {
    "scale": _("scale factor of the gyro less that of the encoder"),
    "delay": _("delay of the gyro less that of the encoder"),
    "spread": _("variance of this delay: 0 where gyro and encoder are only late"),
    "low_pass": _("time constant of the gyro's low pass of first order, with that variance"),
    "dead_time": _("dead time of the gyro less latency of the encoder"),
    "sine": _("error of the encoder, sine of {order:g} times its angle"),
    "cosine": _("error of the encoder, cosine of {order:g} times its angle"),
    "ripple": _("ripple of the drive, {order:g} periods in a turn, amplitude"),
}
UNITS = {
    "1": PPM,
    "rad": SECONDS_OF_ARC,
    "s": Unit("ms", 1e-3),
    "s²": Unit(_("ms²"), 1e-6),
}


def encoder_parts(tables: Tables) -> Iterator[Part]:
    """What all turns have in common, and turn by turn; nothing without an encoder."""
    rows = tables.rows("encoder")
    if not rows:
        return
    yield Heading(_("Encoder of the table"))
    common = [row for row in rows if row["manoeuvre"] is None]
    yield _table(_("The encoder of the table against the gyros, all turns together."), common)
    of_turns = [row for row in rows if row["manoeuvre"] and row["quantity"] not in COMMON]
    yield _table(_("Turn by turn."), of_turns)
    yield Paragraph(
        _(
            "A scale factor that all gyros have in common and one of the encoder are one unknown: "
            "all scale factors of this result rest on the encoder's. A delay is that of the gyro "
            "less that of the encoder, by the ramps of the rate. {apart} A ripple of the drive is "
            "seen by both, an error of the encoder by the gyros alone; windows by the encoder are "
            "corrected for the harmonics above.",
            apart=_apart(common),
        )
    )


COMMON = ("delay", "spread", "sine", "cosine")  # shown of all turns together


def _apart(common: Sequence[Record]) -> str:
    """What of the delay is told apart."""
    if any(row["quantity"] == "low_pass" for row in common):
        return _(
            "Its variance tells the low pass of the gyro from times by which something is read "
            "late; of these, the dead time of the gyro and the latency of the encoder, only the "
            "difference is known."
        )
    return _(
        "Low pass and dead time of the gyro and latency of the encoder are one class: their sum, "
        "the encoder's negative, is known, its parts are not, for the variance of the delay is not "
        "certain. Steeper ramps, or more of them, tell the low pass apart."
    )


def _table(caption: str, rows: Sequence[Record]) -> Table:
    return Table(
        caption,
        (
            Column(_("Turn"), "name"),
            Column(_("Quantity")),
            *value_and_sigma(unit=True),
            Column(_("p-value"), "number"),
        ),
        [_row(row) for row in rows],
        note=_("p-value: of a ripple, that there is none; of all turns, that they agree."),
    )


def _row(row: Record) -> Row:
    unit = UNITS[row["unit"]]
    sigma = unit.of(row["sigma"])
    return table_row(
        numbers.shortened(row["manoeuvre"] or _("all"), 60),
        QUANTITIES[row["quantity"]].format(order=row["order"] or 0),
        *numbers.with_own_sigma(unit.of(row["value"]), sigma),
        unit.name,
        numbers.probability(row["p_value"]),
    )


# ---- time and angle

MOST_TURNS = 9
MARGINS = drawing.Margins(left=0.45, across=0.4, down=0.3)
COLOUR = "#0072b2"
RAMPS = ((_("Spin-up"), "spin-up"), (_("Spin-down"), "spin-down"))
SET = (
    ("speed", DEGREE, "°/s"),
    ("spin-up acceleration", DEGREE, "°/s²"),
    ("spin-up seconds", 1.0, _("s a ramp")),
)
LIMITS = (
    _(
        "Use: the function gives the motion of the table between its ends, so its real speed and "
        "its ramps, for other gyros, for other turns and for marks at fixed angles. With the speed "
        "from turns about other axes the middle 180° become as good as their noise, whatever the "
        "set rate, if the table keeps the same speed in all turns."
    ),
    _(
        "Limits: with the angle of its own turn a window gives the scale factor of the "
        "whole turn again, since the gyro is compared with itself; the agreement shows "
        "only that nothing changed within the turn. If all gyros had the same scale "
        "error, the same logs would be those of a table that turned faster and further "
        "by that share: without the known whole angle a common scale factor and the "
        "table's speed are one unknown. An angle recorded by the table resolves this."
    ),
)


def time_and_angle(tables: Tables) -> Iterator[Part]:
    """The equation, a figure of what the angle differs by from what was set, speed and ramps."""
    turns = grouped(tables.rows("time_angle"), lambda row: row["manoeuvre"])
    if not turns:
        return
    yield Equation(
        "θ(t) = A · C(t) / C(T)",
        _("C: what the gyro along the axis summed, less bias and earth; A: the known whole angle."),
    )

    def draw(panel: Axes, name: str) -> None:
        _angle(panel, name, turns[name])

    names = list(turns)[:MOST_TURNS]
    rest = more(len(turns) - len(names), _(" in the table time_angle"))
    yield Figure(
        _(
            "Angle of the table less that of the set trapezoid, which is laid through the "
            "steady part, arcsec, and ± σ of the angle. σ is zero at the start and that of "
            "the known whole angle at the end. Light blue: the amplitude of motion that is "
            "faster than the line resolves. {rest}",
            rest=rest,
        ).rstrip(),
        drawing.grid(names, draw, 0.95, _("Time, s"), "time-angle", MARGINS),
        _("The table's angle against time, less the trapezoid that was set."),
    )
    yield from map(Paragraph, _sentences(turns, tables.rows("motions")))
    yield _motions(tables.rows("motions"))


def _angle(panel: Axes, name: str, rows: Sequence[Record]) -> None:
    time, angle, set_angle, sigma, swing = arrays(
        rows, "seconds", "angle", "set_angle", "sigma", "swing"
    )
    off, sigma, swing = (
        values / SECONDS_OF_ARC.size for values in (angle - set_angle, sigma, swing)
    )
    panel.axhline(0, color=drawing.INK, linewidth=0.6)
    drawing.around(panel, time, 0 * sigma, sigma, drawing.QUIET, 0.25)
    drawing.around(panel, time, off, swing, COLOUR, 0.3)
    panel.plot(time, off, color=COLOUR, linewidth=0.7)
    panel.set_title(f"{numbers.shortened(name, 26)}, {SECONDS_OF_ARC.name}", pad=3)
    drawing.ticks(panel, 4)


def _sentences(turns: dict[str, list[Record]], rows: Sequence[Record]) -> Iterator[str]:
    """The deviation of the table from its set rate, and how well its angle is known."""
    speeds = [row for row in rows if row["quantity"] == "speed" and row["set_value"]]
    if speeds:
        off = [(row["value"] / row["set_value"] - 1) / PPM.size for row in speeds]
        sigmas = [row["sigma"] / row["set_value"] / PPM.size for row in speeds]
        least, most, best, worst = (
            numbers.fixed(size, 1) for size in (min(off), max(off), min(sigmas), max(sigmas))
        )
        yield _(
            "In the steady part of {counted} the table deviated from its set rate by "
            "{least} to {most} ppm, with a σ of {best} to {worst} ppm in each. The scale "
            "factor of a window by time is in error by the same share.",
            counted=numbers.counted(len(speeds), "turn"),
            least=least,
            most=most,
            best=best,
            worst=worst,
        )
    sigma, name = max((row["sigma"], name) for name, own in turns.items() for row in own)
    angle, turn = numbers.significant(SECONDS_OF_ARC.of(sigma), 2), numbers.shortened(name, 30)
    yield _(
        "Between the ends of a turn the σ of the angle is at most {angle} arcsec "
        "({turn}); an oscillation of the case counts as motion.",
        angle=angle,
        turn=turn,
    )


def _motions(rows: Sequence[Record]) -> Table:
    turns: dict[str, dict[str, Record]] = {}
    for row in rows:
        turns.setdefault(row["manoeuvre"], {})[row["quantity"]] = row
    ramps: list[Column] = []
    quantities = ["speed"]
    for name, ramp in RAMPS:
        ramps += [*value_and_sigma(name, "s"), *value_and_sigma(name, "°/s²")]
        quantities += [f"{ramp} seconds", f"{ramp} acceleration"]
    return Table(
        _("Speed and ramps by time and angle; the ramps as if their acceleration were constant."),
        (Column(_("Turn"), "name"), *value_and_sigma(_("Speed"), "°/s"), *ramps),
        [
            table_row(numbers.shortened(turn, 40), *_cells(own, quantities))
            for turn, own in turns.items()
        ],
        note=_was_set(rows),
    )


def _cells(own: dict[str, Record], quantities: Sequence[str]) -> Iterator[str]:
    for quantity in quantities:
        row = own.get(quantity)
        if row is None:
            yield from ("—", "—")
        else:
            size = DEGREE if "rad" in row["unit"] else 1.0
            sigma = row["sigma"] / size
            yield from numbers.with_own_sigma(row["value"] / size, sigma)


def _was_set(rows: Sequence[Record]) -> str:
    """What was set, where it is the same for all turns."""
    settings = []
    for quantity, size, unit in SET:
        values = {row["set_value"] for row in rows if row["quantity"] == quantity}
        if len(values) == 1 and None not in values:
            settings.append(f"{numbers.significant(values.pop() / size, 4)} {unit}")
    return _("Set: {settings}.", settings=", ".join(settings)) if settings else ""
