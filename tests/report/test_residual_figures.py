"""What is left of each manoeuvre: means of what was read less what was simulated."""

from __future__ import annotations

import numpy as np
import pandas as pd
import pytest

from inertial import tables
from stages.report.sections.residual_figures import PIECES, mean_residuals
from tests.report import synthetic
from tests.report.synthetic_values import Held

BLOCKS, SAMPLES, NOISE = 20, 2000, 3e-6  # batches are shorter than the turn


def simulated() -> pd.DataFrame:
    """A rest of twenty blocks whose x gyro jumps in the middle, and a turn that is off by one."""

    def part(manoeuvre: str, phase: str, count: int) -> pd.DataFrame:
        rows = pd.DataFrame({"manoeuvre": manoeuvre, "phase": phase}, index=range(count))
        for channel in tables.CHANNELS:
            rows[f"residual_{channel}"] = 0.0
        return rows

    rest, turn = part("x-up", "rest", BLOCKS), part("x-forward", "steady", SAMPLES)
    rest["residual_gyro_x"] = np.where(np.arange(BLOCKS) < BLOCKS / 2, 0.0, 1e-5)
    turn["residual_accel_z"] = 1.0 + np.where(np.arange(SAMPLES) % 2, 0.5, -0.5)
    return pd.concat([rest, turn], ignore_index=True)


def test_a_rest_is_told_in_pieces_and_a_turn_as_a_whole() -> None:
    noise = [
        {"manoeuvre": name, "channel": channel, "noise_rms": NOISE}
        for name in ("x-up", "x-forward")
        for channel in tables.CHANNELS
    ]
    plan = pd.DataFrame({"manoeuvre": ["x-forward", "x-up", "never-recorded"]})
    left = mean_residuals(
        synthetic.tables_of(
            {"simulated": Held(simulated()), "fidelity": pd.DataFrame(noise), "manoeuvres": plan}
        )
    )
    turn, rest = left["gyro"]
    assert [turn.manoeuvre, rest.manoeuvre] == ["x-forward", "x-up"]  # as planned
    assert rest.mean.shape == (PIECES, 3)
    assert rest.mean[:, 0] == pytest.approx([0, 0, 0.5e-5, 1e-5, 1e-5])
    assert rest.sigma == pytest.approx(NOISE / np.sqrt(BLOCKS / PIECES))
    turn = left["accel"][0]
    assert turn.mean == pytest.approx(np.array([[0, 0, 1.0]]))
    assert turn.sigma == pytest.approx(NOISE / np.sqrt(SAMPLES))
