"""What disagrees with the plan, and what the detectors of rests see, as findings."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

from inertial.campaign.detection import Examination, ExaminationOfStretches
from inertial.campaign.findings import Detection, Finding, detections_of
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Batch, Masks
from inertial.signal.detector import Detector, Event, Log
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, Reversed
from inertial.tables import STATIC_PHASES
from stages.segment.matching import Part
from stages.segment.steps import BY_GRAVITY


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
