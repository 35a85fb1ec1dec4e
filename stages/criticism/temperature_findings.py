"""What goes with the temperature where only means at temperatures were recorded.

Without time there is no noise, and the joint estimate determines nothing; so readings are held
against the temperature itself. A finding for each sensor and manoeuvre: along a polynomial up to
the third degree it has a law, and the effects that may be it are named; what no such law holds is
structure, and a knee is looked for.
"""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd

from inertial.campaign.records import Manoeuvre
from inertial.effects import CATALOGUE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE
from stages.criticism import temperature_words as words
from stages.criticism.temperature_models import SHOWS, Moving, moving
from stages.criticism.temperature_sweeps import ACCELEROMETERS, SCALE, sweeps

Row = dict[str, Any]


def findings(
    blocks: pd.DataFrame, plan: Sequence[Manoeuvre], level: float, suffix: str
) -> Iterator[Row]:
    """The findings of one mount; none where times were recorded, for there equations tell it.

    `level`: accepted chance of a law where there is none, and of a structure.
    """
    for told in moving(sweeps(blocks, plan), level):
        yield _finding(told, suffix)


def _finding(told: Moving, suffix: str) -> Row:
    sweep, best, able = told.sweep, told.best, members(told)
    if told.structured:
        verdict, p_value = UNKNOWN_STRUCTURE, best.chance_beyond
        statistic, degrees = best.curve.left_chi_squared()
    else:
        verdict, p_value = ONE_OF_CLASS if len(able) > 1 else FOUND, best.chance
        statistic, degrees = best.curve.drop(range(1, best.degree + 1)), best.degree
    split = words.split(told)
    return {
        "id": f"criticism/temperature/{sweep.manoeuvre.name}/{sweep.kind}{suffix}",
        "cause": UNKNOWN_STRUCTURE if told.structured else next(iter(able)),
        "sensor": sweep.sensor,
        "axis": best.axis,
        "log": sweep.manoeuvre.log,
        "manoeuvre": sweep.manoeuvre.name,
        "count": 1,
        "size": best.change,
        "unit": words.UNITS[sweep.kind].si,
        "p_value": p_value,
        "severity": 2,
        "sentence": words.sentence(told, able),
        "consequence": words.consequence(told),
        "action": words.action(told, split),
        "verdict": verdict,
        "members": ", ".join(able),
        "statistic": statistic,
        "degrees": degrees,
        "snr": float(np.sqrt(max(statistic - degrees, 0.0))),
        "parameters": "; ".join(words.parameters(told)),
        "split_manoeuvre": split,
    }


def members(told: Moving) -> dict[str, list[str]]:
    """The effects that may be it, the likeliest first, each with the axes that it can move.

    A tilt moves an accelerometer across the vertical by g · angle, one along it by half the square
    of the angle; it is thought of up to the largest one of the catalogue.
    """
    sweep, axes = told.sweep, [channel.axis for channel in told.channels]
    if sweep.kind == SCALE:
        able = {"gyro_scale_temperature": axes, "table_speed_error": axes}
        return able if sweep.unbiased else able | {"gyro_bias_temperature": axes}
    if sweep.kind != ACCELEROMETERS:
        return {"gyro_bias_temperature": axes}
    able = {"accel_bias_temperature": axes}
    if upright := [axis for axis in axes if not sweep.along(axis) < SHOWS]:
        able["accel_scale_temperature"] = upright
    leaning = told.leaning
    if leaning and np.linalg.norm([*leaning.values()]) <= CATALOGUE["table_tilt"].largest:
        able["table_tilt"] = [*leaning]
    return able
