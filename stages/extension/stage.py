"""The model with the named effects, refitted; its gain, and which result is final."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import pandas as pd

from inertial.campaign.campaign_data import CampaignData, campaigns_of
from inertial.campaign.equations import campaign_of
from inertial.campaign.records import rows_of
from inertial.campaign.solution import joint_rows
from inertial.campaign.steady_residuals import steady_residuals, steady_turns
from inertial.estimation.triad import linear_names
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import EXTENDED
from stages.extension.cross_validation import CrossValidation, cross_validate
from stages.extension.decision import Candidate
from stages.extension.declared import DECLARED
from stages.extension.estimates import Solved, moved, solved
from stages.extension.gain import gain, gain_of_line, gain_of_ripple
from stages.extension.models import SENSORS, models_of
from stages.extension.named_effects import Named, named_of
from stages.extension.navigation_error import change_of, worth

Row = Mapping[str, Any]
TableRow = tuple[str, Row]

TWELVE = linear_names()


def extension(
    mounts: Sequence[CampaignData],
    simulated: Stream,
    causes: tuple[Sequence[Row], Sequence[Row], Sequence[Row]],
    random_walks: pd.DataFrame,
    joint: Mapping[str, tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]],
) -> Tables:
    """Parameters and covariance of the extended model, and the final parameters.

    Where nothing was named there is nothing to extend: the joint result is final, and the tables
    but `decision` and `result` are empty.

    Parameters
    ----------
    causes : rows of the findings, effects and members of criticism
    joint : by sensor, parameters, fit and manoeuvres of the joint result
    """
    walk_of: dict[tuple[str, str], float] = defaultdict(float)
    walk_of |= {(row["mount"], row["sensor"]): row["value"] for row in rows_of(random_walks)}
    rows: dict[str, list[Any]] = {name: [] for name in DECLARED.writes}
    for data in mounts:
        extended = Extension(
            data,
            named_of(*causes, data.mount),
            {s: Joint(*(joint_rows(t, data.mount) for t in of)) for s, of in joint.items()},
            (walk_of[data.mount, "gyro"], walk_of[data.mount, "accel"]),
        )
        for table, row in extended.rows(simulated):
            rows[table].append(row)
    covariances = rows.pop("covariance")
    written = {
        name: pd.DataFrame(rows[name], columns=[column.name for column in table.columns])
        if rows.get(name)
        else table.empty()
        for name, table in DECLARED.writes.items()
    }
    return written | ({"covariance": pd.concat(covariances)} if covariances else {})


def causes_of(
    criticism_findings: pd.DataFrame, effects: pd.DataFrame, members: pd.DataFrame
) -> tuple[Sequence[Row], Sequence[Row], Sequence[Row]]:
    """The causes that criticism found, as rows."""
    return rows_of(criticism_findings), rows_of(effects), rows_of(members)


def joint_of(
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    accelerometer_fit_manoeuvres: pd.DataFrame,
    gyroscope_fit_manoeuvres: pd.DataFrame,
) -> dict[str, tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]]:
    """The tables of the joint result by sensor."""
    return {
        "gyro": (gyroscope_parameters, gyroscope_fit, gyroscope_fit_manoeuvres),
        "accel": (accelerometer_parameters, accelerometer_fit, accelerometer_fit_manoeuvres),
    }


@dataclass(frozen=True)
class Joint:
    """Rows of the joint result of one sensor and mount; of its fit there is at most one."""

    parameters: Sequence[Row]
    fit: Sequence[Row]
    manoeuvres: Sequence[Row]


class Extension:
    """The extended model of one mount.

    `joint`: rows of the joint result, by sensor; `random_walks`: of the biases of gyros and
    accelerometers given the named effects.
    """

    def __init__(
        self,
        data: CampaignData,
        named: Named,
        joint: Mapping[str, Joint],
        random_walks: tuple[float, float],
    ) -> None:
        self.data, self.named, self.joint = data, named, joint
        self.random_walks = random_walks
        self.solutions: dict[str, Solved] = {}
        self.validated: Mapping[str, CrossValidation] = {}

    def rows(self, simulated: Stream) -> Iterator[tuple[str, Any]]:
        """The rows of all tables; of `covariance` tables."""
        if self.named.in_blocks:
            yield from self._of_blocks()
        for sensor in SENSORS:
            yield from self._final(sensor)
        if self.named.in_spectrum and self.data.result.gyro is not None:
            yield from self._of_spectrum(simulated)

    def _of_blocks(self) -> Iterator[tuple[str, Any]]:
        data, mount = self.data, self.data.mount
        models = models_of(campaign_of(data), self.named.in_blocks, self.random_walks)
        for sensor, system, walk in zip(SENSORS, models.systems(), self.random_walks, strict=True):
            if system is not None:
                solution = solved(models, sensor, system, walk, mount)
                self.solutions[sensor] = solution
                yield "covariance", solution.covariance_rows()
                rows = (*solution.rows, *solution.constants)
                yield from (("parameters", row) for row in rows)
                yield "fit", solution.fit_row(data.noise.degrees)
                for row in self.joint[sensor].manoeuvres:
                    yield "fit_manoeuvres", {**row, "method": EXTENDED}
        self.validated = cross_validate(models)
        yield from gain(models, self.validated, mount)
        triads = {"gyro": data.result.gyro, "accel": data.result.accelerometer}
        changes = {
            sensor: change
            for sensor, solution in self.solutions.items()
            if (triad := triads[sensor]) is not None
            and (change := change_of(solution, triad)) is not None
        }
        for row in worth(models.extended, models.effects, changes, mount):
            yield "worth", row

    def _final(self, sensor: str) -> Iterator[TableRow]:
        """Which result of a sensor is final, and its parameters."""
        own = [row for row in self.joint[sensor].parameters if row["parameter"] in TWELVE]
        solution, mount = self.solutions.get(sensor), self.data.mount
        validated = self.validated.get(sensor)
        candidate = Candidate(sensor, mount, self.named, own, solution, validated)
        yield from candidate.rows()
        yield from (("result", row) for row in candidate.final_rows())
        if solution is not None:
            scatter = any(row["scatter"] for row in self.joint[sensor].fit)
            yield from (("moved", row) for row in moved(solution, own, scatter, mount))

    def _of_spectrum(self, simulated: Stream) -> Iterator[TableRow]:
        """The gain of an oscillation, and of what depends on the table's angle."""
        data, gyro = self.data, self.data.result.gyro
        assert gyro is not None  # for oscillations were detected in its residuals
        of_table = set(self.named.in_spectrum) - {"oscillation"}
        turns = steady_turns(data, simulated) if of_table else []
        for effect, values in self.named.in_spectrum.items():
            if effect != "oscillation":
                yield from gain_of_ripple(turns, effect, values, data.mount)
            elif "frequency" in values:
                step_of = {m.name: data.clocks[m.log].step for m in data.plan}
                residuals = [(n, r) for n, r in steady_residuals(simulated) if n in step_of]
                frequency = values["frequency"]
                yield from gain_of_line(residuals, step_of, frequency, gyro, data.mount)


STAGE = Stage(
    extension,
    DECLARED,
    gathers={"mounts": campaigns_of, "causes": causes_of, "joint": joint_of},
)
