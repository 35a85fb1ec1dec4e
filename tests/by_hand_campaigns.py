"""Sessions by hand from the simulated laboratory: positions whose attitudes nobody states."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import chain
import numpy as np
from moved_by_hand import TWENTY_FOUR
from ruamel.yaml import YAML

SECONDS = 6  # of each rest
LOG = "by-hand.asc"
CONSUMER = {
    "angle_random_walk_deg_sqrt_h": 0.4,
    "velocity_random_walk_m_s_sqrt_h": 0.12,
    "gyro_rate_random_walk_deg_h_sqrt_h": 0,
    "accelerometer_random_walk_m_s2_sqrt_h": 0,
}


def session(seed: int, **changes: Any) -> dict[str, Any]:
    """A consumer IMU of drawn errors in 24 drawn attitudes; `changes`: of the document."""
    rng = np.random.default_rng(seed)
    ups = rng.permutation(TWENTY_FOUR) + 0.1 * rng.standard_normal((24, 3))
    plan = [
        {"id": f"p-{i:02d}", "do": "rest", "up": up.tolist(), "seconds": SECONDS, "log": LOG}
        for i, up in enumerate(ups / np.linalg.norm(ups, axis=1)[:, None])
    ]
    plan[0]["seconds"] = 20
    askew = 5e-3 * rng.standard_normal((2, 3, 3))
    document = chain.demo(seed=seed, noise=CONSUMER)
    document["campaign"] = {**document["campaign"], "plan": plan}
    document["handling"] = {"still_s": 2, "change_s": 3}
    document["truth"] = {
        "accelerometer": {
            "bias_m_s2": (0.1 * rng.standard_normal(3)).tolist(),
            "matrix": (np.eye(3) + askew[0]).tolist(),
        },
        "gyro": {
            "bias_rad_s": (5e-3 * rng.standard_normal(3)).tolist(),
            "matrix": (np.eye(3) + askew[1]).tolist(),
        },
    }
    return {**document, **changes}


def by_hand(
    document: Mapping[str, Any],
    folder: Path,
    until: str = "compensation",
    instability_deg_h: float | None = None,
) -> chain.Results:
    """The session recorded and run, of which the campaign file states no attitude.

    `instability_deg_h`: the bias instability that the data sheet of the gyros states.
    """
    campaign = chain.simulate(document, folder / "campaign")
    yaml, path = YAML(), campaign / "campaign.yaml"
    stated = yaml.load(path)
    stated["plan"] = [{"id": "by-hand", "do": "positions", "seconds": 2, "log": LOG}]
    stated["table"] = {"name": "by hand", "position_sigma_arcsec": 3600}
    if instability_deg_h is not None:
        instrument = yaml.load(chain.ROOT / "data/instruments.yaml")[stated["instrument"]]
        instrument["gyro"]["bias_instability_deg_h"] = instability_deg_h
        stated["instrument"] = instrument
    yaml.dump(stated, path)
    return chain.run(campaign, folder / "derived", until)


def truth(document: Mapping[str, Any]) -> dict[str, np.ndarray]:
    """The twelve parameters of each sensor as the result has them, in axes in which P is symmetric.

    M = P R: the result of the accelerometers is P, that of the gyros M_g Rᵀ.
    """
    told = {name: np.array(of["matrix"]) for name, of in document["truth"].items()}
    left, _size, right = np.linalg.svd(told["accelerometer"])
    rotation = left @ right
    return {
        "accel": np.append(
            (told["accelerometer"] @ rotation.T - np.eye(3)).ravel(),
            document["truth"]["accelerometer"]["bias_m_s2"],
        ),
        "gyro": np.append(
            (told["gyro"] @ rotation.T - np.eye(3)).ravel(),
            document["truth"]["gyro"]["bias_rad_s"],
        ),
    }
