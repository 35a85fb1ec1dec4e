"""What the diagnosis says of real recordings, of which others know what is in them."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pytest
from ruamel.yaml import YAML
from scipy.io import loadmat

GYRO = {"columns": [4, 5, 6], "unit": "rad/s"}
BOTH = {"gyro_g_sensitivity", "gyro_bias_per_log"}
# s, at rest before the IMU is turned by hand from position to position.
BY_HAND = [{"id": "by-hand", "do": "positions", "seconds": 1}]


def campaign(folder: Path, instrument: Mapping[str, Any], plan: Any, **more: Any) -> Path:
    """A campaign file beside logs of columns without a header."""
    document = {
        "campaign": 1,
        "instrument": dict(instrument),
        "serial": "unknown",
        "date": "unknown",
        "site": {"latitude_deg": 50.0, "height_m": 200},
        "table": {"name": "by hand", "position_sigma_arcsec": 3600},
        "plan": plan,
    } | more
    with (folder / "campaign.yaml").open("w", encoding="utf-8") as file:
        YAML().dump(document, file)
    return folder


def columns(**sensors: Any) -> dict[str, Any]:
    """The format of columns at 100 Hz without a time."""
    return {"kind": "columns", "header_lines": 0, "time": {"rate_hz": 100}, **sensors}


def diagnosed(raw: Path, derived: Path) -> chain.Results:
    return chain.run(raw, derived, "diagnosis", ("studies", "comparison"))


@pytest.fixture
def raw(tmp_path) -> Path:
    folder = tmp_path / "raw"
    folder.mkdir()
    return folder


def test_ctu_gyros_of_one_attitude_each_leave_g_sensitivity_and_bias_of_each_run_in_one_class(
    recordings, raw
):
    """Three runs, each gyro turned in one attitude alone: SOURCE.md."""
    runs = loadmat(recordings / "ctu_prague/measured_angular_rates.mat")
    angles = {"x": 361.338, "y": 367.160, "z": 363.670}  # degrees, by their reference
    plan = []
    for axis, angle in angles.items():
        np.savetxt(raw / f"{axis}.csv", runs[f"{axis}_rotation"], delimiter=",")
        turn = {"id": f"{axis}-turn", "do": "turn", "up": f"+{axis}", "log": f"{axis}.csv"}
        plan.append(turn | {"degrees": angle, "degrees_sigma": 0.1})
    gyro = {"columns": [1, 2, 3], "unit": "deg/s"}
    form = columns(delimiter=",", gyro=gyro)
    campaign(raw, {"name": "ctu", "rate_hz": 100, "format": form}, plan)
    results = diagnosed(raw, raw.parent / "derived")
    causes = results["diagnosis/causes"]
    named = causes[causes["cause"].isin(BOTH)]
    members = results["diagnosis/members"]
    assert len(named) == 1 and set(named["verdict"]) == {"one_of_class"}
    assert set(members[members["cause"].isin(named["id"])]["member"]) == BOTH
    # By simple integration, SOURCE.md: 0.9950, 0.9998, 1.0055.
    result = results["diagnosis/result"].set_index(["sensor", "parameter"]).loc["gyro"]
    scales = result.loc[["scale_x", "scale_y", "scale_z"]]
    off = scales["value"] - [-0.0050, -0.0002, 0.0055]
    assert (off.abs() < 3 * scales["sigma"]).all()
