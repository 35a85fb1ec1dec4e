"""A clean campaign, drawn by number, and what the stages say of it.

The truth is drawn from what the campaign states: gravity from its sigma, positions from theirs;
turns are exact, and so their angle is stated. Then errors in sigma are standard normal, if the
sigmas are right (simulation-based calibration: Talts et al. 2018).
"""

from functools import cache
from typing import Any

import chain
import numpy as np
from hidden_elsewhere import HARD
from hidden_plans import PLANS, sensors
from resumable import code_of_outcomes
from scipy.stats import chi2

import laboratory
from inertial.estimation.triad import linear_names

DRAWN_BY = ("hidden/hidden_elsewhere", "hidden/hidden_plans", "silence/silent_campaigns")
SEED = 2_026_113_025  # of all draws; none was looked at while the pipeline was written
LAW, UNEXPLAINED = "law", "unknown_structure"
UNBIASED = (  # with these noises the sigmas should hold; an oscillation may move parameters
    "plain",
    "noise off the data sheet by up to 30 %",
)
SENSORS = {"accelerometer": ("accelerometer", "bias_m_s2"), "gyroscope": ("gyro", "bias_rad_s")}
EXACT_ANGLE = 0.01  # arcsec, stated of turns that are exact


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    own = [chain.ROOT / f"tests/{name}.py" for name in DRAWN_BY]
    return code_of_outcomes(chain.up_to("diagnosis"), own)


def document_of(number: int) -> tuple[str, str, tuple[str, ...], dict[str, Any]]:
    """Its plan, its sort, what may truly be named, and what the laboratory is told."""
    hard = HARD[number % len(HARD)]
    plan = tuple(PLANS)[number // len(HARD) % len(PLANS)]
    random = np.random.default_rng([SEED, number])
    effects, noise = hard.told(random)
    document = PLANS[plan](seed=1_000_000 * SEED + number, effects=effects)
    document["noise"] = {**document["noise"], **noise}
    site, table = (document["campaign"][name] for name in ("site", "table"))
    gravity = site["gravity_m_s2"] + site["gravity_sigma_m_s2"] * random.normal()
    document["truth"] = sensors(random) | {"gravity_m_s2": float(gravity)}
    document["campaign"]["table"] = table | {"angle_sigma_arcsec": EXACT_ANGLE}
    return plan, hard.name, hard.hidden, document


def outcome(number: int) -> dict[str, Any]:
    """What is named that is not there, the chances of all tests, and the errors in sigma."""
    plan, sort, there, document = document_of(number)
    told = {"number": number, "code": code(), "plan": plan, "sort": sort}
    recording = laboratory.perform(laboratory.specify(document))
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    members = results["diagnosis/members"].groupby("cause")["member"].agg(set)
    false = [
        cause
        for cause in results["diagnosis/causes"].itertuples()
        if not {cause.cause, *members.get(cause.id, ())} & set(there)
    ]
    scores, structures = results["criticism/scores"], results["criticism/structures"]
    chances = {
        row.effect: chi2.sf(row.statistic, row.degrees)
        for row in scores.dropna(subset=["statistic", "degrees"]).itertuples()
        if row.sought_in == "blocks" and np.isnan(row.scan_value)
    }
    chances |= {
        f"structure against {row.kind}, search accounted for": row.p_value
        for row in structures.dropna(subset="p_value").itertuples()
    }
    return told | {
        "named": [one.cause for one in false if one.verdict not in (LAW, UNEXPLAINED)],
        "laws": [one.cause for one in false if one.verdict == LAW],
        "unexplained": sum(one.verdict == UNEXPLAINED for one in false),
        "chances": {name: float(p) for name, p in chances.items()},
        "errors": _errors(document, results) if sort in UNBIASED else {},
    }


def _errors(document: dict[str, Any], results: chain.Results) -> dict[str, float]:
    """Estimate less truth in sigma, of the 24 parameters that are determined."""
    errors = {}
    for stage, (sensor, bias) in SENSORS.items():
        true = document["truth"][sensor]
        values = [*(np.array(true["matrix"]) - np.eye(3)).ravel(), *true[bias]]
        table = results.parameters(stage, "joint")
        for name, value in zip(linear_names(), values, strict=True):
            row = table.loc[name]
            if np.isfinite(row["sigma"]):
                errors[f"{sensor} {name}"] = float((row["value"] - value) / row["sigma"])
    return errors
