"""Events become findings: one for each cause and place, a storm of equal ones as one."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from inertial.campaign.detection import Watched
from inertial.campaign.findings import Finding
from inertial.signal.detector import CHANNELS, UNITS, Detector, Event, Log
from inertial.signal.plan_detector import AgainstPlan

STORM = 8  # more equal events in one place are one finding with a count


@dataclass(frozen=True)
class Told:
    """A finding, and the stretches of records that it speaks of: log, first, after."""

    finding: Finding
    events: Sequence[tuple[str, Event]]
    detector: Detector | AgainstPlan

    @property
    def masks(self) -> Iterator[dict[str, Any]]:
        """The rows of the masks table."""
        if self.detector.masks:
            for log, event in self.events:
                yield {
                    "log": log,
                    "from_record": event.first,
                    "to_record": event.after,
                    "channel": None if event.channel is None else CHANNELS[event.channel],
                    "repeated": self.detector.repeats,
                    "finding": self.finding.id,
                }


def tell(stage: str, watched: Watched, *, of_manoeuvres: bool = False) -> list[Told]:
    """Everything that was seen as findings, in the order of detectors and logs."""
    told: list[Told] = []
    for (detector, name, channel), events in watched.seen.items():
        log = watched.logs.get(name)
        # What is the same everywhere is one finding of a log as well.
        storm = len(events) > (1 if detector.everywhere else STORM)
        for number, group in enumerate([events] if storm else [[event] for event in events]):
            worst = max(group, key=lambda event: abs(event.size))
            part = detector.sensor if channel is None else CHANNELS[channel]
            place = [name, *([part] if part else []), str(number)]
            identifier = "/".join([stage, detector.name, *(place if name else [])])
            finding = _finding(detector, worst, name, log, identifier)
            if storm:
                finding = _storm(finding, group)
            if of_manoeuvres:
                finding = replace(finding, manoeuvre=name)
            told.append(
                Told(finding, [(log.name, event) for event in group] if log else [], detector)
            )
    return list(_everywhere(stage, told))


def _finding(
    detector: Detector, event: Event, name: str, log: Log | None, identifier: str
) -> Finding:
    words = detector.tells(event, name)
    channel = None if event.channel is None else CHANNELS[event.channel]
    unit = detector.unit or ("1" if event.channel is None else UNITS[event.channel])
    return Finding(
        id=identifier,
        cause=detector.name,
        sensor=channel[:-2] if channel else detector.sensor,
        axis=channel and channel[-1],
        log=log.name if log else None,
        from_s=_number(event.from_s),
        to_s=_number(event.to_s),
        count=event.count,
        size=event.size,
        unit=unit,
        p_value=event.p_value,
        sentence=words.sentence,
        consequence=words.consequence,
        action=words.action,
        severity=event.severity or detector.severity,
    )


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _storm(finding: Finding, events: Sequence[Event]) -> Finding:
    """One finding for many equal events: from the first to the last, told by the worst."""
    count = sum(event.count for event in events)
    return replace(
        finding,
        from_s=_number(min(event.from_s for event in events)),
        to_s=_number(max(event.to_s for event in events)),
        count=count,
        sentence=f"{finding.sentence} This happens {count} times in this log; the worst is told.",
    )


def _everywhere(stage: str, told: Sequence[Told]) -> Iterator[Told]:
    """Join what is the same in several logs, where its detector says that this is one finding."""
    groups: dict[tuple[str, str | None, str | None], list[Told]] = {}
    for number, one in enumerate(told):
        finding = one.finding
        alone = () if one.detector.everywhere else (number,)
        key = (finding.cause, finding.sensor, finding.axis, *alone)
        groups.setdefault(key, []).append(one)
    for group in groups.values():
        names = list(dict.fromkeys(str(one.finding.log) for one in group))
        if len(names) == 1:
            yield from group
            continue
        worst = max(group, key=lambda one: abs(one.finding.size or 0.0)).finding
        others = [name for name in names if name != worst.log]
        shown = ", ".join(others[:6]) + (f" and {len(others) - 6} more" if len(others) > 6 else "")
        finding = replace(
            worst,
            id=worst.id.replace(f"/{worst.log}", ""),
            count=sum(one.finding.count for one in group),
            sentence=f"{worst.sentence} The same in {shown}.",
        )
        yield Told(finding, [event for one in group for event in one.events], group[0].detector)
