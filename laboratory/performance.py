"""A campaign is performed: the table turns, the IMU senses, the receiver writes."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from laboratory.arrays import Array, Counts
from laboratory.counts import count
from laboratory.effects.effect import Effect
from laboratory.gps_time import NANOSECONDS
from laboratory.instants import NODES_PER_INTERVAL, Instants
from laboratory.layout import Stretch, lay_out, logs_of
from laboratory.motion import Turning, move
from laboratory.placement import place
from laboratory.profiles import Profile, Standing
from laboratory.rawimu import Samples
from laboratory.recording import LogTruth, Recording, Spoiled
from laboratory.records import Records
from laboratory.sensor import Reading, Sensors, nothing, read
from laboratory.site import Site
from laboratory.specification import Specification
from laboratory.temperature import Temperature
from laboratory.truth import Truth, sense

Effects = Mapping[str, Effect]


def perform(specification: Specification) -> Recording:
    """Carry out a whole campaign; the same specification gives the same bytes."""
    effects = specification.effects()
    receiver, handling = specification.receiver, specification.handling
    site = reduce(lambda site, effect: effect.stands(site), effects.values(), specification.site)
    placements = place(
        specification.manoeuvres,
        heading=site.heading,
        position_sigma=specification.position_sigma,
        leaning=lambda manoeuvre, set_attitude: product(
            effect.tilts(manoeuvre, set_attitude) for effect in effects.values()
        ),
        mountings=specification.mountings,
        missed=lambda manoeuvre, set_attitude: product(
            effect.misses(manoeuvre, set_attitude, specification.chance)
            for effect in effects.values()
        ),
        chance=specification.chance,
    )
    logs: dict[str, Records] = {}
    truths: dict[str, LogTruth] = {}
    first = 0  # ns from the campaign's first sample to the first of this log
    for log, manoeuvres in logs_of(specification.manoeuvres).items():
        stretches = lay_out(manoeuvres, placements, handling, carried_out(effects))
        stamps = first + receiver.step * np.arange(sum(s.samples for s in stretches))
        truths[log] = happen(log, stretches, stamps, effects, site, specification)
        told = reduce(lambda stamps, effect: effect.stamps(stamps), effects.values(), stamps)
        samples = Samples(specification.start + told, truths[log].accelerometer, truths[log].gyro)
        logs[log] = receiver.records(samples, truths[log].temperature)
        first = int(stamps[-1]) + specification.pause
    logs = spoil(logs, specification)
    spoiled = [one for log, records in logs.items() for one in spoiled_of(log, records)]
    return Recording(
        specification.campaign, receiver, specification.start, logs, truths, placements, spoiled
    )


def carried_out(effects: Effects) -> Callable[[Profile], Profile]:
    """What the table makes of the turn that it is set to."""
    return lambda profile: reduce(lambda p, effect: effect.sets(p), effects.values(), profile)


def happen(
    log: str,
    stretches: Sequence[Stretch],
    stamps: Counts,
    effects: Effects,
    site: Site,
    specification: Specification,
) -> LogTruth:
    """What happens while one log is written; stamps: ns since the campaign's first sample, (n,)."""
    receiver, sensors = specification.receiver, specification.sensors
    interval, temperature = specification.handling.interval, specification.temperature
    generators = {name: specification.chance.stream("noise", name, log) for name in effects}
    late = sum(effect.delays() for effect in effects.values())
    truths: list[Truth] = []
    readings: list[Reading] = []
    noises: list[Reading] = []
    rows: dict[str, range] = {}
    row = 0
    # By the true time: a clock that runs right leaves the numbers as they are.
    seconds = stamps / NANOSECONDS * (interval / receiver.interval)
    for stretch in stretches:
        # A sample is stamped at the end of its interval.
        start = float(seconds[row]) - interval
        instants = Instants(start, stretch.samples, interval)
        truth = true_of(stretch, instants, site, sensors, temperature, effects)
        reading = sensed(truth, sensors, effects)
        if late:  # the gyros tell what was
            before = true_of(
                stretch, replace(instants, late=late), site, sensors, temperature, effects
            )
            reading = replace(reading, gyro=sensed(before, sensors, effects).gyro)
        noise = [effect.scatters(truth, generators[name]) for name, effect in effects.items()]
        truths.append(truth)
        readings.append(reading)
        noises.append(total(noise, stretch.samples))
        if stretch.manoeuvre is not None:
            rows[stretch.manoeuvre] = range(row, row + stretch.samples)
        row += stretch.samples
    noiseless, noise_sum = running(readings), running(noises)
    noisy = limited(noiseless + noise_sum, interval, effects)
    warmer = np.concatenate([t.warmer[NODES_PER_INTERVAL::NODES_PER_INTERVAL] for t in truths])
    return LogTruth(
        time=seconds,
        rate=np.concatenate([truth.turned for truth in truths]) / interval,
        force=np.concatenate([truth.velocity for truth in truths]) / interval,
        temperature=temperature.reference + warmer,
        noiseless=noiseless,
        noisy=noisy,
        accelerometer=count(noisy.accelerometer, receiver.accelerometer_count),
        gyro=count(noisy.gyro, receiver.gyro_count),
        rows=rows,
    )


def true_of(
    stretch: Stretch,
    instants: Instants,
    site: Site,
    sensors: Sensors,
    temperature: Temperature,
    effects: Effects,
) -> Truth:
    """The truth during one stretch: how the case moves, and what pulls at it."""
    turnings: Sequence[Turning] = []
    if not isinstance(stretch.profile, Standing):
        course = stretch.profile.course(instants.elapsed)
        planned = stretch.manoeuvre is not None
        turnings = [Turning(stretch.axis, *course, stretch.profile.steady_rate, planned)]
    for effect in effects.values():
        turnings = effect.moves(turnings, instants)
    carried = [
        turning
        for effect in effects.values()
        for turning in effect.carries(turnings, stretch.attitude, instants)
    ]
    # What turns the whole table comes first: seen from the case as it stands, its axis leans.
    below = [replace(turning, axis=stretch.attitude.T @ turning.axis) for turning in carried]
    motion = move(instants, stretch.attitude, [*below, *turnings])
    pulls = [effect.pulls(motion, sensors) for effect in effects.values()]
    pulling = [pull for pull in pulls if pull is not None]
    return sense(motion, site, pulling, temperature.above(instants))


def sensed(truth: Truth, sensors: Sensors, effects: Effects) -> Reading:
    """The increments of the sensors without noise, (n, 3) m/s and (n, 3) rad."""
    added = [effect.reads(truth, sensors) for effect in effects.values()]
    return read(sensors, truth, total(added, len(truth.time)))


def limited(noisy: Reading, interval: float, effects: Effects) -> Reading:
    """Running integrals of what the sensors can give: increments beyond their range are cut."""
    increments = Reading(
        np.diff(noisy.accelerometer, axis=0, prepend=0), np.diff(noisy.gyro, axis=0, prepend=0)
    )
    left = reduce(lambda rest, effect: effect.limits(rest, interval), effects.values(), increments)
    return noisy if left is increments else running([left])


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


def product(rotations: Iterable[Array]) -> Array:
    """One rotation after the other, (3, 3)."""
    return reduce(np.matmul, rotations)


def total(readings: Sequence[Reading | None], rows: int) -> Reading:
    """What several causes add together."""
    return sum((reading for reading in readings if reading is not None), start=nothing(rows))


def running(increments: Sequence[Reading]) -> Reading:
    """Running sums over the stretches of a log."""
    return Reading(
        np.cumsum(np.concatenate([part.accelerometer for part in increments]), axis=0),
        np.cumsum(np.concatenate([part.gyro for part in increments]), axis=0),
    )
