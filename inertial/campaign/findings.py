"""Findings: what is wrong where, how large, what it does to the result, what to do.

Events become findings: one for each cause and place, many equal events as one.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.detection import Events
from inertial.signal.detector import CHANNELS, UNITS, Detector, Event, Log
from inertial.signal.plan_detector import PlanDetector
from inertial.tables import FINDINGS, MASKS
from inertial.text.messages import _

MAX_SINGLE_EVENTS = 8  # in one place; more equal ones are one finding with a count
MAX_NAMED_LOGS = 6  # in a sentence; of more the number is given


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
    return pd.DataFrame([asdict(f) for f in findings]) if findings else FINDINGS.empty()


def masks_of(detections: Sequence[Detection]) -> pd.DataFrame:
    """The table of the records that these findings mask."""
    rows: list[dict[str, Any]] = [
        {
            "log": log,
            "from_record": event.first,
            "to_record": event.after,
            **_channel(event.channel),
            "repeated": each.detector.repeats,
            "finding": each.finding.id,
        }
        for each in detections
        if each.detector.masks
        for log, event in each.events
    ]
    return pd.DataFrame(rows) if rows else MASKS.empty()


def detections_of(
    stage: str, events: Events, logs: Mapping[str, Log], *, of_manoeuvres: bool = False
) -> list[Detection]:
    """All events as findings, in the order of detectors and logs.

    Parameters
    ----------
    logs : the log of each name under which events stand
    of_manoeuvres : the names are those of manoeuvres
    """
    detections: list[Detection] = []
    for (detector, name, channel), own in events.items():
        log = logs.get(name)
        # What may be the same in all logs is one finding within a log as well.
        many = len(own) > (1 if detector.everywhere else MAX_SINGLE_EVENTS)
        for number, group in enumerate([own] if many else [[event] for event in own]):
            largest = max(group, key=lambda event: abs(event.size))
            part = detector.sensor if channel is None else CHANNELS[channel]
            place = [name, *([part] if part else []), str(number)]
            identifier = "/".join([stage, detector.name, *(place if name else [])])
            finding = _finding(detector, largest, name, log, identifier)
            if many:
                finding = _of_many(finding, group)
            if of_manoeuvres:
                finding = replace(finding, manoeuvre=name)
            placed = [(log.name, event) for event in group] if log else []
            detections.append(Detection(finding, placed, detector))
    return list(_joined_over_logs(detections))


def _channel(channel: int | None) -> dict[str, str | None]:
    """Sensor and axis of a channel."""
    if channel is None:
        return {"sensor": None, "axis": None}
    return {"sensor": "accel" if channel < 3 else "gyro", "axis": "xyz"[channel % 3]}


def _finding(
    detector: Detector, event: Event, name: str, log: Log | None, identifier: str
) -> Finding:
    description = detector.describe(event, name)
    channel = _channel(event.channel)
    unit = detector.unit or ("1" if event.channel is None else UNITS[event.channel])
    return Finding(
        id=identifier,
        cause=detector.name,
        sensor=channel["sensor"] or detector.sensor,
        axis=channel["axis"],
        log=log.name if log else None,
        from_s=_number(event.from_s),
        to_s=_number(event.to_s),
        count=event.count,
        size=event.size,
        unit=unit,
        p_value=event.p_value,
        sentence=description.sentence,
        consequence=description.consequence,
        action=description.action,
        severity=event.severity or detector.severity,
    )


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _of_many(finding: Finding, events: Sequence[Event]) -> Finding:
    """One finding for many equal events, from the first to the last; it describes the largest."""
    count = sum(event.count for event in events)
    return replace(
        finding,
        from_s=_number(min(event.from_s for event in events)),
        to_s=_number(max(event.to_s for event in events)),
        count=count,
        sentence=(
            f"{finding.sentence} This occurs {count} times in this log; the largest is described."
        ),
    )


def _joined_over_logs(detections: Sequence[Detection]) -> Iterator[Detection]:
    """Findings that are the same in several logs as one, where their detector says so."""
    groups: dict[tuple[str, str | None, str | None, int], list[Detection]] = {}
    for number, each in enumerate(detections):
        finding = each.finding
        alone = -1 if each.detector.everywhere else number
        key = (finding.cause, finding.sensor, finding.axis, alone)
        groups.setdefault(key, []).append(each)
    for group in groups.values():
        names = list(dict.fromkeys(str(each.finding.log) for each in group))
        if len(names) == 1:
            yield from group
            continue
        largest = max(group, key=lambda each: abs(each.finding.size or 0.0)).finding
        others = [name for name in names if name != largest.log]
        shown = ", ".join(others[:MAX_NAMED_LOGS])
        if len(others) > MAX_NAMED_LOGS:
            shown += _(" and {others} more", others=len(others) - MAX_NAMED_LOGS)
        finding = replace(
            largest,
            id=largest.id.replace(f"/{largest.log}", ""),
            count=sum(each.finding.count for each in group),
            sentence=f"{largest.sentence} The same in {shown}.",
        )
        yield Detection(
            finding, [pair for each in group for pair in each.events], group[0].detector
        )
