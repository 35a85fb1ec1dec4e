"""The plans in which effects are hidden: at most about 204,000 samples each.

`positions`: the demo's, after S0: six rests, six turns at 10 °/s, no heading, no temperature.
`stops`: as S3, twice as fast: from each of six positions there and back, up at 12 °/s, down at
24 °/s; heading.
`rates`: three rates both ways, the axis up and down, tumbles in steps of 45° there and back,
heading, and a temperature that is recorded and changes: every effect that any plan shows.
"""

from collections.abc import Callable, Mapping
from typing import Any

import chain
import numpy as np

HEADING = 25.0  # degrees, azimuth of the table's zero mark
# The level axis that points to the zero mark. On a side it is the table's middle axis, about
# which the case was tilted from z up: home × up.
MARKS = {"+x": "+y", "-x": "-y", "+y": "-x", "-y": "+x", "+z": "+x", "-z": "+x"}
ACROSS = {"x": "+y", "y": "+z", "z": "+x"}  # what is up where a tumble about an axis begins
TUMBLED = {"x": "-x", "y": "+y", "z": "+y"}  # and what points to the zero mark: the middle axis
SPANS = {"positions": 2800.0, "stops": 1980.0, "rates": 1410.0}  # s, from first to last sample

Document = dict[str, Any]


def positions(**changes: Any) -> Document:
    """The demo."""
    return chain.demo(**changes)


def stops(**changes: Any) -> Document:
    """As S3, a log for each of the six positions."""
    document = chain.demo(**changes)
    document["handling"] = {"still_s": 4, "change_s": 5}
    _headed(document)
    plan: list[Document] = []
    for axis in "xyz":
        for way, sign, rate in (("up", "+", 12), ("down", "-", 24)):
            at = _at(f"{axis}-{way}", sign + axis) | {"log": f"{axis}-{way}.asc"}
            turn = at | {"do": "turn", "rate_deg_s": rate, "accel_deg_s2": rate}
            rest = at | {"do": "rest", "seconds": 110}
            plan += [
                rest | {"id": f"{axis}-{way}-before"},
                turn | {"id": f"{axis}-{way}-forward", "degrees": 360},
                turn | {"id": f"{axis}-{way}-backward", "degrees": -360},
                rest | {"id": f"{axis}-{way}-after"},
            ]
    document["campaign"]["plan"] = plan
    return document


def rates(**changes: Any) -> Document:
    """Rates and tumbles in one log of columns."""
    document = chain.demo(**changes)
    document["handling"] = {
        "still_s": 4,
        "change_s": 4,
        "step": {"rate_deg_s": 30, "accel_deg_s2": 40},
    }
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["log"] = "session.csv"
    document["temperature"] = {
        "start_deg_c": 22,
        "warm_up": {"rise_k": 8, "time_constant_s": 500},
        "step": {"size_k": -6, "at_s": 1100},
    }
    _headed(document)
    plan: list[Document] = []
    for axis in "xyz":
        for way, sign, speeds in (("up", "+", (20, 40, 80)), ("down", "-", (40,))):
            at = _at(f"{axis}-{way}", sign + axis)
            plan.append(at | {"id": f"{axis}-{way}", "do": "rest", "seconds": 60})
            for rate in speeds:
                turn = at | {"do": "turn", "rate_deg_s": rate, "accel_deg_s2": 40}
                name = f"{axis}-{way}-{rate}"
                plan.append(turn | {"id": f"{name}-forward", "degrees": 360})
                plan.append(turn | {"id": f"{name}-backward", "degrees": -360})
    for axis in "xyz":
        tumble: Document = {"id": f"about-{axis}", "do": "tumble", "about": f"+{axis}"}
        tumble["mark"] = TUMBLED[axis]
        tumble |= {"up": ACROSS[axis], "step_degrees": 45, "steps": 8, "seconds": 12}
        # Two of three on the way back too show the hysteresis of all three axes.
        plan.append(tumble | {"and_back": axis != "z"})
    document["campaign"]["plan"] = plan
    return document


PLANS: Mapping[str, Callable[..., Document]] = {
    "positions": positions,
    "stops": stops,
    "rates": rates,
}


def _headed(document: Document) -> None:
    table = document["campaign"]["table"]
    document["campaign"]["table"] = table | {"heading_deg": HEADING}


def _at(position: str, up: str) -> Document:
    return {"position": position, "up": up, "mark": MARKS[up]}


def sensors(random: np.random.Generator) -> Document:
    """Sensors by chance: a mounting askew by up to half a degree, M off by 10⁻³, biases."""
    askew = random.normal(0, 3e-3, 3)
    turned = np.array(
        [[0, -askew[2], askew[1]], [askew[2], 0, -askew[0]], [-askew[1], askew[0], 0]]
    )
    made: Document = {}
    for sensor, key, bias in (("accelerometer", "bias_m_s2", 5e-3), ("gyro", "bias_rad_s", 2e-6)):
        matrix = np.eye(3) + turned + random.normal(0, 1e-3, (3, 3))
        made[sensor] = {key: random.normal(0, bias, 3).tolist(), "matrix": matrix.tolist()}
    return made
