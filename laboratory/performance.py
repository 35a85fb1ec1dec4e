"""A campaign is performed: the table turns, the IMU senses, the receiver writes."""

from collections.abc import Mapping, Sequence
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
from laboratory.recording import LogTruth, Recording
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
    logs: dict[str, bytes] = {}
    truths: dict[str, LogTruth] = {}
    first = 0  # ns from the campaign's first sample to the first of this log
    for log, manoeuvres in logs_of(specification.manoeuvres).items():
        stretches = lay_out(manoeuvres, placements, receiver.interval, specification.change_seconds)
        stamps = first + receiver.step * np.arange(sum(s.samples for s in stretches))
        truths[log] = happen(log, stretches, stamps, effects, specification)
        logs[log] = record(log, truths[log], specification.start + stamps, specification)
        first = int(stamps[-1]) + specification.pause
    return Recording(specification.campaign, logs, truths, placements)


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
    motion = move(instants, stretch.attitude, turnings)
    pulls = [effect.pulls(motion) for effect in effects.values()]
    return sense(motion, site, [pull for pull in pulls if pull is not None])


def record(log: str, truth: LogTruth, stamps: Counts, specification: Specification) -> bytes:
    """The log as it is on the disk, after its faults; stamps: ns of GPS time, (n,)."""
    samples = Samples(stamps, truth.accelerometer, truth.gyro)
    for fault in specification.faults:
        if fault.log == log:
            samples = fault.spoils(samples)
    receiver = specification.receiver
    return log_bytes(samples, receiver.status, receiver.line_end)


def total(readings: Sequence[Reading | None], rows: int) -> Reading:
    """What several causes add together."""
    return sum((reading for reading in readings if reading is not None), start=nothing(rows))


def running(increments: Sequence[Reading]) -> Reading:
    """Running sums over the stretches of a log."""
    return Reading(
        np.cumsum(np.concatenate([part.accelerometer for part in increments]), axis=0),
        np.cumsum(np.concatenate([part.gyro for part in increments]), axis=0),
    )
