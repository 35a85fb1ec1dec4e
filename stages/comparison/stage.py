"""What should agree: rests and turns, both ways of turning, methods, rates."""

from collections.abc import Iterator, Sequence

import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.differences import Difference, table_of
from inertial.campaign.solution import scatter_by_mount
from inertial.tables.stage import Stage, Tables
from stages.comparison.compared import (
    Results,
    forward_against_backward,
    method_against_method,
    static_against_turns,
    straight_line,
)
from stages.comparison.declared import DECLARED


def comparison(
    mounts: Sequence[CampaignData],
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    *,
    level: float,
) -> Tables:
    """Every difference in units of its sigma, with the verdict in a sentence.

    They are evidence for the diagnosis: the result that counts is not known yet.
    """
    scatter = scatter_by_mount(gyroscope_fit)

    def of_mount(data: CampaignData) -> Iterator[Difference]:
        gyro = Results("gyroscope", gyroscope_parameters, data.mount)
        accelerometer = Results("accelerometer", accelerometer_parameters, data.mount)
        yield from static_against_turns(data, gyro)
        between = scatter.get(data.mount, 0.0)
        yield from forward_against_backward(data, gyro, between)
        for method in ("six_position", "pooled_positions"):
            yield from method_against_method(accelerometer, method)
        for method in ("turns", "turn_and_stop", "stops", "rate_table"):
            yield from method_against_method(gyro, method)

    differences = [difference for data in mounts for difference in of_mount(data)]
    differences += straight_line(
        [run for data in mounts for run in data.gyro_inputs.steady_rates],
        mounts[0].earth,
        [scatter.get(data.mount, 0.0) for data in mounts],
    )
    return {"differences": table_of(differences, level)}


STAGE = Stage(comparison, DECLARED, gathers=MOUNTS)
