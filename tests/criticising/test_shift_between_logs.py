"""An IMU that is mounted anew between two logs that share no clock, with the same bias."""

from typing import Any

import chain
import numpy as np

SHIFT = [300.0, -200.0, 250.0]  # arc seconds, about x, y and z


def rests_and_turns(**effects: Any) -> dict[str, Any]:
    """Six rests in one log, which ends after 150 s, and six turns in another."""
    document = chain.short(effects=effects, seed=4)
    document["handling"] |= {"still_s": 8, "change_s": 6}
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    for one in document["campaign"]["plan"]:
        one["log"] = f"{one['do']}s.csv"
        if one["do"] == "turn":
            one |= {"rate_deg_s": 20, "accel_deg_s2": 20}
    return document


def test_it_is_named_with_its_angles_and_the_manoeuvre_from_which_on_it_is() -> None:
    """What gyros tell holds for the second mounting alone: a g-sensitivity was named in it."""
    shift = {"rotation_arcsec": SHIFT, "at_s": 170.0}
    results = chain.in_memory_of(rests_and_turns(mounting_shift=shift), "diagnosis")
    (cause,) = results["diagnosis/causes"].to_dict("records")
    assert cause["cause"] == "mounting_shift" and " at x-forward:" in cause["sentence"]
    found = results["criticism/effects"].set_index(["effect", "parameter"]).loc["mounting_shift"]
    for axis, size in zip("xyz", np.radians(np.array(SHIFT) / 3600), strict=True):
        own = found.loc[f"theta_{axis}"]
        assert abs(own["value"] - size) < 3.5 * own["sigma"]
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts["gyro"] == "not_usable"  # whose turns are all in the second mounting
