"""A temperature that the campaign states for its manoeuvres: used where none is recorded."""

from typing import Any

import chain
import numpy as np
import pytest

import laboratory
from inertial.tables.errors import Refusal

ICE = 273.15  # K


def stated(*temperatures: float | None, **sigma: float) -> dict[str, Any]:
    """Six rests of 20 s, the first of them with a stated temperature, °C."""
    document = chain.short()
    plan = document["campaign"]["plan"][:6]
    for manoeuvre, temperature in zip(plan, temperatures, strict=False):
        if temperature is not None:
            manoeuvre |= {"temperature_deg_c": temperature, **sigma}
    document["campaign"]["plan"] = plan
    return document


def segmented(document: dict[str, Any]) -> chain.Tables:
    return chain.in_memory(laboratory.perform(laboratory.specify(document)), "segment")


def by_thermometer(document: dict[str, Any], at: float) -> dict[str, Any]:
    """The same with a log of columns, whose thermometer reads a temperature, °C."""
    instrument = {"name": "made up", "rate_hz": 100}
    document["campaign"]["instrument"] = instrument
    document["receiver"]["message"] = "columns"
    return document | {"temperature": {"start_deg_c": at}}


def test_blocks_have_the_stated_temperature() -> None:
    tables = segmented(stated(-10.0, 40.0, temperature_sigma_k=0.5))
    manoeuvres = tables["segment/manoeuvres"].set_index("manoeuvre")
    assert manoeuvres.loc["x-up", "temperature"] == pytest.approx(263.15)
    assert manoeuvres.loc["x-down", "temperature_sigma"] == 0.5
    own = tables["segment/blocks"].groupby("manoeuvre")["temperature"]
    assert own.mean()["x-up"] - ICE == pytest.approx(-10) and own.std()["x-up"] == 0
    assert own.mean()["x-down"] - ICE == pytest.approx(40)
    assert np.isnan(own.mean()["y-up"])
    assert tables["segment/findings"].empty


def test_a_recorded_temperature_counts_and_a_contradiction_is_reported() -> None:
    """Stated 22.5 and 26 °C ± 1 K where the thermometer reads 25: 2.5 sigma, and 1."""
    tables = segmented(by_thermometer(stated(22.5, 29.0, 26.0), 25.0))
    assert np.allclose(tables["segment/blocks"]["temperature"] - ICE, 25.0)
    (finding,) = tables["segment/findings"].to_dict("records")
    assert (finding["cause"], finding["size"]) == ("temperature_misstated", pytest.approx(-4.0))
    assert "x-down" in finding["sentence"] and "29.0 °C" in finding["sentence"]


@pytest.mark.slow
def test_its_own_sigma_decides() -> None:
    assert segmented(by_thermometer(stated(29.0, temperature_sigma_k=2), 25.0))[
        "segment/findings"
    ].empty
    tight = segmented(by_thermometer(stated(25.5, temperature_sigma_k=0.1), 25.0))
    assert list(tight["segment/findings"]["cause"]) == ["temperature_misstated"]


def test_a_sigma_of_no_temperature_is_refused() -> None:
    document = stated()
    document["campaign"]["plan"][0]["temperature_sigma_k"] = 1.0
    with pytest.raises(Refusal, match="add temperature_deg_c"):
        segmented(document)
