"""A drawn campaign in a chamber whose hidden curves bend, from its readings to the result."""

import numpy as np
import pytest
from temperature_draws import drawn
from temperature_outcomes import outcome

NAME = "nodes|4"


@pytest.mark.slow
def test_curves_that_bend_come_back_within_their_sigma() -> None:
    """The extension ended with an exception, whatever bent."""
    assert any(curve.shape != "1" for curve in drawn(NAME).curves)
    told = outcome(NAME)
    assert "error" not in told, told
    hidden = [curve for curve in told["curves"] if curve["ratio"]]
    for curve in hidden:
        inside = np.array(told["between"])
        off = np.abs(curve["error"])[inside] / np.array(curve["sigma"])[inside]
        assert off.max() < 4 and curve["found"] != "0"
