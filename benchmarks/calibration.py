"""Calibration of clean data: errors of each method, the bound, and time."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks import bound
from benchmarks.campaign import document, performed
from benchmarks.methods import EXPLAINED, JOINT, METHODS, Compared, of_all
from benchmarks.parameters import KINDS, SENSORS, truth, worst
from benchmarks.solving import Solved, run_again, solve, tables_for
from benchmarks.tables import Table, digits
from benchmarks.timing import HEADS, REMARK, Seconds, timed
from inertial.arrays import Array

SEEDS = range(1, 9)
RUNS = 5  # of the estimation of each campaign
LEFT_OUT = (
    "Not compared, because they do not do this: actipy (sphere fit of scale and bias; returns data"
    " within 10 mg of 1 g as they are), scikit-digital-health (the same fit, from 12 hours on),"
    " circuitpython-mag-cal (ellipsoid of nine unknowns; six positions give six equations), magyc"
    " and qmt (magnetometers), imusensor (reads its own chip), ahrs, scikit-kinematics, imuops"
    " (none)."
)


@dataclass
class Runs:
    """Results of the methods, campaign by campaign."""

    off: dict[tuple[str, str], list[Array]] = field(default_factory=dict)  # method, sensor
    standardised: list[Array] = field(default_factory=list)  # of the joint fit, in its sigmas
    covariances: dict[str, list[Array]] = field(default_factory=dict)  # of the joint fit
    solving: list[Seconds] = field(default_factory=list)
    alone: list[Seconds] = field(default_factory=list)  # without the averaging curves
    whole: list[Seconds] = field(default_factory=list)
    of_imucal: list[Seconds] = field(default_factory=list)

    def add(self, solved: Solved, compared: Compared) -> None:
        """One campaign."""
        self.whole.append(solved.seconds)
        self.of_imucal += compared.times
        for sensor, true in truth().items():
            for method, parameters in compared.parameters.items():
                off = parameters[sensor] - true
                self.off.setdefault((method, sensor), []).append(off)
                if method == JOINT:
                    covariance = solved.covariance(sensor)
                    self.covariances.setdefault(sensor, []).append(covariance)
                    self.standardised.append(off / np.sqrt(np.diag(covariance)))


def measured() -> list[Table]:
    """Errors and times on campaigns that differ in their noise only."""
    runs = Runs()
    for seed in SEEDS:
        recording = performed(document(seed))
        with TemporaryDirectory() as name:
            folder = Path(name)
            solved = solve(recording, folder)
            runs.add(solved, of_all(solved, recording, folder))
            inputs = {sensor: tables_for(solved.results.folder, sensor) for sensor in SENSORS}
            runs.solving.append(timed(partial(_solves, inputs), RUNS))
            runs.alone.append(timed(partial(_solves, inputs, averaging_steps=0), RUNS))
    return [_errors(runs), _times(runs)]


def _solves(inputs: Mapping[str, Mapping[str, Any]], **changed: int) -> None:
    """Both stages that estimate parameters, on tables in memory."""
    for sensor, tables in inputs.items():
        run_again(sensor, tables, **changed)


def _errors(runs: Runs) -> Table:
    table = Table(
        f"Calibration of clean data: error of the worst parameter, mean of {len(SEEDS)} campaigns",
        ("method", *(head for head, *_ in KINDS), "sigma\ngiven"),
    )
    for method in METHODS:
        cells = []
        for _, sensor, parts, unit in KINDS:
            found = runs.off[method, sensor]
            cells.append(digits(float(np.mean([worst(off, parts, unit) for off in found]))))
        table.add(method, *cells, "no" if "imucal" in method else "yes")
    promised = {sensor: np.mean(each, axis=0) for sensor, each in runs.covariances.items()}
    least = {"accelerometer": bound.accelerometers(), "gyroscope": bound.gyros()}
    for name, covariance in (("expected: joint, its sigmas", promised), ("expected: bound", least)):
        cells = [digits(bound.expected_worst(covariance[s], p) / unit) for _, s, p, unit in KINDS]
        table.add(name, *cells, "")
    standardised = np.concatenate(runs.standardised)
    table.remarks += [
        f"A mean of {len(SEEDS)} scatters by about 15 %; the expected values do not."
        " Bound: Cramér–Rao, of every sample, from the design alone. S0's formulas: six"
        " positions, and turns of a known angle.",
        "The sigmas hold: the errors of the joint fit in units of its own sigmas have the rms"
        f" {np.sqrt(np.mean(standardised**2)):.2f}, expected 1; the largest of"
        f" {len(standardised)} is {np.abs(standardised).max():.1f}.",
        EXPLAINED,
        LEFT_OUT,
    ]
    return table


def _times(runs: Runs) -> Table:
    table = Table("Calibration: time", ("work", "from", *HEADS, "runs"))
    for work, start, seconds in (
        ("this project, accelerometers and gyros", "blocks", runs.alone),
        ("this project, the same and their averaging curves", "blocks", runs.solving),
        ("this project, all stages up to the gyros", "logs", runs.whole),
        ("imucal", "samples in memory", runs.of_imucal),
    ):
        times = Seconds.together(seconds)
        table.add(work, start, *times.cells(), str(len(times.runs)))
    table.remarks.append(REMARK)
    return table
