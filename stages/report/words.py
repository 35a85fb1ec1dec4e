"""Names of sensors, mounts and counts, and how they stand in a sentence."""

import re
from math import pi

from inertial.sensors import SINGULAR
from inertial.text import units
from inertial.text.messages import ENGLISH, _, language
from inertial.text.numbers import counted, plus_minus, shortened, significant
from inertial.text.parameters import PARTS
from stages.report.tables import Record

SENSOR_OF_STAGE = {"accelerometer": _("Accelerometer"), "gyroscope": _("Gyro")}
KINDS = {
    "bias": _("bias"),
    "scale": _("scale"),
    "cross": _("cross"),
    "mounting": _("mounting"),
    "symmetric": _("symmetric"),
}
# What tables say in a word, as a sentence has it.
TERMS = {
    "accelerometer triad": _("axes square to each other, nearest to the accelerometers'"),
    "as the gyros have it": _("as the gyros have it"),
    "at rest": _("at rest"),
    "amplitude": _("amplitude"),
    "blank": _("blank"),
    "body": _("case"),  # its axes
    "compensated": _("compensated"),
    "decoded": _("decoded"),
    "frequency": _("frequency"),
    "east": _("east"),
    "format": _("the format of the logs"),
    "gravity": _("gravity"),
    "instrument": _("the type of the instrument"),
    "latitude": _("latitude"),
    "header": _("header"),
    "north": _("north"),
    "not selected": _("not selected"),
    "other message": _("other message"),
    "period": _("period"),
    "plan": _("the plan"),
    "quarter": _("quarter"),
    "refused": _("refused"),
    "recorded": _("recorded"),
    "rest": _("rest"),
    "rest-after": _("rest-after"),
    "rest-before": _("rest-before"),
    "sensor triad": _("sensor triad"),
    "site": _("the site with its gravity"),
    "settling": _("settling"),
    "spin-down": _("spin-down"),
    "spin-up": _("spin-up"),
    "steady": _("steady"),
    "trapezoid": _("trapezoid"),
    "table": _("the table and its uncertainty"),
    "time": _("time"),
    "turn": _("turn"),
    "unknown": _("unknown"),
}
PHASE = re.compile(r"\((rest-before|rest-after|spin-up|steady|spin-down|settling)\)")
COUNTS = ("no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten")


def phases_in_words(text: str) -> str:
    """A text with names of manoeuvres, each phase in brackets behind them as a term."""
    return PHASE.sub(lambda phase: f"({term(phase[1])})", text)


def parameter(sensor: str, quantity: str) -> str:
    """A parameter of a sensor in words: gyro, scale x."""
    if quantity not in PARTS:
        return f"{SINGULAR[sensor]} {quantity}"
    kind, axes = PARTS[quantity]
    return _("{sensor}, {kind} {axes}", sensor=SINGULAR[sensor], kind=KINDS[kind], axes=axes)


def with_mount(name: str, mount: str | None) -> str:
    """A name with the mount it is of, where there are several."""
    return _("{name} (mount {mount})", name=name, mount=shortened(mount, 60)) if mount else name


def count_in_words(count: int) -> str:
    """A small count as a word, where it is usual."""
    return COUNTS[count] if count < len(COUNTS) and language() == ENGLISH else str(count)


def term(word: str) -> str:
    """A word of the tables as it is read."""
    return TERMS.get(word, word)


def sensor_of_stage(stage: str) -> str:
    """The sensor that a stage estimates."""
    return SENSOR_OF_STAGE.get(stage, stage)


def plain(parameter: str) -> str:
    """bias_x as it is read: bias x."""
    kind, _underscore, axes = parameter.partition("_")
    return " ".join(filter(None, (KINDS.get(kind, kind), axes.replace("_", " "))))


# ---- How large a finding or a cause is, in the units of the laboratory.

UNITS_OF_COUNTS = frozenset({"samples", "records", "readings", "days", "manoeuvres", "positions"})
RUNS = frozenset(
    {"saturation", "gap", "zero_below_threshold"}
)  # of which the size is that of the longest
RATIO = units.Unit("(ratio)", 1.0)
# Faults whose size is a factor; other sizes without a dimension are small, in ppm.
FACTORS = frozenset(
    {
        "wrong_scale_factor",
        "wrong_scale_of_turns",
        "rate_off",
        "table_rate_off",
        "noise_above_data_sheet",
        "wrong_rate",
        "gyro_count_size",
        "gyro_scale_of_axes",
    }
    | {"wrong_time_unit"}
)
# From these sizes on the larger unit is read more easily.
LARGE = {
    "rad/s": (100 * units.DEGREES_PER_HOUR.size, units.DEGREES_PER_SECOND),
    "m/s²": (1e4 * units.MICRO_G.size, units.METRES),
    "rad": (0.1 * pi / 180, units.DEGREES),
}


def size_in_words(row: Record) -> str | None:
    """The size of a row, with its sigma where it has one; None where it has no size."""
    size, unit = row["size"], row["unit"] or "1"
    if size is None:
        return None
    if unit in UNITS_OF_COUNTS:
        return counted(round(size), unit.removesuffix("s"))
    if unit == "sigma":
        return f"{significant(size, 3)} σ"
    shown = _unit(row["cause"], unit, size)
    value, sigma = shown.of(size), shown.of(row.get("sigma"))
    number = significant(value)
    if sigma is not None:
        number = plus_minus(value, sigma)
    return number + (shown.name if shown.name in ("°", "″") else f" {shown.name}".rstrip())


# Effects that are there or not: 1 if they are, and no other size is possible.
THERE_OR_NOT = frozenset({"latitude_sign", "earth_rate_omitted"})


def how_large(row: Record) -> str | None:
    """The same of a cause; of readings lost at several places it is the longest run of them."""
    size = None if row["cause"] in THERE_OR_NOT else size_in_words(row)
    if size is None or row["cause"] not in RUNS or (row["count"] or 1) < 2:
        return size
    return _("{size} in the longest of {count} places", size=size, count=row["count"])


def _unit(cause: str, unit: str, size: float) -> units.Unit:
    """The unit of a size; a factor is a ratio, what is small beside 1 in ppm."""
    if unit in LARGE and abs(size) >= LARGE[unit][0]:
        return LARGE[unit][1]
    if unit == "1" and cause in FACTORS:
        return RATIO
    return units.quantity(cause, unit).shown
