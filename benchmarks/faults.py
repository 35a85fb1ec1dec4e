"""Calibration of spoilt data: how far a fault moves each method, and whether it says so."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.campaign import document, performed
from benchmarks.methods import EXPLAINED, METHODS, OWN, Compared, of_all
from benchmarks.parameters import BIAS, BIAS_UNIT, MATRIX, PPM, SENSORS, truth, worst
from benchmarks.solving import Solved, solve
from benchmarks.spoiling import FAULTS
from benchmarks.tables import Table, told
from laboratory import Recording

SEED = 1
UNTIL = "criticism"


def measured() -> list[Table]:
    """Each fault alone, in one campaign, against the same campaign without it."""
    asked = document(SEED)
    _, clean = _run(performed(asked))
    table = Table(
        "Calibration of spoilt data: largest change of a parameter against the clean campaign",
        ("fault, method", "accel\nppm", "accel\nµg", "gyro\nppm", "gyro\n°/h", "worst\nsigmas"),
    )
    for fault, spoil in FAULTS.items():
        solved, spoilt = _run(spoil(asked))
        table.add(fault, "", "", "", "", "")
        for method in METHODS:
            cells = []
            for sensor in SENSORS:
                moved = spoilt.found[method][sensor] - clean.found[method][sensor]
                cells += [
                    told(worst(moved, MATRIX, PPM)),
                    told(worst(moved, BIAS, BIAS_UNIT[sensor])),
                ]
            table.add(f"  {method}", *cells, told(_pull(solved, method)))
        table.remarks.append(
            f"{fault}. This project says: {'; '.join(solved.says) or 'nothing'}."
            f" imucal says: {'; '.join(spoilt.warnings) or 'nothing'}."
        )
    table.remarks += [
        "Worst: the error of the worst parameter in units of the sigma that the method gives.",
        EXPLAINED,
    ]
    return [table]


def _run(recording: Recording) -> tuple[Solved, Compared]:
    """What every method finds, and what the chain says beside it."""
    with TemporaryDirectory() as name:
        solved = solve(recording, Path(name), UNTIL)
        return solved, of_all(solved, recording, Path(name))


def _pull(solved: Solved, method: str) -> float:
    """The worst error in units of the method's own sigmas; NaN where it gives none."""
    pulls = [
        (solved.values[sensor, own] - truth()[sensor]) / solved.sigmas[sensor, own]
        for sensor, own in OWN.get(method, {}).items()
    ]
    return float(np.fmax.reduce(np.abs(np.concatenate(pulls)))) if pulls else np.nan
