"""The campaign file as text: what the logs show, each guess marked, questions at the top."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from commands.draft.header import GRAVITY, GRAVITY_SIGMA, header, recorded_on
from commands.draft.manoeuvres import Manoeuvre, leaning
from commands.draft.scales import Scale, are_counts
from commands.draft.sensors import Kind
from commands.draft.timing import Timing, timing_of
from commands.draft.triads import Triad
from commands.new import GUESS, flow, guess, in_flow, scalar
from inertial.campaign.references import BY_HAND, NOT_NAMED
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

HAND_POSITION, TABLE_SIGMA = 3600, 180  # arc seconds, of what a person or an unknown table sets
HAND_TURN, FEW_TURNS = 8.0, 3  # °, sigma of an angle by hand; turns that show it
BEST_HAND_TURN = 5.0  # degrees, sigma of an angle by hand that the gyros confirm
TABLE_RATE = 1000  # ppm, of a table of which nothing is known
VERSION = "campaign: 1"


def campaign_file(kinds: Sequence[Kind], plan: Sequence[Manoeuvre], name: str) -> str:
    """The text of campaign.yaml."""
    by_hand = not any(m.by_table for m in plan)
    site = {"latitude_deg": None, "gravity_m_s2": GRAVITY, "gravity_sigma_m_s2": GRAVITY_SIGMA}
    anywhere = _("gravity anywhere on earth; a latitude and height make it better")
    named = formats(kinds)
    logs = {m.part.logs[0].path.name for m in plan}
    lines = [
        *header(kinds, plan, name, by_hand),
        VERSION,
        *instrument(kinds, name),
        "serial: unknown",
        _date(kinds),
        f"site: {flow(**site)}{guess(anywhere)}",
        *(f"notes: {scalar(text)}" for text in wired_otherwise(kinds)),
        *_table(plan, by_hand),
        *(["formats:"] if named else []),
        *(line for lines in named.values() for line in lines),
    ]
    if len(logs) == 1:
        lines += [f"{key}: {in_flow(value)}" for key, value in logs_of(plan[0], kinds).items()]
    lines.append("plan:")
    sigma = _angle_sigma(plan)
    for m, own, position in zip(plan, _ids(plan), _positions(plan), strict=True):
        stated = _keys(m, None if m.by_table else sigma)
        keys = {"id": own, **position, **stated, **part_of(m, kinds)}
        if len(kinds) > 1:
            keys["format"] = format_name(m, kinds)
        if len(logs) > 1:
            keys |= logs_of(m, kinds)
        lines.append(f"  - {flow(**keys)}{_seen(m)}")
    told = _("delete each when it is confirmed")
    lines.insert(lines.index(VERSION) + 1, f"guessed: {in_flow(_guessed(lines))}  # {told}")
    return "\n".join(lines) + "\n"


def _date(kinds: Sequence[Kind]) -> str:
    """The date of the recording, where stamps of a log are dates."""
    if (found := recorded_on(kinds)) is None:
        return "date: unknown"
    day, log = found
    return f"date: {day}  # " + _("by the first stamp of {log}", log=log.path.name)


def _guessed(lines: Sequence[str]) -> list[str]:
    """The parts of the file in which a guess is marked."""
    part, found = "", dict[str, None]()
    for line in lines:
        if opened := re.match(r"(?:  )?(instrument|format|formats|site|table|plan):", line):
            part = "format" if opened[1] == "formats" else opened[1]
        if GUESS in line and not line.startswith("#"):
            found[part] = None
    return list(found)


def _table(plan: Sequence[Manoeuvre], by_hand: bool) -> Iterator[str]:
    """The table; by hand only where the plan says more than positions."""
    if by_hand and all(m.do == "positions" for m in plan):
        return
    if by_hand:
        seen = leaning(plan)
        degrees = 1.0 if seen is None else max(1.0, float(np.ceil(2 * np.degrees(seen)) / 2))
        keys = {"name": BY_HAND, "position_sigma_arcsec": round(degrees * HAND_POSITION)}
        yield f"table: {flow(**keys)}" + guess(
            _("a case on its faces stands to within {degrees:g}°", degrees=degrees)
        )
    else:
        keys = {
            "name": NOT_NAMED,
            "position_sigma_arcsec": TABLE_SIGMA,
            "angle_sigma_arcsec": TABLE_SIGMA,
            "rate_sigma_ppm": TABLE_RATE,
        }
        yield f"table: {flow(**keys)}" + guess(_("steady rates are those of a table"))


# ---- the plan


def _angle_sigma(plan: Sequence[Manoeuvre]) -> float:
    """The sigma of the turns by hand, °: how far the gyros have them from round angles."""
    off = [m.seen - m.degrees for m in plan if m.degrees and m.seen and not m.by_table]
    if len(off) < FEW_TURNS:
        return HAND_TURN
    return float(np.clip(np.ceil(np.sqrt(np.mean(np.square(off)))), BEST_HAND_TURN, HAND_TURN))


def _keys(m: Manoeuvre, angle_sigma: float | None) -> dict[str, Any]:
    """What the plan states of a manoeuvre."""
    if m.do == "positions":
        return {"do": "positions"} | ({} if m.seconds is None else {"seconds": m.seconds})
    keys: dict[str, Any] = {"do": m.do, "up": m.up or "unknown"}
    if m.do == "turn":
        if m.about != m.up:
            keys["about"] = m.about
        if m.degrees is not None:
            keys["degrees"] = m.degrees
            if angle_sigma is not None:
                keys["degrees_sigma"] = angle_sigma
        if m.rate is not None:
            keys["rate_deg_s"] = m.rate
        if m.steady:
            keys["recorded"] = "steady"
    elif m.part.label is None and m.rows is None and m.seconds is not None:
        keys["seconds"] = float(f"{m.seconds:.2g}")
    return keys


def _seen(m: Manoeuvre) -> str:
    """What the log shows of a manoeuvre, as a comment behind it."""
    if m.do == "turn" and m.seen is not None:
        angle = significant(m.seen)
        return guess(_("the gyros have {seen}° in {seconds:.1f} s", seen=angle, seconds=m.seconds))
    if m.do == "rest" and m.up is None:
        return guess(_("no axis points up"))
    if m.seconds is None:
        return "  # " + _("{count} means", count=m.count)
    if m.do == "positions":
        return "  # " + _(
            "{count} static positions of at least {seconds:g} s", count=m.count, seconds=m.seconds
        )
    return "  # " + _("{seconds:.1f} s", seconds=m.seconds)


def _ids(plan: Sequence[Manoeuvre]) -> Iterator[str]:
    """A name for each manoeuvre: its label, or what it is, numbered where there are several."""
    names = [_name(m) for m in plan]
    several, used = Counter(names), Counter[str]()
    for name in names:
        used[name] += 1
        yield f"{name}-{used[name]}" if several[name] > 1 else name


def _positions(plan: Sequence[Manoeuvre]) -> Iterator[dict[str, str]]:
    """The position of each manoeuvre that shares one with others, named by the first of them."""
    held = [m.held for m in plan]
    name = ""
    for own, before, behind in zip(_ids(plan), held, [*held[1:], False], strict=True):
        name = name if before else own
        yield {"position": name} if before or behind else {}


def _name(m: Manoeuvre) -> str:
    if slug := re.sub(r"[^a-z0-9+-]+", "-", (m.part.label or "").lower()).strip("-"):
        return slug
    if m.do == "rest":
        return f"{m.up[1]}-{'up' if m.up[0] == '+' else 'down'}" if m.up else "rest"
    if m.do == "turn" and m.about:
        backward = (m.degrees or m.rate or 1) < 0
        return f"{m.about[1]}-{'backward' if backward else 'forward'}"
    return m.do


# ---- The instrument of a campaign file, and the formats of its logs.

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
    own = _timing(kind, file)
    mark = guess(own.evidence) if own.guessed else ""
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


def _timing(kind: Kind, file: int) -> Timing:
    """The clock of one of its files, which may have another unit than that of the first."""
    logs, columns = kind.parts[0].logs[: file + 1], kind.columns.time
    first, own = (timing_of([logs[i]], columns[i]) for i in (0, file))
    return kind.timing if own.unit == first.unit else own


def _time(kind: Kind, file: int) -> dict[str, Any]:
    timing = _timing(kind, file)
    column = None if timing.column is None else kind.columns.time[file]
    time: dict[str, Any] = {} if column is None else {"column": column, "unit": timing.unit}
    pair = None if column is None else kind.parts[0].logs[file].pairs.get(column)
    if pair is not None:
        time = {"columns": list(pair.columns), "units": list(pair.units)}
    if timing.unit in (None, "sample"):
        time["rate_hz"] = timing.rate
    if timing.ticks_per_s is not None:
        time["ticks_per_s"] = timing.ticks_per_s
    if timing.wraps_at and pair is None:
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
