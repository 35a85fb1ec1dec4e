"""What the uncertainty of each parameter of the result comes from."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.campaign.measurement import Measurement, SensorResult
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import Row
from inertial.estimation.triad import linear_names
from inertial.estimation.uncertainty_budget import Model, budget

MAX_SIGMA_RATIO = 1.1  # of the result's sigma and that of these equations, which are not the same
BLOCKS = "blocks"  # effects that are sought elsewhere have no columns in the equations


def budget_rows(data: CampaignData, measurement: Measurement, fits: Sequence[Row]) -> Iterator[Row]:
    """A row for each parameter and source; none of positions by hand, nor of a mean over models."""
    if data.by_hand is not None or data.solution is None:
        return
    campaign = campaign_of(data)
    for result in (measurement.accelerometer, measurement.gyro):
        if result.triad is not None:
            fit = _fit(fits, data.mount, result)
            yield from _of_sensor(campaign, result, fit, data.mount) if fit else ()


def _fit(fits: Sequence[Row], mount: str, result: SensorResult) -> Row | None:
    """The fit that the result was taken from."""
    method = next(iter(result.rows.values()))["method"]
    key = (mount, result.sensor, method)
    return next((row for row in fits if (row["mount"], row["sensor"], row["method"]) == key), None)


def _of_sensor(campaign: Campaign, result: SensorResult, fit: Row, mount: str) -> Iterator[Row]:
    effects = [one.effect for one in result.effects if one.effect.sought_in == BLOCKS]
    scatter, walk = (fit[name] or 0.0 for name in ("scatter", "random_walk"))
    equations = campaign.equations(result.sensor, effects, PRIOR_SIZE, walking=bool(walk))
    if equations is None:
        return
    variances, parts = budget(Model(equations, scatter, walk))
    for i, name in enumerate(linear_names()):
        row, sigma = result.rows[name], np.sqrt(variances[i])
        if not 1 / MAX_SIGMA_RATIO < row["sigma"] / sigma < MAX_SIGMA_RATIO:
            continue
        for source, part in parts.items():
            variance = max(float(part[i]), 0.0)
            yield {
                "mount": mount,
                "sensor": result.sensor,
                "quantity": name,
                "source": source,
                "sigma": float(np.sqrt(variance)),
                "unit": row["unit"],
                "share": variance / float(variances[i]),
            }
