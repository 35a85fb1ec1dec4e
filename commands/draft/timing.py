"""The clock of a log: its time column, the unit of it, and how many samples a second it has."""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import numpy as np

from commands.draft.raw_log import Name, RawLog, finite
from inertial.arrays import Array
from inertial.text.messages import _, listed
from inertial.text.numbers import significant, whole

MAX_RESETS = 0.01  # share of steps in which a clock may stand or go back
MIN_ADVANCING = 0.5  # of the rows, in which a clock of several columns advances
MIN_COUNTED = 0.95  # of the rows, that a counter of them numbers one by one
CLOCK_PARTS = 20  # of a log, in each of which a clock advances alike
TIME = re.compile(
    r"time|stamp|^t$|sample|epoch|clock|^n$|^t[ _(\[]|^ms$|^us$|millis|micros", re.IGNORECASE
)
SENSORS_STAMP = re.compile(r"header[._]?stamp", re.IGNORECASE)  # of ROS; others are of arrival
PACKETS = re.compile(r"packet|number|count|index|sequence|\bseq\b|frame|message", re.IGNORECASE)
UNITS = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9}  # ticks in a second
TICKS = (1e4,)  # in a second, of clocks in no such unit: SampleTimeFine of Xsens
MIN_RATE, MAX_RATE = 1.0, 50_000.0  # Hz, of a log of an IMU
MAX_LESS_USUAL = 3.0  # factor by which a rate may be farther from the usual one than another
MAX_OFF_STATED = 2.0  # factor between the rate that a header states and that of the rows
USUAL_RATE = 100.0  # Hz: of the units that a time may have, that with the rate nearest to it
COMMON_RATES = np.array(
    [
        *(10, 20, 25, 50, 60, 75, 80, 100, 102.4, 104, 120, 125, 128, 200, 204.8, 208, 250, 256),
        *(400, 416, 500, 512, 800, 833, 1000, 1600, 1666, 2000, 4000, 8000),
    ]
)  # Hz
MAX_RATE_ERROR = 0.05  # of a rate that is taken to be a common one
MAX_STEP = 3.0  # usual steps, that a counter may be off by where it begins again
DAY = 86400.0  # s
MIN_SINGLE_TICKS = 0.9  # of the new stamps, to be those of a clock that is coarser than the rows
MIN_PERIOD = 255  # of a counter: fewer ticks are no clock
STATED = re.compile(
    r"(?:\bfs|(?<!baud[ _])(?<!bit[ _])(?:\b|_|abtast|sampl\w{1,3}|data)rate"
    r"|\b(?:abtast|sampl\w{1,3})?fr[eé]q\w*|\bodr|\bhz)\b[^0-9\n]{0,30}([0-9]+(?:\.[0-9]+)?)",
    re.IGNORECASE,
)
INTERVAL = re.compile(r"(?:dt|d_t|delta_?t|Δt|(?:sample_?)?interval)(?![a-z])", re.IGNORECASE)
SPELT = {"us": "us", "µs": "us", "sec": "s", "seconds": "s"}
IN_NAME = re.compile(r"(?:[\[(_ ])(ns|us|µs|ms|s|sec|seconds)(?:[\])]|$)", re.IGNORECASE)


def time_of(log: RawLog) -> Name | None:
    """The column that grows steadily, a named one before others; None where none does.

    One that counts rows is behind those whose names state a unit of time. The messages of a
    receiver have one, however few they are.
    """
    if log.kind == "rawimus":
        return "time"
    growing = [
        name
        for name, values in log.columns.items()
        if grows(values) and not _numbers_packets(name, values)
    ]
    named = [name for name in growing if TIME.search(str(name)) or _is_time(log, name)]
    named.sort(key=lambda name: not _is_time(log, name) and _counts_rows(log.columns[name]))
    # A temperature T that rises stands still from row to row.
    named.sort(key=lambda name: np.mean(np.diff(finite(log.columns[name])) > 0) < MIN_ADVANCING)
    named.sort(key=lambda name: name not in log.pairs and not SENSORS_STAMP.search(str(name)))
    return next(iter(named + growing), None)


def _is_time(log: RawLog, name: Name) -> bool:
    """Whether a column is one of times by the unit in its name, or by how it is written."""
    return name in log.pairs or name in log.dates or bool(IN_NAME.search(str(name)))


def _counts_rows(values: Array) -> bool:
    """Whether values go on by one from row to row."""
    return bool(np.mean(np.diff(finite(values)) == 1) > MIN_COUNTED)


def _numbers_packets(name: Name, values: Array) -> bool:
    """Whether a column by its name counts packets, of which not all are samples: no clock."""
    if not PACKETS.search(str(name)) or TIME.search(str(name)):
        return False
    steps = np.diff(finite(values))
    return not (values % 1).any() and len(steps) > 0 and 1 - np.mean(steps == 1) > MAX_RESETS


def grows(values: Array) -> bool:
    """Whether values grow as a clock does: hardly ever back, as much in each part of the log."""
    values = values[np.isfinite(values)]
    if len(values) < 2 * CLOCK_PARTS:
        return False
    steps = np.diff(values)
    usual_step = np.median(steps)
    if usual_step > 0 and np.mean(steps == usual_step) >= 1 - MAX_RESETS:
        return True  # it counts, though it begin again at times
    if usual_step > 0 and (steps >= 0).all() and np.mean(steps < 2 * usual_step) >= 1 - MAX_RESETS:
        return True  # though the recording pause
    growth = np.diff(values[np.linspace(0, len(values) - 1, CLOCK_PARTS + 1).astype(int)])
    usual = float(np.median(growth))
    alike = np.abs(growth - usual) < usual / 2
    return bool(usual > 0 and np.mean(steps < 0) <= MAX_RESETS and alike.mean() >= 0.7)


@dataclass(frozen=True)
class Timing:
    """A time column and its unit, none where rows are the clock; the rate in Hz, and why.

    `ticks_per_s`: of the unit `tick`; `doubt`: a question, or none.
    """

    column: Name | None
    unit: str | None
    rate: float
    guessed: bool
    evidence: str
    wraps_at: int | None = None  # the counter begins again after as many
    ticks_per_s: float | None = None
    doubt: str = ""

    def with_ticks(self, ticks_per_s: float, evidence: str) -> "Timing":
        """The same with another unit of its clock, that something else says, and is asked."""
        unit = unit_of(ticks_per_s)
        rate = self.rate * ticks_per_s / self.clock_ticks
        own = ticks_per_s if unit == "tick" else None
        doubt = _("{why}; how long is a tick?", why=evidence)
        return replace(self, unit=unit, rate=rate, evidence=evidence, ticks_per_s=own, doubt=doubt)

    @property
    def clock_ticks(self) -> float:
        """Ticks of the clock in a second."""
        return self.ticks_per_s or UNITS.get(self.unit or "", 1.0)

    def with_rate(self, rate: float, evidence: str) -> "Timing":
        """The same with a rate that something else says."""
        return replace(self, rate=rate, guessed=True, evidence=evidence)

    def with_stated(self, rate: float) -> "Timing":
        """The same where a person states the rate: of rows that are counted, or a guessed tick."""
        if not self.guessed and self.unit not in (None, "sample"):
            return self
        why = _("the rate is stated")
        if self.unit in (None, "sample"):
            return replace(self, rate=rate, guessed=False, evidence=why)
        if abs(np.log(rate / self.rate)) < np.log(MAX_OFF_STATED):
            return replace(self, guessed=False, evidence=why, doubt="")
        ticks = float(f"{self.clock_ticks * rate / self.rate:.4g}")
        near = (own for own in UNITS.values() if abs(own / ticks - 1) < MAX_RATE_ERROR)
        timing = self.with_ticks(next(near, ticks), why)
        return replace(timing, guessed=False, doubt="")


def timing_of(
    logs: Sequence[RawLog], column: Name | None, rows: tuple[Name, str] | None = None
) -> Timing:
    """The clock of logs of one kind; `column` holds the time, None where rows are counted.

    `rows`: the column and the word of those that are samples, where not all are.
    """
    found = (float(m[1]) for log in logs for line in log.header if (m := STATED.search(line)))
    stated = next((rate for rate in found if rate > 0), None)
    if column is None:
        return _by_intervals(logs, stated) or _without_time(
            None, None, stated, _("no column is a time")
        )
    counters = [_finite(log.column(column, rows)) for log in logs]
    steps = [np.diff(counter) for counter in counters]
    ticks = float(np.median([_step(counter) for counter in counters]))
    counted = ticks == 1 and all(np.mean(own == 1) > MIN_COUNTED for own in steps)
    if counted and not MIN_RATE < _ticks_named(column) <= MAX_RATE:
        timing = _without_time(column, "sample", stated, _("it counts samples"))
        return replace(timing, wraps_at=_wraps_at(counters))
    dated = column in logs[0].dates
    clock = _clock_of(logs[0], column, ticks, stated)
    why, rate = clock.why, clock.ticks_per_s / ticks
    if clock.guessed and not MIN_RATE <= rate <= MAX_RATE:  # such as days
        why = _(
            "a step of {ticks} of {column} is in no unit of time the rate of an IMU",
            ticks=significant(ticks, 6),
            column=column,
        )
        return _by_intervals(logs, stated) or _without_time(None, None, stated, why)
    if logs[0].kind == "rawimus":
        why = _("GPS time")
    positive = np.concatenate([own[own > 0] for own in steps])
    if np.median(positive) < 0.5 * ticks:
        why += _("; stamps come in bursts: the rate is their number in the whole time")
    wraps_at = None if dated else _period(counters)
    if dated and min(float(own.min()) for own in counters) < DAY:
        why, wraps_at = _("it holds the time of the day"), round(DAY * 1e9)
    elif wraps_at is not None:
        why += _("; it begins again after {period} ticks", period=wraps_at)
    elif (back := _first_back(counters, clock.ticks_per_s)) is not None:
        why += _(
            "; it goes back by {seconds} s before row {row}: what follows was recorded after a new "
            "start, and is better a log of its own",
            seconds=significant(back[1] / clock.ticks_per_s, 3),
            row=whole(back[0] + 1),
        )
    timing = Timing(column, clock.unit, rate, clock.guessed, why, wraps_at, doubt=clock.doubt)
    return replace(timing, ticks_per_s=clock.ticks_per_s) if clock.unit == "tick" else timing


def first_date(logs: Sequence[RawLog]) -> tuple[str, RawLog] | None:
    """The date of the first of all stamps that are dates, ISO 8601, and its log; None: none are."""
    stamps = [
        (float(finite(log.columns[name]).min()), number)
        for number, log in enumerate(logs)
        for name in log.dates
    ]
    dated = [stamp for stamp in stamps if stamp[0] >= DAY]  # less is a time of the day
    if not dated:
        return None
    first, number = min(dated)
    return datetime.fromtimestamp(first, UTC).date().isoformat(), logs[number]


def seconds_of(log: RawLog, column: Name) -> Array:
    """The stamps of a log in its own unit of time, (n,), s."""
    return np.asarray(log.columns[column] / timing_of([log], column).clock_ticks)


@dataclass(frozen=True)
class _Clock:
    """The unit of a time column, its ticks in a second, and what says so."""

    unit: str
    ticks_per_s: float
    why: str
    guessed: bool = False
    doubt: str = ""


def _ticks_named(column: Name) -> float:
    """Ticks in a second by the unit in the name of a column; 0 where it states none."""
    found = IN_NAME.search(str(column))
    return UNITS[SPELT.get(found[1].lower(), found[1].lower())] if found else 0.0


def unit_of(ticks_per_s: float) -> str:
    """The unit of a clock with so many ticks in a second."""
    return next((unit for unit, own in UNITS.items() if own == ticks_per_s), "tick")


def _clock_of(log: RawLog, column: Name, ticks: float, stated: float | None) -> _Clock:
    """The unit of a column: by what it holds, or by its name and the rate."""
    if (pair := log.pairs.get(column)) is not None:
        why = _("{columns} hold the time in {units}", columns=column, units=listed(pair.units))
        return _Clock("s", 1.0, why)
    if column in log.dates:
        return _Clock("iso8601", 1.0, _("it holds dates"))
    return _clock(column, ticks, stated)


def _clock(column: Name, ticks: float, stated: float | None) -> _Clock:
    """The unit of a column with so many ticks from row to row.

    By the rate that a header states, Hz, by its name, else by a plausible rate. A name is wrong
    that contradicts the header, or by which the rate is that of no IMU.
    """

    def away(ticks_per_s: float, rate: float) -> float:
        return abs(float(np.log(ticks_per_s / ticks / rate)))

    likely = min(UNITS.values(), key=lambda each: away(each, USUAL_RATE))
    by_header = min([*UNITS.values(), *TICKS], key=lambda each: away(each, stated or USUAL_RATE))
    agrees = stated is not None and away(by_header, stated) < np.log(MAX_OFF_STATED)
    if agrees:
        likely = by_header
    if not (named := _ticks_named(column)):
        step = significant(ticks, 6)
        if agrees:
            why = _(
                "with a tick of {tick} a step of {ticks} is the rate that the header states",
                tick=tick_in_words(likely),
                ticks=step,
            )
            return _Clock(unit_of(likely), likely, why)
        why, doubt = _of_two_units(ticks, likely) or (
            _(
                "a step of {ticks} is a plausible rate in {unit} only",
                ticks=step,
                unit=unit_of(likely),
            ),
            "",
        )
        return _Clock(unit_of(likely), likely, why, guessed=True, doubt=doubt)
    unit = unit_of(named)
    told = _("{column} counts {unit} by its name", column=column, unit=unit.replace("us", "µs"))
    plausible = MIN_RATE <= named / ticks <= MAX_RATE
    if (named == likely) or (plausible and not agrees):
        return _Clock(unit, named, told)
    if not agrees and not MIN_RATE <= likely / ticks <= MAX_RATE:
        return _Clock(unit, named, told)
    by_name, rate = significant(named / ticks), significant(likely / ticks)
    why = (
        _(
            "the name of {column} says {unit}, {named} Hz; the header states the rate",
            column=column,
            unit=unit,
            named=by_name,
        )
        if agrees
        else _(
            "the name of {column} says {unit}, {named} Hz, the rate of no IMU",
            column=column,
            unit=unit,
            named=by_name,
        )
    )
    doubt = _(
        "its name says {unit}, by which there are {named} samples a second; the draft takes ticks "
        "of {taken}, {rate} samples a second. Which is right?",
        unit=unit,
        named=by_name,
        taken=tick_in_words(likely),
        rate=rate,
    )
    return _Clock(unit_of(likely), likely, why, guessed=True, doubt=doubt)


def _of_two_units(ticks: float, likely: float) -> tuple[str, str] | None:
    """What is seen and asked where a step of so many ticks is a rate of IMUs in two units, or None.

    `likely`: ticks in a second of the likelier one, in which the rate is no common one.
    """
    within = (MIN_RATE, COMMON_RATES[-1])
    units = [each for each in UNITS.values() if within[0] <= each / ticks <= within[1]]
    if common_rate(likely / ticks) is not None or not set(units) - {likely}:
        return None
    rates = listed([f"{significant(each / ticks)} ({unit_of(each)})" for each in units])
    step = significant(ticks, 6)
    why = _("a step of {ticks} ticks is {rates} samples a second", ticks=step, rates=rates)
    question = _(
        "{why}, none of which is usual; how many are there? Draft it again with RATE=, or --rate, "
        "which replaces this file while nobody has edited it",
        why=why,
    )
    return why, question


def tick_in_words(ticks_per_s: float) -> str:
    """The tick of a clock: 1 µs, 0.1 ms."""
    unit = unit_of(ticks_per_s).replace("us", "µs")
    return f"{1e3 / ticks_per_s:g} ms" if unit == "tick" else f"1 {unit}"


def nearly_as_usual(rate: float, other: float) -> bool:
    """Whether a rate may be that of an IMU, Hz, and is about as usual as another."""
    away = [abs(np.log(each / USUAL_RATE)) for each in (rate, other)]
    return bool(MIN_RATE <= rate <= MAX_RATE and away[0] < away[1] + np.log(MAX_LESS_USUAL))


def _by_intervals(logs: Sequence[RawLog], stated: float | None) -> Timing | None:
    """The rate by a column that holds the time from row to row; None where none does."""
    for name in filter(lambda own: INTERVAL.match(str(own)), logs[0].columns):
        steps = np.concatenate([finite(log.columns[name]) for log in logs])
        if steps.min() < 0 or not steps.mean() > 0:
            continue
        clock = _clock(name, float(steps.mean()), stated)
        rate = clock.ticks_per_s / float(steps.mean())
        why = _(
            "no column is a time; {column} is the time from row to row, in ticks of {tick}, and "
            "its mean states the rate",
            column=name,
            tick=tick_in_words(clock.ticks_per_s),
        )
        return Timing(None, None, rate, bool(clock.doubt), why)
    return None


def _first_back(counters: Sequence[Array], second: float) -> tuple[int, float] | None:
    """The first row, from 0, before which a clock goes back by over a second, and by how much."""
    for counter in counters:
        steps = np.diff(counter)
        if (back := np.flatnonzero(steps < -second)).size:
            return int(back[0]) + 1, float(-steps[back[0]])
    return None


def _without_time(column: Name | None, unit: str | None, stated: float | None, why: str) -> Timing:
    if stated is not None:
        return Timing(column, unit, stated, False, _("{why}; the header states the rate", why=why))
    return Timing(column, unit, USUAL_RATE, True, why)


def _wraps_at(counters: Sequence[Array]) -> int | None:
    """The power of two at which a counter begins again; None where it does not."""
    last = {
        int(c[n]) + 1 for c in counters for n in np.flatnonzero((np.diff(c) < 0) & (c[1:] == 0))
    }
    return last.pop() if len(last) == 1 and np.log2(min(last)).is_integer() else None


def _period(counters: Sequence[Array]) -> int | None:
    """The power of two after which counters of ticks go on from 0; None where they do not.

    With it the step back is a step on like the others.
    """
    periods = set()
    for counter in counters:
        steps = np.diff(counter)
        usual = np.median(steps)
        for back in steps[steps < 0].tolist():
            period = 2.0 ** np.round(np.log2(usual - back))
            periods.add(period if abs(back + period - usual) < MAX_STEP * usual else np.nan)
    period = periods.pop() if len(periods) == 1 else np.nan
    return int(period) if period > MIN_PERIOD else None


def _finite(values: Array) -> Array:
    return values[np.isfinite(values)]


def _step(values: Array) -> float:
    """Ticks from row to row: of most parts of the log, so that gaps do not count.

    Where several rows have one stamp, as of whole seconds, of all stamps that follow by one tick.
    A step back, where a counter begins again, is taken for a usual step.
    """
    steps = np.diff(values)
    steps[steps < 0] = max(float(np.median(steps)), 0.0)
    values = np.concatenate([values[:1], values[0] + np.cumsum(steps)])
    new = np.flatnonzero(steps > 0)
    tick = float(steps[new].min(initial=np.inf))
    if np.median(steps) == 0 and np.mean(steps[new] == tick) > MIN_SINGLE_TICKS:
        single = steps[new[1:]] == tick
        return tick / float(np.diff(new)[single].mean())
    places = np.unique(np.linspace(0, len(values) - 1, CLOCK_PARTS + 1).astype(int))
    step = float(np.median(np.diff(values[places]) / np.diff(places)))
    whole = float(np.median(steps))
    return whole if abs(whole - step) < 1e-3 * step else step


def common_rate(rate: float) -> float | None:
    """The common rate that this one may be; None where it is near none."""
    nearest = float(COMMON_RATES[np.argmin(np.abs(np.log(COMMON_RATES / rate)))])
    return nearest if abs(nearest / rate - 1) < MAX_RATE_ERROR else None
