"""How large a finding or a cause is, in the units of the laboratory."""

from __future__ import annotations

from math import pi

from inertial.text import units
from inertial.text.messages import _
from inertial.text.numbers import counted, plus_minus, significant
from stages.report.tables import Record

COUNTS = frozenset({"samples", "records", "readings", "days", "manoeuvres", "positions"})
RUNS = frozenset({"saturation", "gap"})  # of which the size is that of the longest
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
    if unit in COUNTS:
        return counted(round(size), unit.removesuffix("s"))
    if unit == "sigma":
        return f"{significant(size, 3)} σ"
    shown = _unit(row["cause"], unit, size)
    value, sigma = shown.of(size), shown.of(row.get("sigma"))
    number = significant(value)
    if sigma is not None:
        number = plus_minus(value, sigma)
    return number + (shown.name if shown.name in ("°", "″") else f" {shown.name}".rstrip())


def how_large(row: Record) -> str | None:
    """The same of a cause; of readings lost at several places it is the longest run of them."""
    size = size_in_words(row)
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
