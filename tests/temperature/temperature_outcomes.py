"""A drawn campaign through the stages: each parameter's curve beside the truth and the bound."""

import time
import zlib
from functools import cache
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pandas as pd
from resumable import code_of_outcomes
from temperature_bars import Outcome
from temperature_draws import Drawn, drawn, planned
from temperature_ideal import ideal

import laboratory
from inertial.estimation.triad import linear_names

HERE = Path(__file__).parent
NAMES = [(sensor, name) for sensor in ("accel", "gyro") for name in linear_names()]
POINTS = 41  # temperatures over the range
IDEAL_DRAWS = 3  # of noise, for the ideal estimator
AWAY = 0.15  # of the distance between two nodes, at least so far from both: between nodes


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    stages = [name for name in chain.up_to("diagnosis") if name not in chain.BESIDE]
    own = [HERE / f"temperature_{name}.py" for name in ("draws", "bound", "ideal", "outcomes")]
    return code_of_outcomes(stages, own)


def outcome(name: str) -> Outcome:
    """What was hidden and what was found, as plain numbers; or the error it ended with."""
    start = time.process_time()
    try:
        told = _told(name, drawn(name))
    except Exception as error:  # it is counted, and the others go on
        told = {"error": f"{type(error).__name__}: {error}"}
    row = {"name": name, "plan": name.split("|")[0], "code": code()}
    return row | told | {"seconds": time.process_time() - start}


def _told(name: str, hidden: Drawn) -> Outcome:
    plan = planned(name.split("|")[0])
    recording = laboratory.perform(laboratory.specify(hidden.document))
    tables = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    at = np.linspace(plan.low, plan.high, POINTS)
    bound = plan.bound.of_curves(hidden.curves, hidden.coefficients, at)
    random = np.random.default_rng([2034, zlib.crc32(name.encode())])
    curves = []
    for p, (sensor, parameter) in enumerate(NAMES):
        own = [i for i, curve in enumerate(hidden.curves) if curve.parameter == p]
        shape, value, sigma = found(tables, sensor, parameter, at)
        curves.append(
            {
                "parameter": f"{sensor}/{parameter}",
                "true": hidden.curves[own[0]].shape if own else "0",
                "ratio": hidden.ratios[own[0]] if own else 0.0,
                "found": shape,
                "error": (value - hidden.truth(p, at)).tolist(),
                "sigma": sigma.tolist(),
                "bound": bound[p].tolist(),
                "ideal": [
                    ideal(hidden, i, name.split("|")[0], at, random).error.tolist()
                    for i in own
                    for _ in range(IDEAL_DRAWS)
                ],
            }
        )
    causes = tables["diagnosis/causes"]["cause"].tolist()
    return {"at": at.tolist(), "between": between(plan.nodes, at), "curves": curves} | {
        "causes": causes
    }


def between(nodes: Any, at: Any) -> list[bool]:
    """Which temperatures lie between two nodes, and near none."""
    ordered = np.sort(nodes)
    place = np.clip(np.searchsorted(ordered, at), 1, len(ordered) - 1)
    low, high = ordered[place - 1], ordered[place]
    share = (at - low) / (high - low)
    return [bool(AWAY <= one <= 1 - AWAY) for one in share]


def found(tables: Any, sensor: str, parameter: str, at: Any) -> tuple[str, Any, Any]:
    """The shape that the result gives to a parameter, its values and sigmas at temperatures."""
    rows = tables["diagnosis/temperature_curves"]
    own = rows[(rows["sensor"] == sensor) & (rows["parameter"] == parameter)]
    own = own.sort_values("temperature")
    if len(own):
        shape = "knee" if pd.notna(own["knot"].iloc[0]) else str(int(own["order"].iloc[0]))
        kelvin = own["temperature"].to_numpy()
        value, sigma = (np.interp(at, kelvin, own[key].to_numpy()) for key in ("value", "sigma"))
        return shape, value, sigma
    result = tables["diagnosis/result"]
    one = result[(result["sensor"] == sensor) & (result["parameter"] == parameter)]
    value, sigma = (one[key].astype(float).to_numpy() for key in ("value", "sigma"))
    nothing = np.full(len(at), np.nan)
    if not len(one):
        return "0", nothing, nothing
    return "0", np.full(len(at), value[0]), np.full(len(at), sigma[0])
