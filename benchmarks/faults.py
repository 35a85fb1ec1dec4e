"""Calibration of faulty data: the change of each method by a fault, and its warnings."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.campaign import document, performed
from benchmarks.methods import EXPLAINED, METHODS, OWN, Compared, of_all
from benchmarks.parameters import BIAS, BIAS_UNIT, MATRIX, PPM, SENSORS, truth, worst
from benchmarks.solving import Solved, solve
from benchmarks.spoiling import FAULTS
from benchmarks.tables import Table, digits
from laboratory import Recording

SEED = 1
UNTIL = "criticism"


def measured() -> list[Table]:
    """Each fault alone, in one campaign, compared with the same campaign without it."""
    specified = document(SEED)
    _, clean = _run(performed(specified))
    table = Table(
        "Calibration of faulty data: largest change of a parameter against the clean campaign",
        ("fault, method", "accel\nppm", "accel\nµg", "gyro\nppm", "gyro\n°/h", "worst\nsigmas"),
    )
    for fault, add_fault in FAULTS.items():
        solved, faulty = _run(add_fault(specified))
        table.add(fault, "", "", "", "", "")
        for method in METHODS:
            cells = []
            for sensor in SENSORS:
                moved = faulty.parameters[method][sensor] - clean.parameters[method][sensor]
                cells += [
                    digits(worst(moved, MATRIX, PPM)),
                    digits(worst(moved, BIAS, BIAS_UNIT[sensor])),
                ]
            table.add(f"  {method}", *cells, digits(_worst_standardised(solved, method)))
        table.remarks.append(
            f"{fault}. Warnings of this project: {'; '.join(solved.says) or 'nothing'}."
            f" Of imucal: {'; '.join(faulty.warnings) or 'nothing'}."
        )
    table.remarks += [
        "Worst: the error of the worst parameter in units of the sigma that the method gives.",
        EXPLAINED,
    ]
    return [table]


def _run(recording: Recording) -> tuple[Solved, Compared]:
    """Results of every method, and the findings of the chain."""
    with TemporaryDirectory() as name:
        solved = solve(recording, Path(name), UNTIL)
        return solved, of_all(solved, recording, Path(name))


def _worst_standardised(solved: Solved, method: str) -> float:
    """The worst error in units of the method's own sigmas; NaN where it gives none."""
    standardised = [
        (solved.values[sensor, own] - truth()[sensor]) / solved.sigmas[sensor, own]
        for sensor, own in OWN.get(method, {}).items()
    ]
    return float(np.fmax.reduce(np.abs(np.concatenate(standardised)))) if standardised else np.nan
