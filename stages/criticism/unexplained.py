"""What is left of the residuals when everything that was named is taken out."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from inertial.estimation.least_squares import INCONSISTENT
from stages.criticism.judging import Judged

Row = dict[str, Any]

SENSOR = {"gyro": "gyros", "accel": "accelerometers"}
EXCESS = 1.2  # chi-squared per degree that the uncertainty of the noise level does not explain


def unexplained(judged: Judged, suffix: str) -> Iterator[Row]:
    """A finding for each sensor that the named effects do not explain."""
    chosen = list(dict.fromkeys(i for cause in judged.named.causes for i in cause.columns))
    for sensor, reduced in zip(judged.said.labels, judged.said.sensors, strict=True):
        rest, degrees, p_value = judged.said.left_over(reduced, chosen)
        if p_value >= INCONSISTENT or rest <= EXCESS * degrees:
            continue
        times = float(np.sqrt(rest / degrees))
        yield {
            "id": f"criticism/unexplained/{sensor}{suffix}",
            "cause": "unexplained",
            "sensor": sensor,
            "count": 1,
            "size": times,
            "unit": "sigma",
            "p_value": p_value,
            "severity": 2,
            "sentence": f"The residuals of the {SENSOR[sensor]} are {times:.1f} times what noise"
            " would leave, and no effect of the catalogue explains it.",
            "consequence": "The joint estimate holds it as a scatter between manoeuvres.",
            "action": "Look at the residuals of each manoeuvre, and how the positions were set.",
        }
