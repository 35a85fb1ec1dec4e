"""Runs of the chain that several tests of gaps look at."""

import chain
import pytest
from z_turns import recorded


@pytest.fixture(scope="session")
def gapped(tmp_path_factory) -> chain.Results:
    return recorded(tmp_path_factory.mktemp("gapped"), "gyroscope")


@pytest.fixture(scope="session")
def whole(tmp_path_factory) -> chain.Results:
    return recorded(tmp_path_factory.mktemp("whole"), "gyroscope", faults=[])
