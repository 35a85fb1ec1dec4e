"""All that criticism may say by chance shares the one level that is set."""

import pytest

from stages.criticism import stage


def test_the_shares_of_the_level_add_up_to_it():
    shares = [value for name, value in vars(stage).items() if name.endswith("_SHARE")]
    assert len(shares) == 5 and sum(shares) == pytest.approx(1.0)
