"""A campaign is performed: the table turns, the IMU senses, the receiver writes."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from laboratory.arrays import Counts
from laboratory.counts import count
from laboratory.effects.effect import Effect
from laboratory.gps_time import NANOSECONDS
from laboratory.instants import Instants
from laboratory.layout import Stretch, lay_out, logs_of
from laboratory.motion import Turning, move
from laboratory.placement import place
from laboratory.profiles import Standing
from laboratory.rawimusa import Samples, log_bytes
from laboratory.recording import LogTruth, Recording, Spoiled
from laboratory.records import Records
from laboratory.sensor import Reading, nothing, read
from laboratory.site import Site
from laboratory.specification import Specification
from laboratory.truth import Truth, sense

Effects = Mapping[str, Effect]


def perform(specification: Specification) -> Recording:
    """Carry out a whole campaign; the same specification gives the same bytes."""
    effects = specification.effects()
    receiver = specification.receiver
    placements = place(
        specification.manoeuvres,
        heading=specification.heading,
        position_sigma=specification.position_sigma,
        base=reduce(np.matmul, [effect.tilts() for effect in effects.values()]),
        chance=specification.chance,
    )
    logs: dict[str, Records] = {}
    truths: dict[str, LogTruth] = {}
    first = 0  # ns from the campaign's first sample to the first of this log
    for log, manoeuvres in logs_of(specification.manoeuvres).items():
        stretches = lay_out(manoeuvres, placements, receiver.interval, specification.change_seconds)
        stamps = first + receiver.step * np.arange(sum(s.samples for s in stretches))
        truths[log] = happen(log, stretches, stamps, effects, specification)
        samples = Samples(specification.start + stamps, truths[log].accelerometer, truths[log].gyro)
        logs[log] = receiver.records(samples)
        first = int(stamps[-1]) + specification.pause
    logs = spoil(logs, specification)
    written = {
        log: log_bytes(records.samples, receiver.status, receiver.line_end)
        for log, records in logs.items()
    }
    spoiled = [one for log, records in logs.items() for one in spoiled_of(log, records)]
    return Recording(specification.campaign, written, truths, placements, spoiled)


def happen(
    log: str,
    stretches: Sequence[Stretch],
    stamps: Counts,
    effects: Effects,
    specification: Specification,
) -> LogTruth:
    """What happens while one log is written; stamps: ns since the campaign's first sample, (n,)."""
    receiver, site, sensors = specification.receiver, specification.site, specification.sensors
    generators = {name: specification.chance.stream("noise", name, log) for name in effects}
    truths: list[Truth] = []
    readings: list[Reading] = []
    noises: list[Reading] = []
    rows: dict[str, range] = {}
    row = 0
    for stretch in stretches:
        # A sample is stamped at the end of its interval.
        start = float(stamps[row] - receiver.step) / NANOSECONDS
        truth = true_of(stretch, Instants(start, stretch.samples, receiver.interval), site, effects)
        added = [effect.reads(truth) for effect in effects.values()]
        noise = [effect.scatters(truth, generators[name]) for name, effect in effects.items()]
        truths.append(truth)
        readings.append(read(sensors, truth, total(added, len(truth.time))))
        noises.append(total(noise, stretch.samples))
        if stretch.manoeuvre is not None:
            rows[stretch.manoeuvre] = range(row, row + stretch.samples)
        row += stretch.samples
    noiseless, noise_sum = running(readings), running(noises)
    noisy = noiseless + noise_sum
    return LogTruth(
        time=stamps / NANOSECONDS,
        rate=np.concatenate([truth.turned for truth in truths]) / receiver.interval,
        force=np.concatenate([truth.velocity for truth in truths]) / receiver.interval,
        noiseless=noiseless,
        noisy=noisy,
        accelerometer=count(noisy.accelerometer, receiver.accelerometer_count),
        gyro=count(noisy.gyro, receiver.gyro_count),
        rows=rows,
    )


def true_of(stretch: Stretch, instants: Instants, site: Site, effects: Effects) -> Truth:
    """The truth during one stretch: how the case moves, and what pulls at it."""
    turnings: Sequence[Turning] = []
    if not isinstance(stretch.profile, Standing):
        course = stretch.profile.course(instants.elapsed)
        turnings = [Turning(stretch.axis, *course, stretch.profile.steady_rate)]
    for effect in effects.values():
        turnings = effect.moves(turnings, instants)
    carried = [turning for effect in effects.values() for turning in effect.carries(instants)]
    # What turns the whole table comes first: seen from the case as it stands, its axis leans.
    below = [replace(turning, axis=stretch.attitude.T @ turning.axis) for turning in carried]
    motion = move(instants, stretch.attitude, [*below, *turnings])
    pulls = [effect.pulls(motion) for effect in effects.values()]
    return sense(motion, site, [pull for pull in pulls if pull is not None])


def spoil(logs: dict[str, Records], specification: Specification) -> dict[str, Records]:
    """The logs of a campaign after its faults, one after another."""
    generators = {log: specification.chance.stream("faults", log) for log in logs}
    for fault in specification.faults:
        logs = fault.strikes(logs, generators)
    return logs


def spoiled_of(log: str, records: Records) -> Iterator[Spoiled]:
    """What faults have touched in a log as it is written now."""
    stamps = records.stamps
    for fault, first, after in dict.fromkeys(records.touches):
        if first < len(records):  # else the stamps jump behind the last record: nothing to see
            last = max(first, after - 1)
            yield Spoiled(fault, log, first, last + 1, int(stamps[first]), int(stamps[last]))


def total(readings: Sequence[Reading | None], rows: int) -> Reading:
    """What several causes add together."""
    return sum((reading for reading in readings if reading is not None), start=nothing(rows))


def running(increments: Sequence[Reading]) -> Reading:
    """Running sums over the stretches of a log."""
    return Reading(
        np.cumsum(np.concatenate([part.accelerometer for part in increments]), axis=0),
        np.cumsum(np.concatenate([part.gyro for part in increments]), axis=0),
    )
