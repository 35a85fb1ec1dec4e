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


@pytest.mark.slow
def test_accelerometers_say_nothing_of_a_clock_that_could_not_be_so_wrong():
    """Where they stand, 2″ off, is known to 5 µg: “the clock is off by −673000 ppm” set that right.

    To them a clock is a scale factor that all have in common, and the gyros know it by the earth's
    rate, which “was left out” then.
    """
    document = hidden_plans.stops(
        seed=3, effects={"accel_scale_asymmetry": {"asymmetry_micro_g_g": [0, 25, 0]}}
    )
    document["noise"] |= {
        "angle_random_walk_deg_sqrt_h": 0.002,
        "velocity_random_walk_m_s_sqrt_h": 0.0029,
    }
    document["campaign"]["table"] |= {"heading_deg": None}
    document["campaign"]["site"] |= {"gravity_sigma_m_s2": 1e-6}
    tables = chain.in_memory_of(document, "criticism", chain.BESIDE)
    (finding,) = tables["criticism/findings"].to_dict("records")
    assert finding["cause"] == "accel_scale_asymmetry"
    effects = tables["criticism/effects"].query("finding == @finding['id']").set_index("parameter")
    own = effects[effects["effect"] == "accel_scale_asymmetry"]
    assert own.loc["a_y", "value"] == pytest.approx(25e-6, abs=4 * own.loc["a_y", "sigma"])
