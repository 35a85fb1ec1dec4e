"""What a calibration that leaves parameters open says about navigation, and why it is not tried."""

from collections.abc import Sequence

import numpy as np

from inertial.campaign.records import Row
from inertial.estimation.triad import linear_names
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.parameters import BIAS

SECONDS = 60.0
SENSORS = {"gyro": _("the gyros"), "accel": _("the accelerometers")}
MOST_NAMED = 6


def why_not(rows: Sequence[Row], gravity: float) -> str:
    """Which of M and bias are not determined, why, and what the biases that are lead to.

    To first order at rest: attitude b t, position g b t³/6 by a gyro's bias, b t²/2 by an
    accelerometer's (Titterton & Weston 2004, short-term propagation of errors).

    Parameters
    ----------
    rows : the result of one mount; `gravity`: m/s²
    """
    parts = []
    for sensor, name in SENSORS.items():
        own = {row["parameter"]: row for row in rows if row["sensor"] == sensor}
        values = {key: (own.get(key) or {}).get("value") for key in linear_names()}
        missing = [key for key, value in values.items() if value is None]
        if not missing:
            continue
        reasons = dict.fromkeys(str(own[key]["reason"] or "") for key in missing if key in own)
        why = "; ".join(list(filter(None, reasons))[:2])
        listed = ", ".join(missing[:MOST_NAMED])
        if len(missing) > MOST_NAMED:
            listed += _(" and {count} more", count=len(missing) - MOST_NAMED)
        parts.append(_("of {sensor} {listed} are not determined", sensor=name, listed=listed))
        parts[-1] += f" ({why})" if why else ""
    sentence = _("Nothing is navigated, for {parts}", parts="; ".join(parts))
    known = _by_biases(rows, gravity)
    return f"{sentence}. {known}" if known else sentence


def _by_biases(rows: Sequence[Row], gravity: float) -> str:
    """What the uncertainty of the biases that are determined leads to after a minute at rest."""
    sigma = {
        sensor: [
            float(row["sigma"])
            for row in rows
            if row["sensor"] == sensor and row["parameter"] in BIAS and row["sigma"] is not None
        ]
        for sensor in SENSORS
    }
    said = []
    if sigma["gyro"]:
        size = max(sigma["gyro"])
        said.append(
            _(
                "a gyro's bias {angle}″ of attitude and {metres} m",
                angle=significant(np.degrees(size * SECONDS) * 3600, 2),
                metres=significant(gravity * size * SECONDS**3 / 6, 2),
            )
        )
    if sigma["accel"]:
        metres = significant(max(sigma["accel"]) * SECONDS**2 / 2, 2)
        said.append(_("an accelerometer's bias {metres} m", metres=metres))
    if not said:
        return ""
    return _(
        "Of what is determined the largest σ adds, after {seconds:g} s at rest without an "
        "alignment to absorb it: {said}",
        seconds=SECONDS,
        said=", ".join(said),
    )
