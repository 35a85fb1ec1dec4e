"""The model with the effects that were named, refitted: what it gains, and whether it counts."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import Any

import pandas as pd

from inertial.campaign.campaign_data import CampaignData, campaigns_of
from inertial.campaign.equations import campaign_of
from inertial.campaign.records import rows_of
from inertial.campaign.steady_residuals import steady_residuals, steady_turns
from inertial.estimation.triad import linear_names
from inertial.physics.forward import Triad
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from stages.extension.cross_validation import held_out
from stages.extension.decision import decision, result
from stages.extension.declared import DECLARED
from stages.extension.estimates import Solved, moved, solved
from stages.extension.gain import gain, gain_of_line, gain_of_ripple
from stages.extension.models import SENSORS, models_of
from stages.extension.named_effects import Named, named_of
from stages.extension.navigation_error import change_of, worth

Row = dict[str, Any]

TWELVE = linear_names()


def extension(
    mounts: Sequence[CampaignData],
    simulated: Stream,
    criticism_findings: pd.DataFrame,
    effects: pd.DataFrame,
    random_walks: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
) -> Tables:
    """Parameters and covariance of the extended model, and the parameters that count.

    Where nothing was named there is nothing to extend: the joint result counts, and the tables but
    `decision` and `result` are empty.
    """
    joint = {
        "gyro": rows_of(gyroscope_parameters),
        "accel": rows_of(accelerometer_parameters),
    }
    fits = {
        (sensor, row["method"]): row
        for sensor, fit in (("gyro", gyroscope_fit), ("accel", accelerometer_fit))
        for row in rows_of(fit)
    }
    walk_of = defaultdict(
        float, {(row["mount"], row["sensor"]): row["value"] for row in rows_of(random_walks)}
    )
    made: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    covariances: list[pd.DataFrame] = []
    for data in mounts:
        mount, method, suffix = data.mount, data.named("joint"), data.named("")
        solution = data.result
        named = named_of(rows_of(criticism_findings), rows_of(effects), suffix)
        extended: dict[str, Solved] = {}
        found = {}
        if named.in_blocks:
            campaign = campaign_of(data)
            beside = (walk_of[mount, "gyro"], walk_of[mount, "accel"])
            models = models_of(campaign, named.in_blocks, beside)
            for sensor, system, walk in zip(SENSORS, models.systems(), beside, strict=True):
                if system is not None:
                    one = solved(models, sensor, system, walk, suffix)
                    extended[sensor] = one
                    covariances.append(one.covariance_rows())
                    made["parameters"] += one.rows
                    made["fit"].append(one.fit_row(fits[sensor, method], data.noise.degrees))
            found = held_out(models)
            made["gain"] += gain(models, found, mount)
            triads = {"gyro": solution.gyro, "accel": solution.accelerometer}
            changes = {
                sensor: change
                for sensor, one in extended.items()
                if (triad := triads[sensor]) is not None
                and (change := change_of(one, triad)) is not None
            }
            made["worth"] += worth(models.extended, models.effects, changes, mount)
        for sensor in SENSORS:
            own = [r for r in joint[sensor] if r["method"] == method and r["parameter"] in TWELVE]
            one_of = extended.get(sensor)
            decided = decision(sensor, mount, named, one_of, found.get(sensor), own)
            made["decision"].append(decided)
            made["result"] += result(decided, one_of, own)
            if one_of is not None:
                made["moved"] += moved(one_of, own, bool(fits[sensor, method]["scatter"]))
        if named.in_spectrum and solution.gyro is not None:
            made["gain"] += _of_spectrum(data, named, simulated, solution.gyro)
    written = {
        name: pd.DataFrame(rows, columns=[column.name for column in DECLARED.writes[name].columns])
        if rows
        else DECLARED.writes[name].empty()
        for name, rows in made.items()
    }
    return written | ({"covariance": pd.concat(covariances)} if covariances else {})


def _of_spectrum(
    data: CampaignData,
    named: Named,
    simulated: Stream,
    gyro: Triad,
) -> Iterator[Row]:
    """The gain of an oscillation, and of what goes with the table's angle."""
    for effect, values in named.in_spectrum.items():
        if effect != "oscillation":
            turns = steady_turns(data, simulated)
            yield from gain_of_ripple(turns, effect, values, data.mount)
        elif "frequency" in values:
            step_of = {m.name: data.clocks[m.log].step for m in data.plan}
            heard = [(n, r) for n, r in steady_residuals(simulated) if n in step_of]
            yield from gain_of_line(heard, step_of, values["frequency"], gyro, data.mount)


STAGE = Stage(extension, DECLARED, gathers={"mounts": campaigns_of})
