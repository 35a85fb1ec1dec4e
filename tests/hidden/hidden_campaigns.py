"""A drawn campaign through the whole chain, and what criticism made of it."""

import shutil
import tempfile
import time
from functools import cache
from pathlib import Path
from typing import Any

import chain
import numpy as np
from hidden_draws import WAYS, Draw

from stages.contracts.records import known_of, manoeuvres_of, performed_of, share_a_clock
from stages.criticising.judging import Judged, judge
from stages.effects import CATALOGUE
from stages.estimation.evidence import campaign_of
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.solution import solution_of

WALK = {"gyro_rate_random_walk_deg_h_sqrt_h": "gyro_random_walk"}


def run(draw: Draw) -> dict[str, Any]:
    """What was hidden and what was found, as plain numbers and text."""
    folder = Path(tempfile.mkdtemp())
    try:
        start = time.process_time()
        campaign = chain.simulate(draw.document(), folder / "raw")
        simulated = time.process_time()
        results = chain.run(campaign, folder / "derived", "criticism")
        seconds = time.process_time() - simulated
        findings = results["criticism/findings"]
        effects = results["criticism/effects"].set_index(["effect", "parameter"])
        causes = findings[findings["verdict"].notna()]
        pulls = [
            (float(row["value"]) - value) / float(row["sigma"])
            for name, values in draw.truth.items()
            if name in set(causes["cause"])
            for parameter, value in values.items()
            for row in [effects.loc[(name, parameter)]]
            if row["sigma"] and np.isfinite(row["sigma"])
        ]
        return {
            "number": draw.number,
            "kind": draw.kind,
            "hidden": sorted([*draw.effects, *(WALK[key] for key in draw.noise if key in WALK)]),
            "ratio": draw.ratio,
            "named": [
                {"cause": row["cause"], "verdict": row["verdict"]}
                | {"snr": row["snr"] if np.isfinite(row["snr"]) else None}
                | {"members": row["members"].split(", ")}
                for row in causes.to_dict("records")
            ],
            "unexplained": bool((findings["cause"] == "unexplained").any()),
            "pulls": pulls,
            "seconds": seconds,
            "simulating": simulated - start,
        }
    finally:
        shutil.rmtree(folder)


@cache
def reference() -> Judged:
    """What the plan says of every effect, by a clean campaign."""
    folder = Path(tempfile.mkdtemp())
    results = chain.run(
        chain.simulate(chain.demo(seed=9_999), folder / "raw"), folder / "derived", "gyroscope"
    )
    given, levels = known_of(results["plan/known"]), NoiseLevels(results["noise/noise"])
    stages = ("accelerometer", "gyroscope")
    tables = [
        tuple(results[f"{stage}/{table}"] for stage in stages)
        for table in ("parameters", "positions", "fit")
    ]
    solution = solution_of(tables[0], tables[1], given, "", tables[2])
    campaign = campaign_of(
        results["segment/blocks"],
        manoeuvres_of(results["plan/manoeuvres"]),
        performed_of(results["segment/performed"]),
        levels,
        given,
        solution,
        share_a_clock(results["decode/clocks"]),
    )
    shutil.rmtree(folder)
    in_blocks = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]
    return judge(campaign, in_blocks, 0.01, levels.degrees)


def size(name: str, at: float | None, values: np.ndarray) -> float:
    """The signal-to-noise ratio of an effect in this plan."""
    judged = reference()
    family = judged.families[name]
    number = 0 if at is None else int(np.argmin([abs((one.at or 0.0) - at) for one in family]))
    names = [f"{family[number].label}.{parameter}" for parameter in WAYS[name].names]
    places = [judged.said.names.index(one) for one in names]
    information = judged.said.total.information[np.ix_(places, places)]
    return float(np.sqrt(values @ information @ values))
