"""Logs that a logger or a clock spoilt, line by line, are calibrated all the same."""

from collections.abc import Callable
from pathlib import Path

import chain
import numpy as np
import pytest

LOG = "session.csv"


def spoilt(folder: Path, spoil: Callable[[list[str]], list[str]]) -> chain.Results:
    """The short campaign in one log, whose lines are spoilt, with a stated bias instability."""
    document = chain.short(seed=71)
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["handling"]["change_s"] = 5
    document["campaign"]["instrument"] = {
        "name": "made up",
        "rate_hz": 100,
        "gyro": {"bias_instability_deg_h": 3.0, "source": "made up"},
    }
    for each in document["campaign"]["plan"]:
        each["log"] = LOG
    raw = chain.simulate(document, folder / "raw")
    lines = (raw / LOG).read_text().splitlines()
    (raw / LOG).write_text("\n".join(spoil(lines)) + "\n")
    return chain.run(raw, folder / "derived", "diagnosis", chain.BESIDE)


def doubled(lines: list[str]) -> list[str]:
    """Every tenth record twice, stamp and all: no piece of 16 records is without one."""
    return [line for i, line in enumerate(lines) for line in [line] * (1 + (i % 10 == 9))]


def set_back(lines: list[str]) -> list[str]:
    """The clock is set back by 30 s, longer than any rest, in the middle of the fourth."""
    after = round(3.5 * 25 * 100)
    return [
        line if i < after else f"{float(stamp) - 30:.6f},{rest}"
        for i, line in enumerate(lines)
        for stamp, rest in [line.split(",", 1)]
    ]


@pytest.mark.parametrize(("spoil", "cause"), [(doubled, "duplicate"), (set_back, "time_backwards")])
def test_the_result_is_that_of_the_truth(spoil, cause, tmp_path):
    results = spoilt(tmp_path, spoil)
    causes = results["diagnosis/causes"]["cause"]
    assert set(causes) == {cause}
    result = results["diagnosis/result"].set_index(["sensor", "parameter"])
    document = chain.short()
    for sensor, name in (("gyro", "gyro"), ("accel", "accelerometer")):
        own = result.loc[sensor]
        truth = np.diag(document["truth"][name]["matrix"]) - 1
        for axis, true in zip("xyz", truth, strict=True):
            scale = own.loc[f"scale_{axis}"]
            assert scale["value"] == pytest.approx(true, abs=4 * scale["sigma"])
