"""The rests that were found, examined by their detectors, without what quality has masked."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

from inertial.campaign.detection import Examination, ExaminationOfStretches
from inertial.campaign.findings import Detection, detections_of
from inertial.campaign.masked_samples import Batch, Masks
from inertial.signal.detector import Detector, Log
from stages.segment.matching import Part


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
            _name(part): part
            for part in parts
            if part.phase.startswith("rest") and part.log in logs
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
