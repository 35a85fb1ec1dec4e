"""A ripple whose periods in a turn are no whole number: the turn ends beside its stated angle."""

import chain
import hidden_plans
import pytest

NOT_NEEDED = ("studies", "comparison", "compensation")


@pytest.mark.slow
@pytest.mark.parametrize("order", [33.5, 5.25])
def test_only_the_ripple_is_named(order):
    """13.6″ at half a period too much: a turn there and one back end up to 23″ to one side.

    One effect per turn of the gyros would do that as well: an asymmetry of their scale factors.
    """
    ripple = {"order": order, "amplitude_arcsec": 13.6, "phase_deg": 122.7}
    document = chain.demo(effects={"table_ripple": ripple}, seed=71)
    results = chain.in_memory_of(document, "criticism", NOT_NEEDED)
    assert set(results["criticism/findings"]["cause"]) == {"table_ripple"}


@pytest.mark.slow
def test_rests_of_a_tumble_are_off_by_the_ripple_too():
    """15.5 periods a turn at 16.3″: at 45°, 135° … the table stands up to 16″ beside its angle."""
    ripple = {"order": 15.5, "amplitude_arcsec": 16.3, "phase_deg": 257.6}
    document = hidden_plans.rates(effects={"table_ripple": ripple}, seed=72)
    results = chain.in_memory_of(document, "criticism", NOT_NEEDED)
    assert set(results["criticism/findings"]["cause"]) == {"table_ripple"}
