"""Of a class that the data cannot distinguish, what would have to be larger than is thinkable."""

import chain
import pytest
from hidden import hidden_plans


@pytest.mark.slow
@pytest.mark.parametrize("plan", ["positions", "stops"])
def test_twice_the_earth_rate_is_not_left_out(plan):
    """On the other hemisphere, with azimuths unknown: “earth rate left out, s = 2000070 ppm”."""
    document = getattr(hidden_plans, plan)(seed=11)
    document["campaign"]["table"] |= {"heading_deg": None}
    document["truth"] |= {"latitude_deg": -document["campaign"]["site"]["latitude_deg"]}
    tables = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (finding,) = tables["criticism/findings"].to_dict("records")
    assert finding["cause"] == "latitude_sign"
    assert "earth_rate_omitted" not in set(tables["criticism/members"]["effect"])
