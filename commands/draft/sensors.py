"""What the logs are: those of one kind with their columns, clock, units and motion."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from commands.draft import full_scale
from commands.draft.columns import Columns, Named, columns_of
from commands.draft.groups import alike, recorded_together, runs_of, sensors_apart
from commands.draft.raw_log import RawLog, without_tail
from commands.draft.scales import (
    Receiver,
    Scale,
    Turning,
    accel_scale,
    are_counts,
    gyro_scale,
    parts_named,
    receiver_of,
    turning,
)
from commands.draft.series import Divided, Series, divided, sphere
from commands.draft.timing import (
    TICKS,
    UNITS,
    Timing,
    common_rate,
    nearly_as_usual,
    seconds_of,
    tick_in_words,
    timing_of,
)
from commands.draft.triads import Triad
from inertial.arrays import Array
from inertial.signal.rests_and_motions import BinStretch, rest_level
from inertial.tables.errors import Refusal
from inertial.text.messages import _, plural
from inertial.text.numbers import significant
from inertial.text.units import CHANNEL_UNITS

MIN_ROWS = 100  # of logs of one kind, to be samples
MAX_MEAN_SCATTER = 0.1  # of the length of means about their centre
MIN_SPREAD = 0.2  # of their directions
MIN_UNIT_ERROR = 0.04  # of gyros whose unit tells the clock: 1 rpm is 5 % more than 0.1 rad/s
MIN_STEPS = 0.02  # of their variance, from row to row: a motion has many rows to the radian


@dataclass(frozen=True)
class Part:
    """A recording, or the rows of it that one label names: (first, after), of each file."""

    logs: Sequence[RawLog]
    label: str | None
    rows: tuple[int, int]
    series: Series


@dataclass(frozen=True)
class Kind:
    """Recordings with the same columns: what these are, their clock, units and parts."""

    columns: Columns
    timing: Timing
    accel: Scale | None
    gyro: Scale | None
    parts: Sequence[Part]
    divided: Sequence[Divided]  # of each part, in SI
    receiver: Receiver | None = None
    means: bool = False  # each row is a mean of its own

    @property
    def recordings(self) -> list[Sequence[RawLog]]:
        """The logs of each recording, which parts share that labels divide."""
        return list({id(part.logs): part.logs for part in self.parts}.values())

    @property
    def incomplete(self) -> int:
        """How many rows lack a reading of a sensor, where none select those of one sensor."""
        triads = [t for t in (self.columns.accel, self.columns.gyro) if t and t.rows is None]
        return sum(
            max((triad.rows_in(logs) - len(triad.of(logs)) for triad in triads), default=0)
            for logs in self.recordings
        )

    @property
    def interleaved(self) -> bool:
        """Whether rows of the two sensors alternate."""
        accel, gyro = self.columns.accel, self.columns.gyro
        return bool(accel and gyro and accel.rows and gyro.rows)


def kinds_of(logs: Sequence[RawLog], rate: float | None = None) -> list[Kind]:
    """The logs, those with the same columns together; `rate`, Hz, where no log has a clock."""
    recordings = recorded_together([without_tail(run) for log in logs for run in runs_of(log)])
    found = [
        _kind(group, sensor, rate)
        for same in alike(recordings)
        for group, sensor in sensors_apart(same)
    ]
    return [_in_si(kind, found) for kind in found]


def _kind(group: Sequence[Sequence[RawLog]], sensor: Named | None, rate: float | None) -> Kind:
    """Logs of one kind, their readings as they stand in the files."""
    if all(together[0].rows <= 1 for together in group):
        _refuse_few(group, None)
    columns = columns_of(group, sensor)
    triad = columns.accel or columns.gyro
    rows = triad.rows if triad is not None and triad.file == 0 else None
    timing = timing_of([together[0] for together in group], columns.time[0], rows)
    if rate is not None:
        timing = timing.with_stated(rate)
    if columns.accel and columns.time[0] is None and columns.label is None:
        readings = [columns.accel.of(together) for together in group]
        if all(map(are_means, readings)) or _are_means_of_one_attitude(columns, readings):
            return _kind_of_means(columns, timing, group)
    _refuse_few(group, columns)
    kind = _kind_by_clock(group, columns, timing)
    better = _clock_by_motion(kind)
    return kind if better is None else _kind_by_clock(group, columns, better)


def _kind_by_clock(group: Sequence[Sequence[RawLog]], columns: Columns, timing: Timing) -> Kind:
    """Logs of one kind with this clock, their readings as they stand in the files."""
    kind = Kind(columns, timing, None, None, [], [])
    parts = [part for together in group for part in _parts(kind, together)]
    own = _divided(parts, known_units=False)
    if group[0][0].kind == "rawimus":
        receiver = receiver_of(own, timing.rate)
        return Kind(columns, timing, receiver.accel, receiver.gyro, parts, own, receiver)
    accel = accel_scale(own) if columns.accel else None
    _refuse_without_gravity(accel, columns, group)
    if accel and columns.accel:
        stated = full_scale.of_accel(group[0][columns.accel.file].header)
        accel = full_scale.accel_in_range(accel, stated)
    turned = turning(own, accel.zero) if accel and columns.gyro else None
    gyro = None
    if columns.gyro:
        gyro = gyro_scale(own, turned, columns.gyro.columns, accel)
        if not (timing.guessed and timing.unit in (None, "sample")):  # else the rate is not known
            stated = full_scale.of_gyro(group[0][columns.gyro.file].header)
            gyro = full_scale.gyro_in_range(gyro, stated, own, moved=turned is not None)
        if turned is not None:
            own_parts = parts_named(columns.gyro.columns)
            gyro, timing = _rate_by_motion(gyro, timing, turned, own, own_parts)
    return Kind(columns, timing, accel, gyro, parts, own)


def _refuse_few(group: Sequence[Sequence[RawLog]], columns: Columns | None) -> None:
    """Refuse a table of a few rows, which are no samples of a motion."""
    rows, log = sum(together[0].rows for together in group), group[0][0]
    if rows < MIN_ROWS and log.kind != "rawimus":
        raise Refusal(
            log.path.name,
            "",
            plural("{count} row of numbers", "{count} rows of numbers", rows),
            _(
                "samples, at least {rows}; or the means of positions; or the means of one at "
                "temperatures, whose columns are named",
                rows=MIN_ROWS,
            ),
            _("name the log of the samples")
            if columns is None or (columns.temperature is not None and not columns.guessed)
            else _(
                "name the log of the samples; or add a first line that names the columns of means, "
                "such as temperature, samples, acc_x, acc_y, acc_z, gyro_x, gyro_y, gyro_z"
            ),
        )


def _refuse_without_gravity(
    accel: Scale | None, columns: Columns, group: Sequence[Sequence[RawLog]]
) -> None:
    """Refuse accelerations from which a phone has taken gravity: less than a count would be 1 g."""
    if accel is None or columns.accel is None or (accel.counts or 1.0) >= 1 or accel.increments:
        return
    raise Refusal(
        group[0][columns.accel.file].path.name,
        ", ".join(map(str, columns.accel.columns)),
        _("no gravity: {evidence}", evidence=accel.evidence),
        _("what accelerometers read, 9.8 m/s² or 1 g at rest"),
        _("name the log of the accelerometers themselves, not that of the linear acceleration"),
    )


def are_means(values: Array) -> bool:
    """Whether readings (n, 3) change from row to row as far as only positions do."""
    _centre, length, scatter = sphere(values)
    spread = float(np.mean(np.var(values, axis=0)))
    steps = float(np.mean(np.diff(values, axis=0) ** 2)) / 2 if len(values) > 1 else 0.0
    on_sphere = scatter < MAX_MEAN_SCATTER * length
    return on_sphere and spread > (MIN_SPREAD * length) ** 2 and steps > MIN_STEPS * spread


def _are_means_of_one_attitude(columns: Columns, readings: Sequence[Array]) -> bool:
    """Whether rows, by the names of their columns, are means at temperatures: one attitude, few."""
    if columns.guessed or columns.temperature is None or sum(map(len, readings)) >= MIN_ROWS:
        return False
    directions = [values / np.linalg.norm(values, axis=1)[:, None] for values in readings]
    cosines = [own @ own.mean(axis=0) for own in directions]
    return bool(np.concatenate(cosines).min() > np.cos(MAX_MEAN_SCATTER))


def _kind_of_means(columns: Columns, timing: Timing, group: Sequence[Sequence[RawLog]]) -> Kind:
    """Logs of which each row is the mean of a static position, or of one at a temperature."""
    several = all(are_means(columns.accel.of(logs)) for logs in group if columns.accel)
    why = _("each row is a position, as it differs")
    if not several:
        why = _("so few rows in one attitude are means, each at its temperature")
    timing = replace(timing, guessed=False, evidence=why)
    parts, own = [], []
    for together in group:
        values = [t.of(together) if t else np.empty((0, 3)) for t in (columns.accel, columns.gyro)]
        series = Series(values[0], values[1], 1.0, 1.0)
        parts.append(Part(together, None, (0, together[0].rows), series))
        rows = [BinStretch(False, row, row + 1) for row in range(len(values[0]))]
        forces, rates = series.means(values[0]), series.means(values[1])
        own.append(Divided(series, forces, rates, np.full(3, np.nan), rows))
    accel = accel_scale(own)
    gyro = gyro_scale(own, None, columns.gyro.columns, accel) if columns.gyro else None
    return Kind(columns, timing, accel, gyro, parts, own, means=True)


def _parts(kind: Kind, together: Sequence[RawLog]) -> list[Part]:
    """A recording, or one for each label."""
    columns, rate = kind.columns, kind.timing.rate

    def values(triad: Triad | None, rows: slice) -> Array:
        return np.empty((0, 3)) if triad is None else triad.of(together)[rows]

    def series(of_accel: slice, of_gyro: slice) -> Series:
        forces, rates = values(columns.accel, of_accel), values(columns.gyro, of_gyro)
        apart = len(together) > 1 or kind.interleaved
        ratio = len(rates) / len(forces) if apart and len(forces) and len(rates) else 1.0
        return Series(forces, rates, rate, rate * ratio)

    if len(together) > 1 and columns.accel and columns.gyro:
        accel, gyro = columns.accel, columns.gyro
        common = _common_rows(columns, together)
        both = series(common[accel.file], common[gyro.file])
        return [Part(together, None, (common[0].start, common[0].stop), both)]
    if columns.label is None:
        both = series(*[slice(None)] * 2)
        count = min(len(both.accel), len(both.gyro)) if kind.interleaved else together[0].rows
        return [Part(together, None, (0, count), both)]
    words = np.array(together[0].words[columns.label])
    parts = []
    for word in dict.fromkeys(words.tolist()):
        places = np.flatnonzero(words == word)
        rows = (int(places[0]), int(places[-1]) + 1)
        if rows[1] - rows[0] == len(places):
            parts.append(Part(together, word, rows, series(*[slice(*rows)] * 2)))
    return parts


def _common_rows(columns: Columns, together: Sequence[RawLog]) -> list[slice]:
    """The rows of each file in the time that all of them cover."""
    clocks = zip(together, columns.time, strict=True)
    stamps = [seconds_of(log, name) for log, name in clocks if name]
    first = max(float(np.nanmin(own)) for own in stamps)
    last = min(float(np.nanmax(own)) for own in stamps)
    inside = [np.flatnonzero((own >= first) & (own <= last)) for own in stamps]
    return [slice(int(rows[0]), int(rows[-1]) + 1) for rows in inside]


def _divided(parts: Sequence[Part], *, known_units: bool) -> list[Divided]:
    """Where each part rests and moves, by what the gyros read at rest in all of them."""
    rates = [part.series.means(part.series.gyro) for part in parts if len(part.series.gyro)]
    level = rest_level(np.concatenate(rates)) if rates else None
    return [divided(part.series, level, known_units=known_units) for part in parts]


def _clock_by_motion(kind: Kind) -> Timing | None:
    """Another unit of the clock, where with that the gyros read a unit, and with this one none.

    A guessed clock that is off by a power of ten is likelier than gyros in no usual unit.
    """
    gyro, timing = kind.gyro, kind.timing
    if gyro is None or not gyro.shares or gyro.counts is None or gyro.increments:
        return None
    values = np.concatenate([each.series.gyro for each in kind.divided])
    if not timing.guessed or timing.unit in (None, "sample") or are_counts(values):
        return None
    for ticks in (*UNITS.values(), *TICKS):
        power = ticks / timing.clock_ticks
        unit = next((u for u in ("rad/s", "deg/s") if _reads(gyro, u, power)), None)
        if unit is None or not nearly_as_usual(timing.rate * power, timing.rate):
            continue
        return timing.with_ticks(
            ticks,
            _(
                "with a tick of {tick} the gyros read {unit}, with one of {guessed} no usual unit",
                tick=tick_in_words(ticks),
                unit=unit,
                guessed=tick_in_words(timing.clock_ticks),
            ),
        )
    return None


def _reads(gyro: Scale, unit: str, power: float) -> bool:
    """Whether gyros read this unit if there are `power` times as many samples a second."""
    return abs(gyro.size * power / CHANNEL_UNITS[unit] - 1) < max(2 * gyro.sigma, MIN_UNIT_ERROR)


def _rate_by_motion(
    gyro: Scale, timing: Timing, turned: Turning, own: Sequence[Divided], parts: float | None
) -> tuple[Scale, Timing]:
    """Without a clock the motion shows the rate, where the gyros read a unit and no counts.

    `parts`: how many make one of the unit, by their names; None: these are it.
    """
    values = np.concatenate([each.series.gyro for each in own])
    if not timing.guessed or timing.unit not in (None, "sample") or are_counts(values):
        return gyro, timing
    # The factor is that of the readings times that of the assumed interval.
    rates = {
        unit: timing.rate * Scale(unit, parts, 0, "", False).size / turned.factor
        for unit in ("rad/s", "deg/s")
    }
    unit = min(rates, key=lambda each: abs(np.log(rates[each] / timing.rate)))
    rate = common_rate(rates[unit]) or rates[unit]
    evidence = _(
        "the gyros in {unit} carry gravity's direction from rest to rest with {rate} Hz, "
        "± {percent:.0f} % and their scale factor error",
        unit=unit,
        rate=significant(rates[unit]),
        percent=100 * turned.sigma,
    )
    return replace(gyro, unit=unit, counts=parts), timing.with_rate(rate, evidence)


def _in_si(kind: Kind, others: Sequence[Kind]) -> Kind:
    """The same in SI; units that its own motion does not show are those of other logs."""
    accel, gyro = kind.accel, kind.gyro
    if gyro is not None and gyro.guessed and kind.columns.gyro:
        same = [
            other.gyro
            for other in others
            if other.gyro and not other.gyro.guessed and other is not kind
        ]
        if same:
            gyro = replace(same[0], evidence=_("as the gyros of the other logs"))
    moved = [other.gyro.axes for other in others if other.gyro and other.gyro.axes.moved]
    if gyro is not None and moved and not gyro.axes.moved:
        gyro = replace(gyro, axes=moved[0])  # all logs are of one instrument
    if kind.means:
        return kind
    rate = kind.timing.rate
    parts = [
        replace(
            part,
            series=Series(
                accel.in_si(part.series.accel) if accel else part.series.accel,
                gyro.in_si(part.series.gyro) if gyro else part.series.gyro,
                rate,
                rate * part.series.gyro_hz / part.series.accel_hz,
            ),
        )
        for part in kind.parts
    ]
    return replace(kind, gyro=gyro, parts=parts, divided=_divided(parts, known_units=True))
