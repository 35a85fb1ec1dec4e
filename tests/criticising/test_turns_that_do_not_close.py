"""A ripple whose periods in a turn are no whole number: the turn ends beside its stated angle."""

import chain
import pytest

NOT_NEEDED = ("studies", "comparison", "compensation")


@pytest.mark.parametrize("order", [33.5, pytest.param(5.25, marks=pytest.mark.slow)])
def test_only_the_ripple_is_named(order):
    """13.6″ at half a period too much: a turn there and one back end up to 23″ to one side.

    One effect per turn of the gyros would do that as well: an asymmetry of their scale factors.
    """
    ripple = {"order": order, "amplitude_arcsec": 13.6, "phase_deg": 122.7}
    document = chain.demo(effects={"table_ripple": ripple}, seed=71)
    results = chain.in_memory_of(document, "criticism", NOT_NEEDED)
    assert set(results["criticism/findings"]["cause"]) == {"table_ripple"}
