"""Detectors that know the plan, and those of each static position, at work."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from inertial.campaign.detection import Examination, ExaminationOfStretches
from inertial.campaign.findings import Detection, Finding, detections_of
from inertial.campaign.masked_samples import Batch, Masks
from inertial.signal.detector import Detector, Event, Log
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.tables import STATIC_PHASES
from stages.segment.matching import Part

# ---- What disagrees with the plan, as findings.


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
    """Everything that these detectors see in the rests among the parts of manoeuvres."""

    def __init__(
        self,
        detectors: Sequence[Detector],
        parts: Sequence[Part],
        logs: Mapping[str, Log],
        masks: Masks,
    ) -> None:
        rests = {
            _name(part): part for part in parts if part.phase in STATIC_PHASES and part.log in logs
        }
        self._manoeuvre = {name: part.manoeuvre for name, part in rests.items()}
        self._logs = {name: logs[part.log] for name, part in rests.items()}
        given = next((log.given for log in self._logs.values()), None)
        self._examination = ExaminationOfStretches(
            Examination(detectors, self._logs, given),
            {name: (part.log, part.first, part.after) for name, part in rests.items()},
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


def _name(rest: Part) -> str:
    """Its manoeuvre; of a rest beside a turn, with its phase."""
    return rest.manoeuvre if rest.phase == "rest" else f"{rest.manoeuvre} ({rest.phase})"
