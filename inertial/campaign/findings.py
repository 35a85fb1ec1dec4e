"""Findings: what is wrong where, how large, what it does to the result, what to do.

Events become findings: one for each cause and place, many equal events as one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import pandas as pd

from inertial import tables
from inertial.arrays import finite_or_none
from inertial.campaign.detection import Events
from inertial.campaign.masked_samples import RecordIndex, rows_between
from inertial.sensors import CHANNELS, UNITS
from inertial.signal.detector import Detector, Event, Log
from inertial.signal.plan_detector import PlanDetector
from inertial.tables import CHANNEL_PARTS, FINDINGS, MASKS
from inertial.tables.parquet import Stream

MIN_SAME_SHARE = 0.9  # of the records of two events, in both of them: they have one cause
MAX_SINGLE_EVENTS = 8  # of a kind in one place; more of them are one finding with a count


@dataclass(frozen=True)
class Finding:
    """A row of the findings table; times in s, `size` in `unit`."""

    id: str
    cause: str
    sentence: str
    consequence: str
    action: str
    severity: int  # 3 spoils a result, 2 weakens it, 1 is good to know
    mount: str = ""
    sensor: str | None = None
    axis: str | None = None
    log: str | None = None
    manoeuvre: str | None = None
    from_s: float | None = None
    to_s: float | None = None
    count: int = 1
    size: float | None = None
    unit: str = "1"
    p_value: float | None = None


@dataclass(frozen=True)
class Detection:
    """A finding, and its events with their logs."""

    finding: Finding
    events: Sequence[tuple[str, Event]]
    detector: Detector | PlanDetector


def table_of(findings: Sequence[Finding]) -> pd.DataFrame:
    """The findings table, which may be empty."""
    return FINDINGS.frame([asdict(finding) for finding in findings])


def masks_of(detections: Sequence[Detection]) -> pd.DataFrame:
    """The table of the records that these findings mask."""
    rows: list[dict[str, Any]] = [
        {
            "log": log,
            "from_record": event.first,
            "to_record": event.after,
            **_channel(channel),
            "repeated": each.detector.repeats,
            "censored": each.detector.censors(event),
            "finding": each.finding.id,
        }
        for each in detections
        if isinstance(each.detector, Detector) and each.detector.masks
        for log, event in each.events
        for channel in event.channels or (None,)
    ]
    return MASKS.frame(rows)


def detections_of(
    stage: str, events: Events, logs: Mapping[str, Log], *, of_manoeuvres: bool = False
) -> list[Detection]:
    """All events as findings, in the order of detectors: what is the same is one finding.

    Parameters
    ----------
    logs : the log by the name of the event
    of_manoeuvres : the names are those of manoeuvres
    """
    detections: list[Detection] = []
    for key, group in _groups(events).items():
        detector = key[0]
        name, largest = max(group, key=lambda pair: abs(pair[1].size))
        log = logs.get(name)
        part = key[1] or detector.sensor
        identifier = "/".join([stage, detector.name, *([part] if part else []), *key[2:]])
        finding = _finding(detector, largest, name, log, identifier)
        if len(group) > 1:
            finding = _of_many(finding, detector, group)
        if of_manoeuvres:
            finding = replace(finding, manoeuvre=name)
        placed = [(logs[name].name, event) for name, event in group if name in logs]
        detections.append(Detection(finding, placed, detector))
    return detections


NamedEvent = tuple[str, Event]  # under the name of its log, its rest, or none: the campaign's


def _groups(events: Events) -> dict[tuple[Any, ...], list[NamedEvent]]:
    """Events that are one finding, by detector, sensor or channel, and by what else differs.

    Where events are things of their own they are told apart by their place and number, unless
    many are in one place.
    """
    groups: dict[tuple[Any, ...], list[NamedEvent]] = {}
    together = _parts_together(events)
    for (detector, name, channel), own in events.items():
        part = "" if channel is None else CHANNELS[channel]
        single = detector.alike == "event" and len(own) <= MAX_SINGLE_EVENTS
        for number, event in enumerate(own):
            if detector.alike == "event":
                key = (detector, part, *([name] if name else []), *([str(number)] * single))
            elif detector.alike == "sensor":
                key = (detector, part.partition("_")[0])
            else:
                key = (detector, together.get(id(event), part))
            groups.setdefault(key, []).append((name, event))
    return groups


def _parts_together(events: Events) -> dict[int, str]:
    """For each event of several channels over nearly the same records the names of all of these."""
    stretches: dict[tuple[Detector, str], list[list[Event]]] = {}
    for (detector, name, _), own in events.items():
        if detector.alike != "records":
            continue
        found = stretches.setdefault((detector, name), [])
        for event in own:
            same = (group for group in found if _over_the_same(group[0], event))
            group = next(same, None)
            if group is None:
                found.append([event])
            else:
                group.append(event)
    parts: dict[int, str] = {}
    for groups in stretches.values():
        for group in groups:
            own_parts = "_".join(CHANNELS[c] for c in sorted(e.channel or 0 for e in group))
            parts |= dict.fromkeys(map(id, group), own_parts)
    return parts


def _over_the_same(one: Event, other: Event) -> bool:
    """Whether two events are of other channels and of nearly the same records."""
    both = min(one.after, other.after) - max(one.first, other.first)
    whole = max(one.after, other.after) - min(one.first, other.first)
    return one.channel != other.channel and both >= MIN_SAME_SHARE * whole


def _channel(channel: int | None) -> dict[str, str | None]:
    """Sensor and axis of a channel."""
    if channel is None:
        return {"sensor": None, "axis": None}
    sensor, axis = CHANNEL_PARTS[CHANNELS[channel]]
    return {"sensor": sensor, "axis": axis}


def _finding(
    detector: Detector, event: Event, name: str, log: Log | None, identifier: str
) -> Finding:
    description = detector.describe(event, name)
    channel = _channel(event.channel)
    unit = detector.unit or (UNITS[channel["sensor"]] if channel["sensor"] else "1")
    return Finding(
        id=identifier,
        cause=detector.name,
        sensor=channel["sensor"] or event.sensor or detector.sensor,
        axis=channel["axis"],
        log=log.name if log else None,
        from_s=finite_or_none(event.from_s),
        to_s=finite_or_none(event.to_s),
        count=event.count,
        size=event.size,
        unit=unit,
        p_value=event.p_value,
        sentence=description.sentence,
        consequence=description.consequence,
        action=description.action,
        severity=event.severity or detector.severity,
    )


def _of_many(finding: Finding, detector: Detector, group: Sequence[NamedEvent]) -> Finding:
    """One finding for many events; it has the size of the largest, and the times within one log."""
    description = detector.describe_many(group)
    channels = {event.channel for _, event in group}
    sensors = {_channel(channel)["sensor"] for channel in channels}
    one_log = len({name for name, _ in group}) == 1
    return replace(
        finding,
        sensor=finding.sensor if len(sensors) == 1 else None,
        axis=finding.axis if len(channels) == 1 else None,
        from_s=finite_or_none(min(e.from_s for _, e in group)) if one_log else finding.from_s,
        to_s=finite_or_none(max(e.to_s for _, e in group)) if one_log else finding.to_s,
        count=_number_of(detector, group),
        p_value=min((e.p_value for _, e in group if e.p_value is not None), default=None),
        severity=max(event.severity or detector.severity for _, event in group),
        sentence=description.sentence,
        consequence=description.consequence,
        action=description.action,
    )


def _number_of(detector: Detector, group: Sequence[NamedEvent]) -> int:
    """How many events they are; several channels over the same records are one."""
    if detector.alike != "records":
        return sum(event.count for _, event in group)
    channel = group[0][1].channel
    return sum(event.count for _, event in group if event.channel == channel)


# ---- The samples around each finding, for a figure that shows it close up

MAX_FINDINGS = 40  # that are shown
MARGIN = 60  # records on each side
MAX_RECORDS = 400  # of a close-up; of a longer stretch its beginning is shown
COLUMNS = ["record", "line", "time", *tables.CHANNELS]


def close_ups(samples: Stream, index: RecordIndex, detections: Sequence[Detection]) -> pd.DataFrame:
    """The records around the place of each finding, the most severe findings first.

    Parameters
    ----------
    index : the rows of the records, from a pass over the samples
    """
    placed = [each for each in detections if each.events]
    frames = []
    for detection in sorted(placed, key=lambda each: -each.finding.severity)[:MAX_FINDINGS]:
        log, event = max(detection.events, key=lambda pair: abs(pair[1].size))
        first = event.first - MARGIN
        after = min(event.after + MARGIN, first + MAX_RECORDS)
        for batch in rows_between(samples, *index.rows(log, first, after), COLUMNS):
            shown = pd.DataFrame(batch.columns)
            shown = shown[(shown["record"] >= first) & (shown["record"] < after)]
            inside = (shown["record"] >= event.first) & (shown["record"] < event.after)
            frames.append(shown.assign(finding=detection.finding.id, log=log, concerned=inside))
    return pd.concat(frames) if frames else tables.CLOSE_UPS.empty()
