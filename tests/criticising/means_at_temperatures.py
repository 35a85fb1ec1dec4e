"""Means at temperatures as blocks: one attitude at rest and turning, made up."""

from collections.abc import Mapping

import numpy as np
import pandas as pd

from inertial import tables
from inertial.campaign.records import Manoeuvre

ICE_POINT = 273.15  # K
NOISE = {"accel": 3e-3, "gyro": 5e-5}  # m/s² and rad/s, of a mean
RATE = np.radians(-50)
COLD, WARM, MEANS = 1.0, 65.0, 29
Z = np.array([0.0, 0.0, 1.0])


def temperatures(seed: int, number: int = MEANS) -> np.ndarray:
    """K, not quite evenly spaced."""
    jitter = np.random.default_rng([seed, 7]).uniform(-0.3, 0.3, number)
    spaced = np.linspace(COLD, WARM, number)
    return ICE_POINT + spaced + jitter * (spaced[1] - spaced[0])


def manoeuvre(name: str, do: str = "rest") -> Manoeuvre:
    """With z up."""
    turns = do == "turn"
    return Manoeuvre(
        name=name,
        do=do,
        log=f"test.log:{name}",
        position=name,
        mount="as mounted",
        up=Z,
        mark=None,
        about=Z if turns else None,
        angle=None,
        angle_sigma=None,
        rate=RATE if turns else None,
        acceleration=None,
        seconds=None,
        recorded="steady" if turns else "whole",
        from_s=None,
        to_s=None,
        from_row=None,
        to_row=None,
        label=None,
    )


def blocks(
    name: str,
    seed: int,
    at: np.ndarray,
    changes: Mapping[str, np.ndarray],
    samples: float = 20_000.0,
) -> pd.DataFrame:
    """A block for each mean; `changes`: by channel, all else is noise; of a turn gyros alone."""
    rng = np.random.default_rng([seed, len(name)])
    turns = name.startswith("turn")
    table = pd.DataFrame(
        {
            "manoeuvre": name,
            "phase": "steady" if turns else "rest",
            "log": f"test.log:{name}",
            "from_record": np.arange(len(at)),
            "to_record": np.arange(len(at)) + 1,
            "time": np.nan,
            "seconds": np.nan,
            "count": samples,
            "missing_s": 0.0,
            **{
                channel: changes.get(channel, 0.0)
                + (9.8 if channel == "accel_z" else 0.0)
                + NOISE[channel.partition("_")[0]] * rng.standard_normal(len(at))
                for channel in tables.CHANNELS
            },
            "table_angle": np.nan,
            "temperature": at,
            "mask_share": 0.0,
        }
    )
    if turns:
        table[["accel_x", "accel_y", "accel_z", "gyro_x", "gyro_y"]] = np.nan
    return table
