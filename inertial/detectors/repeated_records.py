"""Records that are in a log twice, or hold the readings of earlier ones: some, or throughout."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Booleans, Integers
from inertial.sensors import COLUMNS, PLURAL
from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import records_of_a_reading, runs
from inertial.signal.stamps import kinds, sent_again
from inertial.text.messages import _, listed
from inertial.text.numbers import counted, fixed, p_is, significant

# Share of stamps that stand still while the readings change: above it the stamps are so coarse
# that equal readings with equal stamps may be another sample.
MAX_CHANCE_EQUAL = 0.05


class Duplicate(Detector):
    """A record whose stamp and readings were in the log before.

    Right before, where a line was written twice or a packet came twice, of which the second may be
    stamped as it came; or farther back, where logs were joined that overlap. What lies farther back
    than the piece shows is not seen.

    A sum counts it twice: at 10 °/s and 100 Hz a turn gains 0.1° with each.
    """

    name = "duplicate"
    source = "design study, 41c: by chance six readings are equal once in 10⁷ pairs or less"
    unit = "records"
    severity = 1
    masks = True
    repeats = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        repeated = _repeated(piece)
        for start, end in runs(repeated):
            after = float(piece.time[start] - np.nanmax(piece.time[:start]))
            yield piece.event(start, end, float(end - start), facts=after)

    def describe(self, event: Event, name: str) -> Description:
        single = event.size == 1
        what = _(
            "{counted} from line {line}",
            counted=counted(int(event.size), "record"),
            line=event.line,
        )
        does = _("repeats") if single else _("repeat")
        where = _("the one before, stamp and all")
        if event.facts:
            earlier = _("earlier ones, stamps and all")
            where = earlier if event.facts < 0 else _("the one before, too soon for a sample")
        many = _("it") if single else _("them")
        return Description(
            _(
                "{name}: {what} {does} {where}, at {from_s} s.",
                name=name,
                what=what,
                does=does,
                where=where,
                from_s=fixed(event.from_s, 3),
            ),
            _(
                "A sum over time would count {value} twice: the angle of a turn by the rate "
                "times {counted}; the mean of a rest hardly moves.",
                value=many,
                counted=counted(int(event.size), "sample interval"),
            ),
            _(
                "{value} masked, and no time is counted for {value_2}.",
                value=_("It is") if single else _("They are"),
                value_2=many,
            ),
        )


def _repeated(piece: Piece) -> Booleans:
    """Which records were there before, (n,)."""
    repeated = sent_again(piece.time, piece.values)
    time = np.where(np.isnan(piece.time), np.inf, piece.time)
    again = np.zeros(len(piece), bool)
    again[1:] = time[1:] <= np.maximum.accumulate(time)[:-1]
    again &= np.isfinite(piece.time)
    if not again.any():
        return repeated
    concerned = np.flatnonzero(np.isin(piece.time, piece.time[again]))
    concerned = concerned[np.isfinite(piece.values[concerned]).any(axis=1)]
    if not len(concerned):
        return repeated
    stamps, values = piece.time[concerned], piece.values[concerned]
    # Accelerometers and gyros may come in rows of their own, with one stamp.
    kinds = np.isnan(values) @ (1 << np.arange(6))
    same_stamp = _seen_before(np.column_stack([stamps, kinds]))
    whole = _seen_before(np.column_stack([stamps, np.nan_to_num(values, nan=np.inf)]))
    if _coarse(stamps, same_stamp & ~whole, len(piece)):
        return repeated
    repeated[concerned[whole]] = True
    return repeated


def _seen_before(rows: Array) -> Booleans:
    """Which of n rows are equal to one before them, (n,)."""
    first: Integers = np.unique(rows, axis=0, return_index=True)[1]
    before: Booleans = np.ones(len(rows), bool)
    before[first] = False
    return before


def _coarse(stamps: Array, changed: Booleans, records: int) -> bool:
    """Whether time often stands still while the readings change."""
    still = np.append(False, np.diff(stamps) == 0) & changed
    return bool(np.count_nonzero(still) > MAX_CHANCE_EQUAL * records)


MAX_CHANCE = 1e-3  # in all logs; of a copy in its own. What is less probable is not random
SIDE_PAIRS = 100  # pairs on each side of a run by which its chance is judged
# Pairs on each side, where half of the channels are equal, or more than usual: a swing turns round.
CLOSE_COUNTS = (1, 3, 10)
MIN_EXCESS_SIGMA = 3.0  # sigma, more than usual
BISECTIONS = 40  # of the interval in which the chance lies
MIN_COPIED = 8  # records in a row that are copied
DEPENDENT = 0.5  # power of the chance that all channels change alike: as if half of them were free
MAX_USUAL_RUNS = 3.0  # times the records that a slower sensor has for each reading
# Of the readings of a record, in a sum that is the same only where all of them are.
SUM_WEIGHTS = np.sqrt([2.0, 3.0, 5.0, 7.0, 11.0, 13.0])


@dataclass(frozen=True)
class _Facts:
    """How many channels are held; the line that was copied, None where it is the one before."""

    channels: int
    copied: int | None = None


class HeldRecord(Detector):
    """A record whose readings are all equal to those of the one before, though time goes on.

    With the coarse counts of a consumer MEMS that happens by chance. The chance of a run of r
    records is (number of records in all logs) × Pʳ, with P the chance that a pair is equal in all
    channels. It follows from the pairs that are not: how often a channel is equal in them, beside
    the run and in the whole, the larger counts. For a run of more than one it is also judged by how
    often the readings that are held come beside it. A channel that never changes does not count.

    Or records whose readings are, in their order, those of a stretch before, where there are no
    stamps that would be repeated too: see `_copied`.

    Where a sensor is slower than its log that is so all the time, and only longer runs count.

    Cause: the logger wrote the last record again where it had no new one. A sum over time takes old
    readings for new ones, so the scale factor of a turn is wrong.
    """

    name = "held_record"
    source = "design study, 41c: identical consecutive readings of all six channels"
    unit = "records"
    severity = 1
    alike = "sensor"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        for places, channels in kinds(piece):
            changing = channels[log.least[channels] < log.most[channels]]
            values = piece.values[np.ix_(places, changing)]
            if len(values) == len(piece):
                yield from self._copies(piece, values, log.records)
            if not _any_equal(values):
                continue
            searched = max(log.records, log.records_of_all)
            slower = min(log.held[sensor] for sensor in set((changing // 3).tolist()))
            usual = MAX_USUAL_RUNS / (1 - slower) if slower else 0.0
            for start, end, chance in _held(values, searched, usual):
                # The rows of another sensor may lie between; they are not concerned.
                own = places[start + 1 : end + 1]
                whole = own[-1] - own[0] + 1 == len(own)
                for part in [own] if whole else own[:, None]:
                    first, last, size = int(part[0]), int(part[-1]) + 1, float(len(part))
                    facts = _Facts(len(changing))
                    yield piece.event(first, last, size, p_value=chance, facts=facts)

    def _copies(self, piece: Piece, values: Array, records: int) -> Iterator[Event]:
        for start, end, before, chance in _copied(values, records):
            facts = _Facts(values.shape[1], int(piece.line[before]))
            yield piece.event(start, end, float(end - start), p_value=chance, facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        single = event.size == 1
        records = counted(int(event.size), "record")
        at = f", {fixed(event.from_s, 3)} s," if np.isfinite(event.from_s) else ""
        if event.facts.copied is not None:
            return Description(
                _(
                    "{name}: {records} from line {line}{at} have, in their order, the readings of "
                    "those from line {copied} on in all {channels} channels, though time goes on; "
                    "by chance that happens with {p_value} in this log.",
                    name=name,
                    records=records,
                    line=event.line,
                    at=at,
                    copied=event.facts.copied,
                    channels=event.facts.channels,
                    p_value=p_is(event.p_value),
                ),
                _(
                    "If they are in the log twice, all that comes after them was taken earlier "
                    "than its place in the log says; if they were written in place of others, what "
                    "the IMU did meanwhile is unknown."
                ),
                _(
                    "They are masked; time passes with them. Look for logs that were joined, and "
                    "at the logger's buffer."
                ),
            )
        return Description(
            _(
                "{name}: {records} from line {line}{at} {value} the readings of the one before "
                "in all {facts} channels, though time goes on; by chance that happens with "
                "{p_value} in this campaign.",
                name=name,
                records=records,
                line=event.line,
                at=at,
                value=_("has") if single else _("have"),
                facts=event.facts.channels,
                p_value=p_is(event.p_value),
            ),
            _(
                "Used, a sum over time would take old readings for new ones: while it turns the "
                "angle is then unknown by what the rate changes in {records}; a mean hardly "
                "moves, the noise seems smaller.",
                records=records,
            ),
            _(
                "{value} masked; time passes with {value_2}. Look at the logger's buffer and "
                "cable.",
                value=_("It is") if single else _("They are"),
                value_2=_("it") if single else _("them"),
            ),
        )


def _any_equal(values: Array) -> bool:
    """Whether any pair of neighbours of (n, c) is equal in all channels; not without channels."""
    before, after = np.arange(len(values) - 1), np.arange(1, len(values))
    for channel in values.T:
        equal = channel[after] == channel[before]
        before, after = before[equal], after[equal]
    return values.shape[1] > 0 and len(before) > 0


def _held(values: Array, records: int, usual: float) -> Iterator[tuple[int, int, float]]:
    """Runs of pairs of neighbours, of (n, c), that are equal by no chance, and their chance.

    `usual`: pairs of a run that the sensors have anyhow, for they are slower than the log.
    """
    equal = values[1:] == values[:-1]
    whole = np.asarray(equal.all(axis=1))
    edges = np.array(list(runs(whole)), np.int64).reshape(-1, 2)
    edges = edges[np.diff(edges, axis=1)[:, 0] > usual]
    if not len(edges):
        return
    start, end = edges.T
    length = end - start
    likely = _likely(equal, whole, start, end)
    for k in np.flatnonzero(records * likely**length < MAX_CHANCE):
        a, b = int(start[k]), int(end[k])
        if b > a + 1:
            beside = np.r_[max(a - SIDE_PAIRS, 0) : a, b + 1 : min(b + 1 + SIDE_PAIRS, len(values))]
            same = ((values[beside] == values[a]).sum(axis=0) + 1) / (len(beside) + 2)
            likely[k] = max(likely[k], same.prod())
        chance = records * float(likely[k]) ** (b - a)
        if chance < MAX_CHANCE:
            yield a, b, chance


def _copied(values: Array, records: int) -> Iterator[tuple[int, int, int, float]]:
    """Runs of records, of (n, c), with the readings of a stretch before: with its first record.

    The chance of a run of r records is (pairs of records in the log) × Pʳ⁻¹, P that two steps from
    record to record are alike in all channels, each by the steps of the whole or of the run itself,
    the larger counts: what stands still copies itself. Channels may move together, so not all of
    their steps count as independent.
    """
    keys = np.zeros(len(values))
    for channel, weight in zip(values.T, SUM_WEIGHTS, strict=False):
        keys += weight * channel
    order = np.argsort(keys, kind="stable")
    again = np.flatnonzero(keys[order][1:] == keys[order][:-1]) + 1
    before = np.full(len(values), -1)
    before[order[again]] = order[again - 1]
    lag = np.where(before >= 0, np.arange(len(values)) - before, 0)
    edges = np.flatnonzero(np.diff(lag, prepend=-1, append=-1) != 0)
    long = np.flatnonzero((np.diff(edges) >= MIN_COPIED) & (lag[edges[:-1]] >= MIN_COPIED))
    usual: Array | None = None
    reached = 0
    for start, end in zip(edges[long].tolist(), edges[long + 1].tolist(), strict=True):
        back = int(lag[start])
        if start < reached or (values[start:end] != values[start - back : end - back]).any():
            continue
        # A record that by chance is like a later one, too, does not part them.
        while end < len(values) and (values[end] == values[end - back]).all():
            end += 1
        while start > max(reached, back) and (values[start - 1] == values[start - 1 - back]).all():
            start -= 1
        reached = end
        usual = _alike(np.diff(values, axis=0)) if usual is None else usual
        alike = np.maximum(usual, _alike(np.diff(values[start:end], axis=0)))
        chance = records**2 / 2 * float(alike.prod()) ** (DEPENDENT * (end - start - 1))
        if chance < MAX_CHANCE:
            yield start, end, start - back, chance


def _alike(steps: Array) -> Array:
    """The chance that two of (n, c) steps are alike, by channel, (c,)."""
    shares = (np.unique(own, return_counts=True)[1] / len(own) for own in steps.T)
    return np.array([np.sum(share**2) for share in shares])


def _likely(equal: Booleans, whole: Booleans, start: Integers, end: Integers) -> Array:
    """The chance that a pair beside each of k runs is equal in all channels, (k,).

    By the pairs that are not, so that records that are held do not hide themselves; before the run
    or after it, for a motion may end there. Where a swing turns round, all channels stand still
    together: there by the pairs that are next to it.
    """
    pairs = len(equal)
    other = np.zeros((pairs + 1, equal.shape[1] + 1))
    np.cumsum(np.column_stack([equal, np.ones(pairs)]) * ~whole[:, None], axis=0, out=other[1:])

    def beside(distance: int) -> list[Array]:
        before, after = np.maximum(start - distance, 0), np.minimum(end + distance, pairs)
        return [other[start] - other[before], other[after] - other[end]]

    likely = np.repeat(_all_equal(_shares(other[-1:])), len(start))
    for side, usual in enumerate(beside(SIDE_PAIRS)):
        shares = _shares(usual)
        there = usual[:, -1] > 0  # not beyond the ends of the log
        likely = np.maximum(likely, np.where(there, _all_equal(shares), 0.0))
        for distance in CLOSE_COUNTS:
            counts = beside(distance)[side]
            observed, expected = counts[:, :-1].sum(axis=1), counts[:, -1] * shares.sum(axis=1)
            more = observed > expected + MIN_EXCESS_SIGMA * np.sqrt(expected + 1)
            more |= observed >= counts[:, -1] * shares.shape[1] / 2
            more &= there
            likely = np.where(more, np.maximum(likely, _all_equal(_shares(counts))), likely)
    return likely


def _shares(counts: Array) -> Array:
    """How often each of c channels is equal, (k, c), by (k, c + 1): how often, of so many.

    Of few pairs it is nearly how often any channel is.
    """
    number, of = counts[:, :-1], counts[:, -1:]
    any_of_them = (number.sum(axis=1, keepdims=True) + 1) / (of * number.shape[1] + 1)
    return np.asarray((number + any_of_them) / (of + 1))


def _all_equal(shares: Array) -> Array:
    """The chance P that all channels are equal, (k,), if each is equal by itself.

    shares: (k, c), how often each is equal where not all are: s = (p − P)/(1 − P), P = Πp. If less
    than one channel changes in such a pair there is no P below 1.
    """
    low, high = np.zeros(len(shares)), np.ones(len(shares))
    for _unused in range(BISECTIONS):
        middle = (low + high) / 2
        more = (shares * (1 - middle[:, None]) + middle[:, None]).prod(axis=1) > middle
        low, high = np.where(more, middle, low), np.where(more, high, middle)
    return high


# ---- A sensor that measures less often than its log has records.


SAME_SHARE = 0.02  # of records held, of two sensors with one cause


@dataclass(frozen=True)
class _Slower:
    """Which sensors, accel and gyro, or one of them; s, of a record."""

    sensors: tuple[str, ...]
    step: float


class SlowerSensor(Detector):
    """A sensor that gives fewer readings than its log has records, so that each is there again.

    Throughout the log, in a tenth of the records or more, and with counts so fine that its axes
    hardly ever repeat a reading one by one: see `ChannelStatistics`.

    Cause: the logger asks more often than the sensor measures. A reading that is held until the
    next one counts for the time between them, so means and sums over time are right.
    """

    name = "slower_sensor"
    source = "sample-and-hold: the mean of a held signal is that of its readings"
    unit = "records"
    severity = 1
    alike = "sensor"

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        slower = [name for name, share in zip(COLUMNS, log.held, strict=True) if share]
        together = len(slower) == 2 and abs(np.diff(log.held)[0]) < SAME_SHARE
        for sensors in [slower] if together else [[name] for name in slower]:
            share = float(log.held[list(COLUMNS).index(sensors[0])])
            yield log.event(
                records_of_a_reading(share),
                sensor=None if together else sensors[0],
                facts=_Slower(tuple(sensors), log.interval),
            )

    def describe(self, event: Event, name: str) -> Description:
        known = np.isfinite(event.facts.step)
        rate = 1 / event.facts.step if known else np.nan
        at = _(
            ": {readings} readings a second in {records} records",
            readings=significant(rate / event.size, 3),
            records=significant(rate, 3),
        )
        return Description(
            _(
                "{name}: each reading of the {sensors} is there {times} times{at}.",
                name=name,
                sensors=listed([PLURAL[sensor] for sensor in event.facts.sensors]),
                times=significant(event.size, 3),
                at=at if known else "",
            ),
            _(
                "Means and sums over time stay right, for a reading counts for the time until the "
                "next; records are not independent of each other, which the noise contains."
            ),
            _(
                "Nothing is changed. Log at the rate of the sensor, or when it has new data, to "
                "save the space."
            ),
        )
