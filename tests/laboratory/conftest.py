"""Campaigns for the tests of the simulated laboratory: the demo, and one without any error."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from laboratory import Recording, perform, read, specify

DEMO = Path(__file__).parents[2] / "data" / "simulated" / "demo.yaml"
IDENTITY = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]

Document = dict[str, Any]
Ideal = Callable[..., Document]


@pytest.fixture
def demo_file() -> Path:
    """data/simulated/demo.yaml."""
    return DEMO


@pytest.fixture
def demo() -> Document:
    """What data/simulated/demo.yaml says; a copy of its own for every test."""
    return read(DEMO).document


@pytest.fixture(scope="session")
def demo_recording() -> Recording:
    """The demo, performed."""
    return perform(read(DEMO))


@pytest.fixture
def ideal(demo: Document) -> Ideal:
    """The demo's laboratory with a perfect IMU on a perfect table, and another plan.

    `also`: further sections of the specification, in place of the demo's.
    """

    def document(
        *plan: Document,
        effects: Document | None = None,
        also: Document | None = None,
        **noise: float,
    ) -> Document:
        demo["campaign"]["plan"] = list(plan)
        demo["campaign"]["log"] = "all.asc"
        demo["campaign"]["table"] |= {"position_sigma_arcsec": 0, "heading_deg": 0}
        demo["truth"] = {
            "accelerometer": {"bias_m_s2": [0, 0, 0], "matrix": IDENTITY},
            "gyro": {"bias_rad_s": [0, 0, 0], "matrix": IDENTITY},
        }
        demo["noise"] = dict.fromkeys(demo["noise"], 0) | noise
        return demo | {"effects": effects or {}, "faults": []} | (also or {})

    return document


@pytest.fixture
def performed(ideal: Ideal) -> Callable[..., Recording]:
    """A perfect campaign, performed."""
    return lambda *plan, **changes: perform(specify(ideal(*plan, **changes)))
