"""Simulation of a campaign: motion of the table, sensors, receiver, faults."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import reduce

import numpy as np

from laboratory.arrays import Array, Counts
from laboratory.effects.effect import Effect
from laboratory.gps_time import NANOSECONDS
from laboratory.instants import NODES_PER_INTERVAL, Instants
from laboratory.layout import Segment, lay_out, logs_of
from laboratory.manoeuvre import Manoeuvre
from laboratory.motion import Turning, move
from laboratory.placement import place
from laboratory.profiles import Profile, Standing
from laboratory.rawimu import Samples
from laboratory.recording import LogTruth, Recording, Spoiled
from laboratory.records import Records
from laboratory.sensor import Reading, Sensors, read, zero_reading
from laboratory.site import Site
from laboratory.specification import Specification
from laboratory.temperature import Temperature
from laboratory.truth import Truth, sense

Effects = Mapping[str, Effect]


def perform(specification: Specification) -> Recording:
    """Simulate a whole campaign; the same specification gives the same bytes."""
    effects = specification.effects()
    receiver, handling = specification.receiver, specification.handling
    site = reduce(lambda site, effect: effect.true_site(site), effects.values(), specification.site)
    placements = place(
        specification.manoeuvres,
        heading=site.heading,
        position_sigma=specification.position_sigma,
        leaning=lambda manoeuvre, set_attitude: product(
            effect.table_tilt(manoeuvre, set_attitude) for effect in effects.values()
        ),
        mountings=specification.mountings,
        of_axis=specification.tilted_axis,
        missed=lambda manoeuvre, set_attitude: product(
            effect.position_error(manoeuvre, set_attitude, specification.chance)
            for effect in effects.values()
        ),
        chance=specification.chance,
    )
    logs: dict[str, Records] = {}
    truths: dict[str, LogTruth] = {}
    first = 0  # ns from the campaign's first sample to the first of this log
    for log, manoeuvres in logs_of(specification.manoeuvres).items():
        segments = lay_out(
            manoeuvres,
            placements,
            handling,
            actual_profiles(effects),
            first / NANOSECONDS,
            lambda manoeuvre, set_attitude, set_at: product(
                effect.later_error(manoeuvre, set_attitude, set_at) for effect in effects.values()
            ),
            lambda manoeuvre, set_attitude, set_at: product(
                effect.axis_error(manoeuvre, set_attitude, set_at, specification.chance)
                for effect in effects.values()
            ),
        )
        stamps = first + receiver.step * np.arange(sum(s.samples for s in segments))
        truths[log] = record_log(log, segments, stamps, effects, site, specification)
        written = reduce(lambda stamps, effect: effect.stamps(stamps), effects.values(), stamps)
        samples = Samples(
            specification.start + written, truths[log].accelerometer, truths[log].gyro
        )
        logs[log] = receiver.records(samples, truths[log].temperature, truths[log].table_angle)
        first = int(stamps[-1]) + specification.pause
    logs = apply_faults(logs, specification)
    spoiled = [span for log, records in logs.items() for span in fault_spans(log, records)]
    return Recording(
        specification.campaign, receiver, specification.start, logs, truths, placements, spoiled
    )


def actual_profiles(effects: Effects) -> Callable[[Manoeuvre], Profile]:
    """The actual course of a turn, by the course that is set."""
    return lambda manoeuvre: reduce(
        lambda p, effect: effect.actual_turn(manoeuvre, p), effects.values(), manoeuvre.profile
    )


def record_log(
    log: str,
    segments: Sequence[Segment],
    stamps: Counts,
    effects: Effects,
    site: Site,
    specification: Specification,
) -> LogTruth:
    """The truth of one log; stamps: ns since the campaign's first sample, (n,)."""
    receiver, sensors = specification.receiver, specification.sensors
    interval, temperature = specification.handling.interval, specification.temperature
    generators = {name: specification.chance.stream("noise", name, log) for name in effects}
    for name, effect in effects.items():
        effect.begin_log(generators[name])
    late = {
        "gyro": sum(effect.gyro_delay() for effect in effects.values()),
        "accelerometer": sum(effect.accelerometer_delay() for effect in effects.values()),
    }
    truths: list[Truth] = []
    readings: list[Reading] = []
    noises: list[Reading] = []
    rows: dict[str, range] = {}
    encoder, scale, turned = specification.encoder, list[Array](), 0.0
    row = 0
    # True time: a clock without rate error leaves the numbers unchanged.
    seconds = stamps / NANOSECONDS * (interval / receiver.interval)
    for segment in segments:
        # A sample is stamped at the end of its interval.
        start = float(seconds[row]) - interval
        instants = Instants(start, segment.samples, interval)
        truth = truth_of(segment, instants, site, sensors, temperature, effects)
        reading = noiseless_increments(truth, sensors, effects)
        for sensor, delay in late.items():
            if delay:  # it reads the past
                past = replace(instants, late=delay)
                before = truth_of(segment, past, site, sensors, temperature, effects)
                of_past = getattr(noiseless_increments(before, sensors, effects), sensor)
                reading = replace(reading, **{sensor: of_past})
        if encoder is not None:
            scale.append(turned + encoder.course(segment, instants, effects.values()))
            turned = float(scale[-1][-1])
        noise = [effect.noise(truth, generators[name]) for name, effect in effects.items()]
        truths.append(truth)
        readings.append(reading)
        noises.append(total(noise, segment.samples))
        if segment.manoeuvre is not None:
            rows[segment.manoeuvre] = range(row, row + segment.samples)
        row += segment.samples
    noiseless, noise_sum = running(readings), running(noises)
    noisy = saturated(noiseless + noise_sum, interval, effects)
    recorded = [temperature.course("thermometer", truth.motion.instants) for truth in truths]
    return LogTruth(
        time=seconds,
        rate=np.concatenate([truth.turned for truth in truths]) / interval,
        force=np.concatenate([truth.velocity for truth in truths]) / interval,
        temperature=np.concatenate([t[NODES_PER_INTERVAL::NODES_PER_INTERVAL] for t in recorded]),
        table_angle=None if encoder is None else encoder.readings(np.concatenate(scale)),
        noiseless=noiseless,
        noisy=noisy,
        accelerometer=receiver.counted(noisy.accelerometer, receiver.accelerometer_count),
        gyro=receiver.counted(noisy.gyro, receiver.gyro_count),
        rows=rows,
    )


def truth_of(
    segment: Segment,
    instants: Instants,
    site: Site,
    sensors: Sensors,
    temperature: Temperature,
    effects: Effects,
) -> Truth:
    """The truth during one segment: motion of the case and specific force."""
    turnings: Sequence[Turning] = []
    if not isinstance(segment.profile, Standing):
        turnings = [segment.turning(instants)]
    for effect in effects.values():
        turnings = effect.change_rotations(turnings, instants)
    of_the_table = [
        turning
        for effect in effects.values()
        for turning in effect.table_rotations(turnings, segment.attitude, instants)
    ]
    # Rotations of the whole table come first, with their axes in the axes of the case.
    below = [replace(turning, axis=segment.attitude.T @ turning.axis) for turning in of_the_table]
    motion = move(instants, segment.attitude, [*below, *turnings])
    forces = [effect.extra_force(motion, sensors) for effect in effects.values()]
    extra = [force for force in forces if force is not None]
    return sense(motion, site, extra, temperature)


def noiseless_increments(truth: Truth, sensors: Sensors, effects: Effects) -> Reading:
    """The increments without noise, (n, 3) m/s and (n, 3) rad."""
    errors = [effect.reading_error(truth, sensors) for effect in effects.values()]
    return read(sensors, truth, total(errors, len(truth.time)))


def saturated(noisy: Reading, interval: float, effects: Effects) -> Reading:
    """Running integrals of the readings, with increments limited to the range of the sensors."""
    increments = Reading(
        np.diff(noisy.accelerometer, axis=0, prepend=0), np.diff(noisy.gyro, axis=0, prepend=0)
    )
    inside = reduce(
        lambda rest, effect: effect.recorded_increments(rest, interval),
        effects.values(),
        increments,
    )
    return noisy if inside is increments else running([inside])


def apply_faults(logs: dict[str, Records], specification: Specification) -> dict[str, Records]:
    """The logs of a campaign after its faults, applied one after another."""
    generators = {log: specification.chance.stream("faults", log) for log in logs}
    for fault in specification.faults:
        logs = fault.apply(logs, generators)
    return logs


def fault_spans(log: str, records: Records) -> Iterator[Spoiled]:
    """The records of a log that faults have changed, as numbered at the end."""
    stamps = records.stamps
    for fault, first, after in dict.fromkeys(records.marks):
        if first < len(records):  # else the jump is after the last record
            last = max(first, after - 1)
            yield Spoiled(fault, log, first, last + 1, int(stamps[first]), int(stamps[last]))


def product(rotations: Iterable[Array]) -> Array:
    """The product of rotations, (3, 3)."""
    return reduce(np.matmul, rotations)


def total(readings: Sequence[Reading | None], rows: int) -> Reading:
    """The sum of readings."""
    return sum((reading for reading in readings if reading is not None), start=zero_reading(rows))


def running(increments: Sequence[Reading]) -> Reading:
    """Running sums over the segments of a log."""
    return Reading(
        np.cumsum(np.concatenate([part.accelerometer for part in increments]), axis=0),
        np.cumsum(np.concatenate([part.gyro for part in increments]), axis=0),
    )
