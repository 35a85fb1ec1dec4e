"""What disagrees with the plan, as findings."""

from collections.abc import Sequence

from inertial.campaign.findings import Detection, Finding
from inertial.signal.detector import Event
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded


def compare(stage: str, detectors: Sequence[PlanDetector], recorded: Recorded) -> list[Detection]:
    """Everything in which the recording is not as planned, in the order of detectors and plan."""
    return [
        _told(stage, detector, deviation, recorded)
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
