"""Published scale factors of the gyros that are all off by one sample of their window: fencepost.

S0's table 5-5 is such a case (design study, T11 to T13): 1801 samples summed for the 1800 of 180°.
"""

from collections.abc import Iterator, Sequence
from math import pi

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.differences import Difference
from inertial.campaign.measurement import SensorResult
from inertial.campaign.records import Row, rows_of
from inertial.estimation.angle_windows import Fencepost, fencepost
from inertial.estimation.consistency import common_cause
from inertial.text.messages import _
from inertial.text.numbers import fixed, whole
from inertial.text.parameters import PARTS, SCALE
from inertial.text.units import PPM

KIND = "fencepost"
MIN_AXES = 2  # axes, for what is in common
MAX_EXPLAINED_SIGMAS = 3.0  # sigmas within which the speed of the table would explain it as well


def off_by_a_sample(
    published: pd.DataFrame,
    gyro: SensorResult,
    mount: str,
    growing: pd.DataFrame,
    motions: pd.DataFrame,
    level: float,
) -> Iterator[Difference]:
    """A single row, or none where the error is not detected.

    Where the source does not state its window, S0's is assumed: 180° at the rate and sample
    interval of the turns of this campaign, and just one sample may be too many or too few. What
    an oscillation leaves of a window that cuts it at any phase is in the sigma.
    """
    windows = [row for row in rows_of(growing) if row["by"] == "set rate"]
    scales = [
        row for row in rows_of(published) if row["sensor"] == "gyro" and row["quantity"] in SCALE
    ]
    cases = [case for row in scales if (case := _case(row, gyro, windows)) is not None]
    if len(cases) < MIN_AXES:
        return
    is_stated = all(row["samples"] is not None for row in scales)
    theirs, ours, sigma, samples = np.array(cases).T
    result, speed = fencepost(theirs, ours, sigma, samples), _speed(motions)
    if not result.is_detected(level) or not (is_stated or abs(result.whole) == 1):
        return
    if speed is not None and _explains(speed, result, samples):
        return
    yield Difference(
        kind=KIND,
        mount=mount,
        stage="gyroscope",
        quantity="scale",
        unit="1",
        first=_("the final result"),
        second=scales[0]["source"],
        first_value=None,
        second_value=None,
        sigma=None,
        between=(_("this calibration"), _("the published values")),
        remark=_words(result, samples, is_stated, speed),
    )


def _case(row: Row, gyro: SensorResult, windows: Sequence[Row]) -> tuple[float, ...] | None:
    """Published and our scale factor, sigma of their difference, and N, if all are known."""
    axis, angle = PARTS[row["quantity"]].axes, row["window"] or pi
    ours = gyro.rows.get(f"scale_{axis}")
    like = {w["axis"]: w for w in sorted(windows, key=lambda w: -abs(w["angle"] - angle))}
    # An axis without windows of its own counts with the worst of the others.
    window = like.get(axis) or max(like.values(), key=lambda w: w["cut_sigma"], default=None)
    samples = row["samples"]
    if samples is None and window is not None:
        samples = round(angle / window["angle"] * window["samples"])
    if ours is None or ours["value"] is None or not samples:
        return None
    cut = window["cut_sigma"] if window is not None else 0.0
    sigma = float(np.linalg.norm([ours["sigma"], row["sigma"] or 0.0, cut]))
    return row["value"], ours["value"], sigma, float(samples)


def _speed(motions: pd.DataFrame) -> tuple[float, float] | None:
    """By what the table turned faster than set in all turns, and the sigma; none without turns."""
    rows = [r for r in rows_of(motions) if r["quantity"] == "speed" and r["set_value"]]
    if not rows:
        return None
    excess = np.array([r["value"] / r["set_value"] - 1 for r in rows])
    sigma = np.array([r["sigma"] / r["set_value"] for r in rows])
    common = common_cause(excess, sigma)
    return common.amount, common.sigma


def _explains(speed: tuple[float, float], result: Fencepost, samples: Array) -> bool:
    """Whether a window by time is off by the same amount for the speed of the table alone."""
    common = float(result.cause.amount / samples.mean())
    sigma = float(np.hypot(speed[1], result.cause.sigma / samples.mean()))
    return abs(speed[0] - common) < MAX_EXPLAINED_SIGMAS * sigma


def _words(
    result: Fencepost, samples: Array, is_stated: bool, speed: tuple[float, float] | None
) -> str:
    ratios = ", ".join(fixed(PPM.of(ratio), 0) for ratio in result.ratios)
    counts = sorted({round(n) for n in samples})
    each = ", ".join(
        _("{whole} samples for {n}", whole=whole(n + result.whole), n=whole(n)) for n in counts
    )
    factor = f"{fixed(result.cause.amount, 2)} ± {fixed(result.cause.sigma, 2)}"
    sentence = _(
        "fencepost: the published ones differ from ours by {ratios} ppm, {factor} samples of their "
        "windows, as if {each} had been summed; a window of N samples has N + 1 edges",
        ratios=ratios,
        factor=factor,
        each=each,
    )
    if not is_stated:
        sentence += _(" (their window is not stated; 180° by time is assumed)")
    if speed is not None:
        real = f"{fixed(PPM.of(speed[0]), 1)} ± {fixed(PPM.of(speed[1]), 1)} ppm"
        sentence += _(
            ". The speed of the table is not the cause: here it is off by {real}", real=real
        )
    return sentence
