"""The joint fit without the one manoeuvre that alone carries a structure without a name.

What disturbs a manoeuvre need not have a name for the others to be free of it.
"""

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.hypotheses import UNKNOWN_STRUCTURE
from inertial.sensors import SENSORS
from inertial.text.messages import _
from inertial.text.parameters import WITHOUT_ONE
from stages.extension.candidates import Candidate
from stages.extension.estimates import Solved, solved
from stages.extension.models import PRIOR_SIGMA, SelectedSizes

Row = Mapping[str, Any]

MIN_P = 0.01  # of the fit without it: with less, noise alone does not describe the others either
LEFT_OUT = _("it alone carries a structure of the residuals that has no name")


def carried_alone(
    findings: Iterable[Row], manoeuvres: Sequence[Row], mount: str
) -> dict[str, Candidate]:
    """By sensor the fit without the manoeuvre that alone carries a structure.

    Where that fit determines all that the joint one does: else the structure `moves` nothing known.

    Parameters
    ----------
    findings, manoeuvres : rows of criticism: the structures, and which manoeuvres carry them
    """
    found = {}
    for row in findings:
        names = [each["manoeuvre"] for each in manoeuvres if each["finding"] == row["id"]]
        own = (row["cause"], row["mount"]) == (UNKNOWN_STRUCTURE, mount)
        if own and len(names) == 1 and row["moves"] is not None:
            found[row["sensor"]] = Candidate(WITHOUT_ONE, left_out=names[0])
    return found


def fit_without(
    campaign: Campaign, sensor: str, candidate: Candidate, data: CampaignData
) -> Solved | None:
    """The joint fit without its manoeuvre; None where noise does not describe the others either."""
    fit = joint_fit(campaign, sensor, candidate, data)
    return fit if fit.estimate.p_value(data.noise.degrees) >= MIN_P else None


def joint_fit(campaign: Campaign, sensor: str, candidate: Candidate, data: CampaignData) -> Solved:
    """The joint fit with the random walk of the campaign, without a manoeuvre that is left out."""
    used = set(campaign.manoeuvres).difference([candidate.left_out])
    system = campaign.system(sensor, [], PRIOR_SIGMA, used)
    assert system is not None  # it determines all parameters
    nothing_selected = SelectedSizes({sensor: None}, (), np.zeros(0), np.zeros((0, 0)))
    walk = campaign.solution.random_walks[SENSORS.index(sensor)]
    return solved(sensor, system, candidate, campaign.motion, walk, nothing_selected, data)
