"""How much each oscillation of the turns moves the parameters of the gyros."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign, campaign_of
from inertial.campaign.steady_residuals import SteadyTurn
from inertial.estimation.least_squares import Estimate
from stages.criticism.oscillation_search import Oscillation, without_lines


def shifts(
    data: CampaignData,
    turns: Sequence[SteadyTurn],
    oscillations: Sequence[Oscillation],
    quiet: Campaign,
) -> list[float | None]:
    """The largest shift of a parameter by each, in its sigma; None where none is determined.

    `quiet`: the campaign without any of them.
    """
    without = _estimate(quiet) if oscillations else None
    if without is None:
        return [None] * len(oscillations)
    largest = []
    for one in oscillations:
        others = [other for other in oscillations if other is not one]
        blocks = without_lines(data.blocks, turns, others)
        present = _estimate(campaign_of(replace(data, blocks=blocks)))
        largest.append(None if present is None else _largest(without, present))
    return largest


def _estimate(campaign: Campaign) -> Estimate | None:
    system = campaign.system("gyro", [], 1.0)
    return None if system is None else system.solve_shared()


def _largest(without: Estimate, present: Estimate) -> float | None:
    own = [
        i
        for i, (kind, _) in enumerate(present.names)
        if kind == "parameter" and present.determined[i]
    ]
    if not own or without.names != present.names:
        return None
    shift = np.abs(present.values - without.values) / present.sigma
    return float(shift[own].max())
