"""Every method on the same samples: two of this project, and those of other programs."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from benchmarks import sections
from benchmarks.campaign import RATE
from benchmarks.parameters import SENSORS
from benchmarks.processes import in_peers
from benchmarks.solving import Solved
from benchmarks.timing import Seconds
from inertial.arrays import Array
from laboratory import Recording

Parameters = dict[str, Array]  # by sensor, (12,)

JOINT = "this project, joint"
FORMULAS = "this project, S0's formulas"
PLAIN = "imucal"
NO_EARTH = "imucal, no earth"
BOTH = "imucal, no earth, both ways"
METHODS = (JOINT, FORMULAS, PLAIN, NO_EARTH, BOTH)
OWN = {  # the names of this project's two in its tables
    JOINT: {"accelerometer": "joint", "gyroscope": "joint"},
    FORMULAS: {"accelerometer": "six_position", "gyroscope": "turns"},
}
EXPLAINED = (
    "imucal: TurntableCalibration, given perfect sections. It does not know that the earth turns"
    " (no earth: its true rate was taken out of the data beforehand) and takes one turn about each"
    " axis (both ways: the mean of its results with the forward and with the backward turns)."
)
RUNS = 5  # of imucal, for its time


@dataclass(frozen=True)
class Compared:
    """Parameters by method, warnings of imucal, and its times."""

    parameters: dict[str, Parameters]
    warnings: list[str]
    times: list[Seconds]


def of_all(solved: Solved, recording: Recording, folder: Path) -> Compared:
    """Apply every method to the samples of the chain."""
    found = {
        name: {sensor: solved.values[sensor, method] for sensor, method in own.items()}
        for name, own in OWN.items()
    }
    answers = []
    samples = solved.results["decode/samples"]
    gravity = str(recording.campaign["site"]["gravity_m_s2"])
    path = folder / "sections.npz"
    for earth, names in ((True, {PLAIN: "forward"}), (False, {NO_EARTH: "forward", BOTH: "both"})):
        sections.write(samples, recording, path, earth=earth)
        answer = in_peers("ferraris", path, gravity, str(RATE), str(RUNS))
        answers.append(answer)
        for name, way in names.items():
            found[name] = dict(zip(SENSORS, map(np.array, answer[way]), strict=True))
    says = [words for answer in answers for words in answer["says"]]
    return Compared(found, says, [Seconds.answered(answers)])
