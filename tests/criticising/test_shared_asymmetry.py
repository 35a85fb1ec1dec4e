"""Gyros of one asymmetry, which may be a table that turns farther in one sense."""

import pytest

from inertial.campaign.effect_sentences import Estimated
from stages.criticism.confounded_causes import shared_asymmetry

PPM = 1e-6


def asymmetries(*values: float, sigma: float = 3.7) -> list[Estimated]:
    """Of the three gyros, ppm."""
    return [
        Estimated(f"a_{axis}", "1", "", value * PPM, sigma * PPM)
        for axis, value in zip("xyz", values, strict=True)
    ]


def test_turns_back_that_are_100_arcsec_short_read_as_39_ppm_of_each_gyro() -> None:
    """The asymmetry alone was named, and scale factors 11 sigma off were "usable"."""
    ((table, finding),) = shared_asymmetry(asymmetries(39.8, 40.9, 36.1), "")
    assert table == "findings" and finding["cause"] == "sense_of_turns"
    assert finding["size"] == pytest.approx(100 / 360 / 3600 / 2, rel=0.03)  # half of it each way


@pytest.mark.parametrize(
    "values", [(150, -400, 250), (120, 1, 2), (40, 60, 40)], ids=["unlike", "of x alone", "apart"]
)
def test_gyros_that_differ_have_their_own(values: tuple[float, float, float]) -> None:
    assert not [*shared_asymmetry(asymmetries(*values), "")]
