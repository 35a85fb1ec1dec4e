"""Measured over simulated: the envelopes of long turns, and which turns are drawn."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from stages.report.sections import residuals
from stages.report.sections.residual_figures import beyond_noise
from tests.report import synthetic


def turns(tables: dict[str, Any]) -> list[residuals.Turn]:
    return residuals.drawn_turns(synthetic.tables_of(tables))


def test_only_turns_that_were_simulated_are_drawn_in_the_order_of_the_plan() -> None:
    names = [turn.name for turn in turns(synthetic.campaign(logs=()))]
    assert names == ["x-forward", "x-backward", "y-forward", "y-backward", "z-forward"]


def test_every_axis_comes_before_a_second_turn_about_one(monkeypatch: pytest.MonkeyPatch) -> None:
    tables = synthetic.campaign(logs=())
    monkeypatch.setattr(residuals, "MOST_TURNS", 3)
    assert [turn.axis for turn in turns(tables)] == ["x", "y", "z"]


def test_the_envelope_loses_no_spike_whatever_the_batches() -> None:
    tables = synthetic.campaign(logs=())
    frame = tables["simulated"].frame
    own = np.flatnonzero(frame["manoeuvre"] == "y-backward")
    frame.loc[own[4321], "residual_accel_z"] = 0.5
    [found] = [
        envelope
        for envelope in residuals.envelopes(tables["simulated"], turns(tables))
        if envelope.turn.name == "y-backward"
    ]
    least, most = found.curve("residual_accel_z")
    assert len(most) == residuals.POINTS
    assert np.nanmax(most) == 0.5
    rows = frame.iloc[own]
    assert np.nanmin(least) == rows["residual_accel_z"].min()
    measured = rows["gyro_y"] + rows["residual_gyro_y"]
    assert np.nanmin(found.curve("measured")[0]) == measured.min()
    assert np.nanmax(found.curve("measured")[1]) == measured.max()


@pytest.mark.parametrize(
    ("ratio", "count", "marked"),
    [
        (1.17, 384, True),  # 4.7 σ of an rms of so many values, √(1/(2n)) each
        (1.11, 384, False),
        (1.9, 2, False),  # two values have a spread of 0.5
        (1.04, 100_000, False),  # the level of the noise itself is not known better
        (1.06, 100_000, True),
    ],
)
def test_a_ratio_is_marked_by_how_many_values_it_is_of(
    ratio: float, count: int, marked: bool
) -> None:
    assert beyond_noise(ratio, count) == marked


def test_noise_alone_is_hardly_ever_marked() -> None:
    random = np.random.default_rng(4)
    for count in (2, 60, 384):
        ratios = np.sqrt(np.mean(random.normal(size=(2000, count)) ** 2, axis=1))
        assert np.mean([beyond_noise(ratio, count) for ratio in ratios]) < 0.01
