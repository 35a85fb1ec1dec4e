"""Plan and recording of each manoeuvre, as the detectors that know the plan compare them."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.detection import Examination, ExaminationOfStretches
from inertial.campaign.encoder import Jump
from inertial.campaign.findings import Detection, Finding, detections_of
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Batch, Masks
from inertial.campaign.records import Manoeuvre, Performed
from inertial.physics.motion import component
from inertial.signal.detector import Detector, Event, Given, Log
from inertial.signal.gravity_turned import rate_of_gravity
from inertial.signal.plan_detector import (
    Deviation,
    Misread,
    PlanDetector,
    Recorded,
    Reversed,
    StaticMeans,
    Swapped,
    Undone,
)
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.tables import ACCEL, GYRO, STATIC_PHASES
from stages.segment.located import Located
from stages.segment.matching import Part, motion
from stages.segment.recording_explanations import ExplainedRecording, in_order, misread_in
from stages.segment.steps import BY_GRAVITY

UNKNOWN = np.full(3, np.nan)
MAX_OF_ROUND = 0.01  # by which a whole number of rounds may be off
QUARTERS = 4  # of the steady part of a turn
MIN_BLOCKS = 5  # of a rest, of which the scatter is known
Place = tuple[int, int, float, float]  # records [first, after), from and to, s
NOWHERE: Place = (-1, -1, np.nan, np.nan)


@dataclass(frozen=True, eq=False)
class Recording:
    """What the samples show of the plan.

    performed : by manoeuvre
    segments, blocks : the tables; temperatures of blocks as recorded
    counts : rad, what a count of the gyros is, by log; NaN where not stated
    stated_angles : rad, by manoeuvre, those of the plan before an encoder's took their place
    angle_sigma, rate_sigma : of the table, rad, and relative, NaN where not stated
    jumps : of the encoder, which are taken out of its angles, by manoeuvre
    """

    performed: Mapping[str, Performed]
    segments: pd.DataFrame
    blocks: pd.DataFrame
    counts: Mapping[str, float]
    stated_angles: Mapping[str, float | None]
    angle_sigma: float
    rate_sigma: float
    jumps: Mapping[str, Sequence[Jump]]


def recorded_of(
    plan: Sequence[Manoeuvre],
    explained: ExplainedRecording,
    undone: Undone,
    recording: Recording,
    given: Given,
    tolerance: float,
) -> Recorded:
    """Plan and recording of each manoeuvre.

    Parameters
    ----------
    explained : what is still not as planned, undone : what was set right
    tolerance : accepted difference of a turn's angle or rate from the plan's, 1
    """
    where = {
        m.name: located for located in explained.located for m in located.binned.window.manoeuvres
    }
    parts = _parts(recording.segments)
    done = [recording.performed[m.name] for m in plan]
    observations = [_shown(m, where[m.name]) for m in plan]
    by_manoeuvre = recording.blocks.groupby("manoeuvre")["temperature"]
    mostly = by_manoeuvre.count() > by_manoeuvre.size() / 2
    warm = by_manoeuvre.mean().where(mostly).to_dict()
    places = [parts.get(m.name) or _instead(m, where[m.name]) for m in plan]
    swapped = [in_order(exchanged, plan) for exchanged in explained.exchanged]
    misread = [
        replace(_beside(each, undone), change=undone.changes.get(each.repair))
        for each in misread_in(plan, explained)
    ]
    jumps = [(i, jump) for i, m in enumerate(plan) for jump in recording.jumps.get(m.name, ())]
    first, after, from_s, to_s = np.array(places).reshape(-1, 4).T
    return Recorded(
        given=given,
        tolerance=tolerance,
        name=[m.name for m in plan],
        log=[m.log for m in plan],
        position=[m.position for m in plan],
        tumble=[m.tumble for m in plan],
        do=[m.do for m in plan],
        steady=np.array([m.recorded == "steady" for m in plan], bool),
        up=_vectors([m.up for m in plan]),
        about=_vectors([m.about for m in plan]),
        angle=_numbers([m.angle for m in plan]),
        stated_angle=_numbers([recording.stated_angles.get(m.name) for m in plan]),
        angle_sigma=recording.angle_sigma,
        rate_sigma=recording.rate_sigma,
        rate=_numbers([m.rate for m in plan]),
        seconds=_numbers([m.seconds for m in plan]),
        found=np.array([d.found for d in done], bool),
        complete=np.array([d.complete for d in done], bool),
        lost=np.array([d.lost for d in done], bool),
        said=[d.sentence for d in done],
        force=_vectors([force for force, _ in observations]),
        turned=_vectors([turned for _, turned in observations]),
        moved=_numbers([d.angle for d in done]),
        speed=_numbers([d.rate for d in done]),
        gravity_rate=_gravity_rates(plan, recording.blocks),
        unsteady=_unsteady(plan, recording.blocks),
        after_stop=_after_stop(plan, recording.blocks),
        turned_farther=_turned_farther(plan, recording.blocks),
        jump_turn=np.array([i for i, _jump in jumps], np.int64),
        jump_size=np.array([jump.size for _i, jump in jumps]),
        jump_sigma=np.array([jump.sigma for _i, jump in jumps]),
        jump_at=np.array([jump.at for _i, jump in jumps]),
        static_means=_static_means(plan, recording.blocks),
        lacking=_numbers([d.missing_angle for d in done]),
        lacking_s=_numbers([d.missing_s for d in done]),
        duration=_numbers([d.seconds for d in done]),
        first=first.astype(np.int64),
        after=after.astype(np.int64),
        from_s=from_s,
        to_s=to_s,
        gyros=np.array([np.isfinite(where[m.name].binned.rates).any(axis=0) for m in plan], bool),
        count=_numbers([recording.counts.get(m.log) for m in plan]),
        temperature=_numbers([warm.get(m.name) for m in plan]),
        stated_temperature=_numbers([m.temperature for m in plan]),
        temperature_sigma=_numbers([m.temperature_sigma for m in plan]),
        gyro_signs=explained.gyro_signs,
        misread=[*undone.misread, *misread],
        swapped=[*undone.swapped, *(_beside(each, undone) for each in swapped)],
        undone=undone,
        divided=[names for located in explained.located for names in located.divided],
    )


Left = TypeVar("Left", Misread, Swapped)


def _beside(left: Left, undone: Undone) -> Left:
    """What is not set right, with what explains as much."""
    return replace(left, rivals=undone.rivals.get(left.repair, ()))


def _gravity_rates(plan: Sequence[Manoeuvre], blocks: pd.DataFrame) -> Array:
    """The rate of gravity in the steady part of each turn, and its sigma, rad/s, (m, 2)."""
    steady = dict(list(blocks[blocks["phase"] == "steady"].groupby("manoeuvre")))
    rates = np.full((len(plan), 2), np.nan)
    for i, m in enumerate(plan):
        if m.rate and m.name in steady:
            own = steady[m.name]
            forces, time = own[list(ACCEL)].to_numpy(np.float64), own["time"].to_numpy(np.float64)
            rates[i] = rate_of_gravity(forces, time, m.rate)
    return rates


def _unsteady(plan: Sequence[Manoeuvre], blocks: pd.DataFrame) -> Array:
    """What the mean rates of quarters of the steady part of each turn scatter by, relative.

    0 where it has less than a block for each.
    """
    steady = blocks[blocks["phase"] == "steady"].groupby("manoeuvre")
    rates = {name: own[list(GYRO)].to_numpy(np.float64) for name, own in steady}
    scatter = np.zeros(len(plan))
    for i, m in enumerate(plan):
        if m.about is None or m.name not in rates:
            continue
        along = component(rates[m.name], m.about)
        along = along[np.isfinite(along)]
        if len(along) >= QUARTERS:
            means = [quarter.mean() for quarter in np.array_split(along, QUARTERS)]
            scatter[i] = np.std(means) / abs(np.mean(means))
    return scatter


def _after_stop(plan: Sequence[Manoeuvre], blocks: pd.DataFrame) -> Array:
    """By what each turn, a whole number of rounds, goes on in the rest after it, rad.

    By the rate there beyond that in the rest before it, about its axis and in its sense; NaN where
    one of the two rests is not recorded. The earth's rate about the axis is the same in both.
    """
    angle = np.full(len(plan), np.nan)
    rests = {
        key: (own[list(GYRO)].to_numpy(np.float64), own["seconds"].to_numpy(np.float64))
        for key, own in blocks.groupby(["manoeuvre", "phase"])
    }
    for i, m in enumerate(plan):
        rounds = 0.0 if m.angle is None else m.angle / (2 * np.pi)
        before, after = (rests.get((m.name, f"rest-{side}")) for side in ("before", "after"))
        if m.about is None or not round(rounds) or abs(rounds - round(rounds)) > MAX_OF_ROUND:
            continue
        if before and after:
            earlier, later = (
                float(np.average(rates @ m.about, weights=seconds))
                for rates, seconds in (before, after)
            )
            angle[i] = np.sign(rounds) * (later - earlier) * after[1].sum()
    return angle


def _turned_farther(plan: Sequence[Manoeuvre], blocks: pd.DataFrame) -> Array:
    """The angle of each turn by its gyros less what they read at rest in its position, rad, (m,).

    So without bias and earth's rate about its axis, which stands still in the room; NaN where a
    part of it, or such a rest, is not recorded.
    """
    angle = np.full(len(plan), np.nan)
    position = blocks["manoeuvre"].map({m.name: m.position for m in plan})
    static = blocks["phase"].isin(STATIC_PHASES).to_numpy()
    rests = dict(list(blocks[static].groupby(position[static])))
    turns = dict(list(blocks[~static].groupby("manoeuvre")))
    for i, m in enumerate(plan):
        if m.about is None or m.do != "turn" or m.name not in turns or m.position not in rests:
            continue
        rest, turn = rests[m.position], turns[m.name]
        at_rest, turning = (
            component(part[list(GYRO)].to_numpy(np.float64), m.about) for part in (rest, turn)
        )
        known = np.isfinite(at_rest) & (rest["seconds"].to_numpy(np.float64) > 0)
        if not known.any() or (turn["missing_s"] != 0).any():
            continue
        still = float(np.average(at_rest[known], weights=rest["seconds"][known]))
        angle[i] = float(np.sum((turning - still) * turn["seconds"].to_numpy(np.float64)))
    return angle


def _static_means(plan: Sequence[Manoeuvre], blocks: pd.DataFrame) -> StaticMeans:
    """The means of all rests with readings of all three accelerometers, in the order of time."""
    places = {m.name: i for i, m in enumerate(plan)}
    own = blocks[blocks["phase"].isin(STATIC_PHASES) & blocks["manoeuvre"].isin(places)]
    known = np.isfinite(own[[*ACCEL, "time"]].to_numpy(np.float64)).all(axis=1)
    own = own[known & (own["seconds"].to_numpy(np.float64) > 0)]
    rests = []
    for (name, phase), rest in own.groupby(["manoeuvre", "phase"], sort=False):
        seconds = rest["seconds"].to_numpy(np.float64)
        force = rest[list(ACCEL)].to_numpy(np.float64)
        off = np.abs(force - np.median(force, axis=0)) * np.sqrt(seconds)[:, None]
        rests.append(
            (
                places[str(name)],
                str(phase) == "rest-after",
                np.average(force, axis=0, weights=seconds),
                float(np.average(rest["time"], weights=seconds)),
                float(seconds.sum()),
                MAD_TO_SIGMA * np.median(off, axis=0) if len(rest) >= MIN_BLOCKS else UNKNOWN,
            )
        )
    rests.sort(key=lambda rest: (rest[0], rest[1]))
    number, after, force, time, seconds, scatter = zip(*rests, strict=True) if rests else ((),) * 6
    return StaticMeans(
        np.array(number, np.int64),
        np.array(after, bool),
        np.array(force, np.float64).reshape(-1, 3),
        np.array(time, np.float64),
        np.array(seconds, np.float64),
        np.array(scatter, np.float64).reshape(-1, 3),
    )


def _parts(segments: pd.DataFrame) -> dict[str, Place]:
    """For each manoeuvre the records and times of its rest, or of all its motion."""
    own = segments[~segments["phase"].isin(("rest-before", "rest-after"))]
    return {
        str(name): (
            int(rows["from_record"].min()),
            int(rows["to_record"].max()),
            float(rows["from_s"].iloc[0]),
            float(rows["to_s"].iloc[-1]),
        )
        for name, rows in own.groupby("manoeuvre")
    }


def _candidate(m: Manoeuvre, located: Located) -> int | None:
    """The stretch of a manoeuvre; of one that is not found, what the log has instead.

    That is the longest of its kind in a log of its own; in one of several the longest rest that is
    nothing else, at least half as long as planned, between the second found before it and the
    second behind it.
    """
    place, seen = located.place(m), located.observed
    if place is not None:
        return place
    first, after, least = 0, len(seen), 0.0
    if not located.binned.window.alone:
        if m.do != "rest":
            return None
        here = [other.name for other in located.plan].index(m.name)
        places = [located.place(other) for other in located.plan]
        before, behind = ([k for k in p if k is not None] for p in (places[:here], places[here:]))
        first = before[-2] + 1 if len(before) > 1 else 0
        after = behind[1] if len(behind) > 1 else after
        least = (m.seconds or 0.0) / 2
    own = [k for k in range(first, after) if seen[k].moves is (m.do != "rest")]
    own = [k for k in own if seen[k].seconds >= least and k not in located.matched.values()]
    return max(own, key=lambda k: seen[k].seconds, default=None)


def _instead(m: Manoeuvre, located: Located) -> Place:
    place = _candidate(m, located)
    if place is None:
        return NOWHERE
    binned, stretch = located.binned, located.stretches[place]
    times = binned.first_s[stretch.first], binned.last_s[stretch.after - 1]
    records = binned.edges[stretch.first], binned.edges[stretch.after]
    return int(records[0]), int(records[1]), float(times[0]), float(times[1])


def _shown(m: Manoeuvre, located: Located) -> tuple[Array | None, Array | None]:
    """The mean force at its rest, or at that before its turn, and the angles of its motion."""
    place = _candidate(m, located)
    if m.do == "positions" or place is None:
        return None, None
    if m.do == "rest":
        return located.observed[place].force, None
    before = located.rest_before(m)
    turned = located.observed[place].turned
    if located.binned.window.alone:
        first, after = motion(located.binned, located.stretches, place)
        pairs = zip(located.stretches, located.observed, strict=True)
        own = [w.turned for s, w in pairs if first <= s.first and s.after <= after]
        turned = np.asarray(np.sum(own, axis=0))
    return None if before is None else located.observed[before].force, turned


def _vectors(values: Sequence[Array | None]) -> Array:
    return np.array([UNKNOWN if value is None else value for value in values]).reshape(-1, 3)


def _numbers(values: Sequence[float | None]) -> Array:
    return np.array([np.nan if value is None else value for value in values], np.float64)


# ---- What disagrees with the plan, and what the detectors of rests see, as findings.


def compare(
    stage: str, detectors: Sequence[PlanDetector], recorded: Recorded
) -> list[tuple[Detection, str]]:
    """Everything in which the recording is not as planned, in the order of detectors and plan.

    Each with the id of its repair, empty where there is none.
    """
    return [
        (_told(stage, detector, deviation, recorded), deviation.repair)
        for detector in detectors
        for deviation in detector.detect(recorded)
    ]


def _told(
    stage: str, detector: PlanDetector, deviation: Deviation, recorded: Recorded
) -> Detection:
    words = detector.describe(deviation, recorded)
    manoeuvre = None if deviation.at is None else recorded.name[deviation.at]
    place = [manoeuvre] if manoeuvre else [deviation.log] if deviation.log else []
    # A sensor as a whole may be concerned as well as the other one.
    place = [*place, deviation.sensor] if detector.sensor is None and deviation.sensor else place
    # So may the turns about each axis.
    place += [deviation.axis] if isinstance(deviation.facts, Reversed) and deviation.axis else []
    place += [BY_GRAVITY] if deviation.repair.endswith(BY_GRAVITY) else []
    finding = Finding(
        id="/".join([stage, detector.name, *(str(part) for part in place)]),
        cause=detector.name,
        sentence=words.sentence,
        consequence=words.consequence,
        action=words.action,
        severity=deviation.severity or detector.severity,
        sensor=deviation.sensor,
        axis=deviation.axis,
        log=deviation.log or None,
        manoeuvre=manoeuvre,
        from_s=deviation.from_s,
        to_s=deviation.to_s,
        count=deviation.count,
        size=deviation.size,
        unit=detector.unit,
    )
    events = []
    if deviation.log and deviation.first >= 0:
        times = [float("nan") if t is None else t for t in (deviation.from_s, deviation.to_s)]
        event = Event(
            deviation.first, deviation.after, 0, times[0], times[1], deviation.size or 0.0
        )
        events = [(deviation.log, event)]
    return Detection(finding, events, detector)


# ---- The rests that were found, examined by their detectors, without what quality has masked.


class ExaminationOfRests:
    """Everything that these detectors see in the rests among the parts of manoeuvres.

    Parameters
    ----------
    attitudes_set : the manoeuvres whose attitude the plan states
    """

    def __init__(
        self,
        detectors: Sequence[Detector],
        parts: Sequence[Part],
        logs: Mapping[str, Log],
        masks: Masks,
        attitudes_set: Collection[str],
    ) -> None:
        rests = {
            _name(part): part for part in parts if part.phase in STATIC_PHASES and part.log in logs
        }
        self._manoeuvre = {name: part.manoeuvre for name, part in rests.items()}
        self._logs = {
            name: _log_of_rest(logs[part.log], part.manoeuvre in attitudes_set)
            for name, part in rests.items()
        }
        given = next((log.given for log in self._logs.values()), None)
        self._examination = ExaminationOfStretches(
            Examination(detectors, self._logs, given),
            {name: RecordRange(part.log, part.first, part.after) for name, part in rests.items()},
            masks,
        )
        self.columns = self._examination.columns

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        self._examination.add(batch)

    def detections(self, stage: str) -> Iterator[Detection]:
        """What was detected, each by its manoeuvre, once every batch was added."""
        events = self._examination.events() if self._logs else {}
        for each in detections_of(stage, events, self._logs, of_manoeuvres=True):
            manoeuvre = self._manoeuvre[str(each.finding.manoeuvre)]
            yield replace(each, finding=replace(each.finding, manoeuvre=manoeuvre))


def _log_of_rest(log: Log, attitude_set: bool) -> Log:
    """The log of a rest, by whether the plan states the attitude of that."""
    return replace(log, given=replace(log.given, attitude_set=attitude_set))


def _name(rest: Part) -> str:
    """Its manoeuvre; of a rest beside a turn, with its phase."""
    return rest.manoeuvre if rest.phase == "rest" else f"{rest.manoeuvre} ({rest.phase})"
