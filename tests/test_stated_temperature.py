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


def test_in_one_log_without_a_thermometer_what_is_not_stated_stays_unknown() -> None:
    document = stated(-10.0, 40.0)
    document["handling"] |= {"change_s": 10}
    for manoeuvre in document["campaign"]["plan"]:
        manoeuvre["log"] = "session.asc"
    tables = segmented(document)
    own = tables["segment/blocks"].groupby("manoeuvre")["temperature"]
    assert own.mean()["x-up"] - ICE == pytest.approx(-10) and np.isnan(own.mean()["y-up"])
    assert tables["segment/findings"].empty


def test_where_the_thermometer_reads_nothing_it_is_as_warm_as_before_and_after() -> None:
    """20, ?, 30, ?, 30.2, ? °C in one log: 25, 30.1, and 30.2 °C, the last of no other side."""
    warm = {"x-up": 20.0, "y-up": 30.0, "z-up": 30.2}
    document = stated()
    document["handling"] |= {"change_s": 10}
    for manoeuvre in document["campaign"]["plan"]:
        manoeuvre["log"] = "session.asc"
    recording = laboratory.perform(laboratory.specify(document))
    decoded = chain.in_memory(recording, "quality")
    rests = chain.in_memory(recording, "segment", onto=decoded.copy())["segment/segments"]
    samples = decoded["decode/samples"].copy()
    samples["temperature"] = np.nan
    for name, degrees in warm.items():
        own = rests[rests["manoeuvre"] == name]
        first, after = own["from_record"].min(), own["to_record"].max()
        samples.loc[samples["record"].between(first, after - 1), "temperature"] = degrees + ICE
    changed = decoded.replaced("decode/samples", samples)
    tables = chain.in_memory(recording, "segment", onto=changed)
    means = tables["segment/blocks"].groupby("manoeuvre")["temperature"].mean() - ICE
    assert means["x-down"] == pytest.approx(25.0, abs=1.0)
    assert means["y-down"] == pytest.approx(30.1, abs=0.05)
    assert means["z-down"] == pytest.approx(30.2)
    findings = tables["segment/findings"].set_index("manoeuvre")
    assert list(findings.index) == ["x-down", "y-down", "z-down"]
    assert set(findings["cause"]) == {"temperature_unknown"}
    assert dict(findings["severity"]) == {"x-down": 2, "y-down": 1, "z-down": 2}
    assert findings.loc["x-down", "size"] == pytest.approx(10.0)


def test_a_sigma_of_no_temperature_is_refused() -> None:
    document = stated()
    document["campaign"]["plan"][0]["temperature_sigma_k"] = 1.0
    with pytest.raises(Refusal, match="add temperature_deg_c"):
        segmented(document)
