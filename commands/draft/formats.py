"""The instrument of a campaign file, and the formats of its logs."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from commands.draft.manoeuvres import Manoeuvre
from commands.draft.scales import Scale, are_counts
from commands.draft.sensors import Kind
from commands.draft.triads import Triad
from commands.new_campaign import flow, guess, in_flow, scalar
from inertial.text.messages import _
from inertial.text.numbers import fixed

LARGEST_COUNT = 32767
BOTH = ("accelerometer", "gyro")  # sensors in one file


def instrument(kinds: Sequence[Kind], name: str) -> Iterator[str]:
    """The instrument, line by line, with the format of its logs where all have one."""
    receiver = next((kind.receiver for kind in kinds if kind.receiver), None)
    if receiver is not None and isinstance(receiver.instrument, str):
        yield f"instrument: {receiver.instrument}{guess(receiver.accel.evidence)}"
        return
    yield "instrument:"
    yield f"  name: {scalar(name)}" + guess(_("the name of the campaign"))
    if receiver is not None and not isinstance(receiver.instrument, str):
        for key, value in receiver.instrument.items():
            yield f"  {key}: {in_flow(value)}" + guess(receiver.accel.evidence)
    elif (axes := _axes(kinds)) is not None:
        yield f"  gyro: {flow(axes=axes)}" + guess(_("gravity turns as if so"))
    if len(kinds) == 1:
        yield "  format:"
        yield from _format(kinds[0], BOTH)


def _axes(kinds: Sequence[Kind]) -> list[str] | None:
    """Body axis and sign of each column of the gyros, where it is not x, y, z."""
    moved = [kind.gyro.axes for kind in kinds if kind.gyro and kind.gyro.axes.moved]
    if not moved:
        return None
    back = moved[0].inverse  # column j is the body axis that reads it
    return [f"{'-' if back.signs[j] < 0 else ''}{'xyz'[back.sources[j]]}" for j in range(3)]


def wired_otherwise(kinds: Sequence[Kind]) -> Iterator[str]:
    """What the report has to tell of gyros whose axes are not those of the accelerometers."""
    for gyro in (kind.gyro for kind in kinds):
        if gyro is not None and gyro.axes.moved and gyro.shares:
            seen = ", ".join(
                f"{axis} {fixed(share, 2)} ± {fixed(sigma, 2)}"
                for axis, (share, sigma) in zip("xyz", gyro.shares, strict=True)
            )
            text = _(
                "Of the gyros {axes}: gravity's direction turns in the accelerometers by these "
                "shares of what they read: {seen}. The draft has set their axes so.",
                axes=gyro.axes.in_words,
                seen=seen,
            )
            right = [i for i, other in enumerate(gyro.axes.changed) if not other]
            if gyro.axes.sources == (0, 1, 2) and len(right) == 1:
                text += _(
                    " A reversed {axis} axis of the accelerometers would look the same; a single "
                    "reversed gyro would not.",
                    axis="xyz"[right[0]],
                )
            yield text
            return


# ---- formats


def formats(kinds: Sequence[Kind]) -> dict[str, list[str]]:
    """The named formats, line by line: of each kind of log, and of gyros in a log of their own."""
    found: dict[str, list[str]] = {}
    for number, kind in enumerate(kinds, 1):
        own = list(_format(kind, BOTH))
        if len(kinds) > 1 and own not in found.values():
            found[f"format-{number}"] = own
        if len(kind.columns.time) > 1:
            found[f"gyros-{number}"] = list(_format(kind, ("gyro",)))
    return {name: [f"  {name}:", *lines] for name, lines in found.items()}


def format_name(m: Manoeuvre, kinds: Sequence[Kind]) -> str:
    """The format of its log: of equal ones the first."""
    every = [list(_format(kind, BOTH)) for kind in kinds]
    return f"format-{every.index(every[_place(m, kinds) - 1]) + 1}"


def logs_of(m: Manoeuvre, kinds: Sequence[Kind]) -> dict[str, Any]:
    """The log of a manoeuvre, and that of the gyros where they have one of their own."""
    files = [log.path.name for log in m.part.logs]
    columns = kinds[_place(m, kinds) - 1].columns
    if len(files) == 1 or columns.accel is None or columns.gyro is None:
        return {"log": files[0]}
    gyro = {"log": files[columns.gyro.file], "format": f"gyros-{_place(m, kinds)}"}
    return {"log": files[columns.accel.file], "gyro": gyro}


def part_of(m: Manoeuvre, kinds: Sequence[Kind]) -> dict[str, Any]:
    """Which part of its log a manoeuvre is, as the plan states it."""
    if m.part.label is not None:
        return {"where": {kinds[_place(m, kinds) - 1].columns.label: m.part.label}}
    if m.rows is None:
        return {}
    if len(m.part.logs) > 1:
        rate = m.part.series.accel_hz
        return {"span": [round(row / rate, 2) for row in m.rows]}
    return {"rows": list(m.rows)}


def _place(m: Manoeuvre, kinds: Sequence[Kind]) -> int:
    """The number of the kind of log that a manoeuvre is in, from 1."""
    return next(n for n, k in enumerate(kinds, 1) if any(part is m.part for part in k.parts))


def _format(kind: Kind, sensors: Sequence[str]) -> Iterator[str]:
    """The format of a log that holds these sensors, as far as they are in one file."""
    columns, timing = kind.columns, kind.timing
    triads = {"accelerometer": columns.accel, "gyro": columns.gyro}
    file = next((triad.file for key in sensors if (triad := triads[key]) is not None), 0)
    log = kind.parts[0].logs[file]
    for key, value in log.layout.items():
        yield f"    {key}: {scalar(value)}"
    if log.kind == "rawimus":
        return
    mark = guess(timing.evidence) if timing.guessed else ""
    if kind.means:
        number = "null" if columns.mean_of is None else scalar(columns.mean_of)
        yield f"    mean_of: {number}{guess(timing.evidence)}"
    else:
        yield f"    time: {flow(**_time(kind, file))}{mark}"
    if columns.temperature is not None and file == 0:
        name, unit = columns.temperature
        yield f"    temperature: {flow(column=name, unit=unit)}{guess(_('by its name'))}"
    for key, scale in (("accelerometer", kind.accel), ("gyro", kind.gyro)):
        triad = triads[key]
        if log.kind == "columns" and triad and scale and triad.file == file:
            mark = guess(scale.evidence) if scale.guessed or columns.guessed else ""
            yield f"    {key}: {flow(**_triad(kind, triad, scale))}{mark}"


def _time(kind: Kind, file: int) -> dict[str, Any]:
    column, timing = kind.columns.time[file], kind.timing
    time: dict[str, Any] = {} if column is None else {"column": column, "unit": timing.unit}
    if timing.unit in (None, "sample"):
        time["rate_hz"] = timing.rate
    if timing.ticks_per_s is not None:
        time["ticks_per_s"] = timing.ticks_per_s
    if timing.wraps_at:
        time["wraps_at"] = timing.wraps_at
    return time


def _triad(kind: Kind, triad: Triad, scale: Scale) -> dict[str, Any]:
    keys: dict[str, Any] = {"columns": list(triad.columns), "unit": scale.unit}
    if scale.counts is not None:
        keys["counts_per_unit"] = scale.counts
    if triad.bits is not None:
        keys["signed_bits"] = triad.bits
    if scale.zero:
        keys["zero_counts"] = scale.zero
    if _clips(kind, triad):
        keys["limit_counts"] = LARGEST_COUNT
    if triad.rows is not None:
        keys["rows"] = {triad.rows[0]: triad.rows[1]}
    return keys


def _clips(kind: Kind, triad: Triad) -> bool:
    """Whether a sensor reaches the last count of 16 bits."""
    values = np.concatenate([triad.of(together) for together in kind.recordings])
    return are_counts(values) and float(np.abs(values).max()) in (LARGEST_COUNT, LARGEST_COUNT + 1)
