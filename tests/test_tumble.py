"""Tumbles that the simulated laboratory makes are found rest by rest, with their temperatures."""

from pathlib import Path
from typing import Any

import chain
import numpy as np
import pandas as pd
import pytest
from hidden_plans import PLANS, sensors

import laboratory

FORCE = ["accel_x", "accel_y", "accel_z"]
SECONDS = 4


def tumbles(**changes: Any) -> dict[str, Any]:
    """The two tumbles of S4: 18 rests 20° apart about x and about z, and back; two mounts."""
    document = chain.demo(**changes)
    document["handling"] = {"still_s": 3, "step": {"rate_deg_s": 20, "accel_deg_s2": 40}}
    document["truth"]["mounts"] = {"tumble-xy": {"rotation_mrad": [8, -6, 4]}}
    common = {"do": "tumble", "step_degrees": 20, "steps": 18, "and_back": True}
    document["campaign"]["plan"] = [
        {"id": f"tumble-{mount}", "about": about, "up": up, "mount": f"tumble-{mount}"}
        | common
        | {"seconds": SECONDS, "log": f"tumble-{mount}.txt"}
        for mount, about, up in (("z", "+x", "+z"), ("xy", "+z", "+x"))
    ]
    return document


@pytest.fixture(scope="module", params=["RAWIMUSA", "columns"])
def tumbled(
    request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> tuple[laboratory.Recording, chain.Results]:
    """The tumbles, recorded by one receiver and by another, and where the chain finds them."""
    document = tumbles(temperature={"start_deg_c": 25, "slope_k_h": 60})
    document["receiver"]["message"] = request.param
    if request.param == "columns":
        document["campaign"]["instrument"] = {"name": "rate-table unit", "rate_hz": 100}
    recording = laboratory.perform(laboratory.specify(document))
    folder: Path = tmp_path_factory.mktemp(request.param)
    laboratory.write(recording, folder / "raw")
    return recording, chain.run(folder / "raw", folder / "derived", "segment")


def test_every_rest_of_a_tumble_is_found(
    tumbled: tuple[laboratory.Recording, chain.Results],
) -> None:
    """72 rests in their order, each within the records in which the table stood; no complaint."""
    recording, results = tumbled
    performed = results["segment/performed"]
    assert len(performed) == 72
    assert performed["found"].all()
    assert performed["complete"].all()
    segments = results["segment/segments"].set_index("manoeuvre")
    for log in recording.truth.values():
        for name, rows in log.rows.items():
            assert segments.loc[name, "phase"] == "rest"
            first, after = (int(segments.loc[name, key]) for key in ("from_record", "to_record"))
            # the tenth of a second for which the table settles is rest as well
            assert rows.start <= first < after <= rows.stop + 10
            assert after - first > 0.7 * 100 * SECONDS
    assert results["segment/findings"].empty


def test_the_force_at_every_rest_is_the_true_one(
    tumbled: tuple[laboratory.Recording, chain.Results],
) -> None:
    """M of the demo's IMU takes the true force of a rest to its mean reading, to the noise."""
    recording, results = tumbled
    truth = laboratory.read(chain.ROOT / "data/simulated/demo.yaml").sensors.accelerometer
    read = means(results["segment/blocks"], FORCE)
    for log in recording.truth.values():
        for name, rows in log.rows.items():
            force = log.force[rows.start : rows.stop].mean(axis=0)
            expected = truth.matrix @ force + truth.bias
            # 0.0064 m/s/√h over 3 s: 6e-5 m/s², and five of that
            assert read.loc[name].to_numpy() == pytest.approx(expected, abs=3.1e-4)
    bolted = recording.placements["of tumble-xy-00"].mounting
    assert np.linalg.norm(bolted - np.eye(3)) == pytest.approx(2**0.5 * 0.0108, rel=0.01)


def test_the_temperature_of_every_rest_is_known_where_the_log_tells_it(
    tumbled: tuple[laboratory.Recording, chain.Results],
) -> None:
    recording, results = tumbled
    read = means(results["segment/blocks"], ["temperature"])["temperature"]
    if isinstance(recording.campaign["instrument"], str):
        assert read.isna().all()  # RAWIMUSA has no place for it
        return
    for log in recording.truth.values():
        for name, rows in log.rows.items():
            middle = log.temperature[(rows.start + rows.stop) // 2]
            assert read[name] == pytest.approx(middle, abs=0.01)  # 60 K/h: 0.0167 K per second


def means(blocks: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """The mean of every manoeuvre."""
    return blocks.groupby("manoeuvre")[columns].mean()


def test_a_turn_beyond_both_positions_is_told_by_its_peak(
    tumbled: tuple[laboratory.Recording, chain.Results],
) -> None:
    """After 340° the table completes the circle before it comes back: y passes zero, z +g."""
    performed = tumbled[1]["segment/performed"].set_index("manoeuvre")
    peaks = performed[["peak_x", "peak_y", "peak_z"]]
    back = peaks.loc["tumble-z-back-17"]
    assert abs(back["peak_y"]) < 0.2  # m/s², of −3.3 at both ends
    assert back[["peak_x", "peak_z"]].isna().all()  # 0.06 g is no turn
    own = peaks[peaks.index.str.startswith("tumble-z-")]
    assert own.drop("tumble-z-back-17").iloc[1:].isna().all(axis=None)


def test_the_sense_of_the_last_rate_is_that_of_the_last_step(
    tumbled: tuple[laboratory.Recording, chain.Results],
) -> None:
    """Every rest on the way back is approached backwards, the first one too."""
    performed = tumbled[1]["segment/performed"].set_index("manoeuvre")
    forwards = performed[performed.index.str.startswith("tumble-z-")].iloc[1:]
    back = forwards.index.str.contains("back")
    assert set(forwards.loc[~back, "sense_x"]) == {1.0}
    assert set(forwards.loc[back, "sense_x"]) == {-1.0}
    assert forwards[["sense_y", "sense_z"]].isna().all(axis=None)


@pytest.mark.parametrize("seed", [1, 2])
def test_a_clean_tumble_whose_heading_nobody_states_shows_no_fault(seed: int) -> None:
    """The level axis of a tumble stays where it is: all its rests have one unknown azimuth.

    With one for each rest the gyros had g-sensitivities and no earth rate, with scale factors 50
    sigma off.
    """
    document = tumbles(seed=seed)
    document["handling"]["change_s"] = 4
    document["truth"] = sensors(np.random.default_rng(seed))
    tumble = {"id": "about-x", "do": "tumble", "about": "+x", "up": "+z", "step_degrees": 30}
    tumble |= {"steps": 13, "and_back": True, "seconds": 40, "log": "tumble.asc"}
    document["campaign"]["plan"] = [tumble]
    recording = laboratory.perform(laboratory.specify(document))
    results = chain.in_memory(recording, "diagnosis", chain.BESIDE)
    assert not len(results["diagnosis/causes"])
    azimuths = results["gyroscope/positions"].query("quantity == 'horizontal'")
    assert set(azimuths["position"]) == {"about-x"}
    found = results["gyroscope/parameters"].query("method == 'joint'").set_index("parameter")
    matrix = np.array(document["truth"]["gyro"]["matrix"])
    for name, true in (("cross_xy", matrix[0, 1]), ("cross_xz", matrix[0, 2])):
        assert abs(found.at[name, "value"] - true) < 4 * found.at[name, "sigma"]


@pytest.mark.slow
def test_a_table_that_counts_the_other_way_does_so_in_its_tumbles() -> None:
    """Their rests were sought in mirrored attitudes: half were missing, two seemed exchanged."""
    document = PLANS["rates"](seed=3)
    stated = {"turn": "degrees", "tumble": "about"}
    misstated: dict[str, dict[str, Any]] = {}
    for item in document["campaign"]["plan"]:
        if (key := stated.get(item["do"])) is not None:
            misstated[item["id"]] = {key: item[key]}
            other = {"+": "-", "-": "+"}
            item[key] = -item[key] if key == "degrees" else other[item[key][0]] + item[key][1]
    document["misstated"] = {"plan": misstated}
    recording = laboratory.perform(laboratory.specify(document))
    results = chain.in_memory(recording, "segment")
    assert results["segment/repairs"]["repair"].tolist() == ["sense_of_table"]
    assert results["segment/performed"]["found"].all()
    causes = set(results["segment/findings"]["cause"])
    assert causes.isdisjoint({"manoeuvre_swapped", "manoeuvre_missing"})
    taken = results["segment/manoeuvres"].set_index("manoeuvre")
    # From y up 90° about −x: z, which lay level, has come up.
    up, tumbled = (taken.loc["about-x-02", f"{of}_x" : f"{of}_z"] for of in ("up", "tumbled"))
    np.testing.assert_allclose(up.astype(float), [0, 0, 1], atol=1e-9)
    np.testing.assert_allclose(np.degrees(tumbled.astype(float)), [-90, 0, 0], atol=1e-9)
