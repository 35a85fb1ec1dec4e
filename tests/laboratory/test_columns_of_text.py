"""A log of columns, which has the temperature, and the format that the campaign tells of it."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from laboratory import Recording, SpecificationError, perform, specify

Document = dict[str, Any]
REST = {"id": "still", "do": "rest", "up": "+z", "seconds": 20}
WARMING = {"start_deg_c": -1.5, "slope_k_h": 360}


@pytest.fixture
def document(ideal: Callable[..., Document]) -> Document:
    document = ideal(REST, also={"temperature": WARMING}, velocity_random_walk_m_s_sqrt_h=0.01)
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "made up"}
    return document


def table(recording: Recording) -> Any:
    """The numbers of the only log."""
    text = recording.logs["all.asc"].decode("ascii")
    return np.genfromtxt(text.splitlines(), delimiter=",", names=True)


def test_times_counts_and_temperatures_stand_in_columns(document: Document) -> None:
    recording = perform(specify(document))
    rows, truth = table(recording), recording.truth["all.asc"]
    assert rows["time"] == pytest.approx(0.01 * np.arange(2000), abs=1e-12)
    for sensor, counts in (("gyro", truth.gyro), ("accel", truth.accelerometer)):
        read = np.column_stack([rows[f"{sensor}_{axis}"] for axis in "xyz"])
        assert np.array_equal(read, counts)
    assert rows["temperature"] == pytest.approx(-1.5 + 0.1 * rows["time"], abs=5.1e-4)


def test_the_campaign_tells_the_format_by_which_counts_become_rates(document: Document) -> None:
    recording = perform(specify(document))
    layout = recording.campaign["instrument"]["format"]
    assert recording.campaign["instrument"]["name"] == "made up"
    assert [layout[key] for key in ("kind", "delimiter", "header_lines")] == ["columns", ",", 1]
    names = recording.logs["all.asc"].split(b"\n")[0].decode().split(",")
    told = [layout["time"], layout["temperature"]]
    assert [one["column"] for one in told] == [names[0], names[-1]] == ["time", "temperature"]
    assert layout["gyro"]["columns"] == names[1:4]
    assert layout["accelerometer"]["columns"] == names[4:7]
    force = table(recording)["accel_z"] / layout["accelerometer"]["counts_per_unit"]
    assert layout["accelerometer"]["unit"] == "m/s2"
    assert force.mean() == pytest.approx(9.7936, abs=1e-3)


def test_faults_reach_the_columns_too(document: Document) -> None:
    """A lost stretch takes its temperatures along; a clock that is set back reads below 0."""
    document["faults"] = [
        {"lose": {"log": "all.asc", "line": 101, "samples": 900}},
        {"turn_back": {"log": "all.asc", "line": 1, "seconds": 0.5}},
    ]
    rows = table(perform(specify(document)))
    assert len(rows) == 1100
    assert rows["time"][[0, 99, 100]] == pytest.approx([-0.5, 0.49, 9.5])
    assert rows["temperature"][100] == pytest.approx(-0.5, abs=1e-3)


def test_an_instrument_of_the_list_has_a_format_already(document: Document) -> None:
    document["campaign"]["instrument"] = "span-cpt"
    with pytest.raises(SpecificationError, match=r"campaign.instrument: found span-cpt"):
        specify(document)


def test_effects_of_temperature_need_a_temperature(document: Document) -> None:
    del document["temperature"]
    document["effects"] = {"gyro_bias_temperature": {"k_deg_h_k": [1, 1, 1]}}
    with pytest.raises(SpecificationError, match=r"temperature: found nothing; expected its cours"):
        specify(document)
