"""The stretches of a campaign in which the IMU stands still, each with its attitude."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.tables import AXES
from stages.model.motion import turned

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Still:
    """Means of one stretch at rest.

    `up`, `about`: (3,), body axes at the start of its manoeuvre; `angle`: rad, by which
    it has turned about `about` since; `mean`: (3,), rad/s or m/s², NaN where not recorded;
    `sigma`: (3,), what white noise leaves in it.
    """

    label: str
    row: dict[str, Any]  # its manoeuvre
    up: Array
    about: Array
    angle: float
    mean: Array
    sigma: Array

    @property
    def up_now(self) -> Array:
        """The direction that points up in this stretch, (3,)."""
        return turned(self.up, self.about, self.angle)


def vector(row: dict[str, Any], stem: str) -> Array | None:
    """The body vector `stem` of a manoeuvre; None where it is not known."""
    components = np.array([row[f"{stem}_{axis}"] for axis in AXES], dtype=np.float64)
    return None if np.isnan(components).any() else components


def stills(
    blocks: pd.DataFrame,
    plan: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    sensor: str,
    seconds: float = np.inf,
) -> tuple[list[Still], list[str]]:
    """The stretches at rest with a known attitude, and what is left out with the reason.

    After a turn the IMU stands where the turn has brought it, so that stretch counts
    where the turn was recorded whole.

    Parameters
    ----------
    sensor : accel or gyro
    seconds : only so much of each rest, from its start
    """
    found: list[Still] = []
    left: list[str] = []
    channels = [f"{sensor}_{axis}" for axis in AXES]
    done = performed.set_index("manoeuvre")
    at_rest = blocks[blocks["phase"].str.startswith("rest") & (blocks["count"] > 0)]
    groups = dict(list(at_rest.groupby(["manoeuvre", "phase"])))
    for row in plan.to_dict("records"):
        name, up, about = row["manoeuvre"], vector(row, "up"), vector(row, "about")
        if row["do"] == "rest" and not done.loc[name, "found"]:
            left.append(f"{name}: not found in its log")
        for phase in ("rest", "rest-before", "rest-after"):
            part = groups.get((name, phase))
            if part is None or part[channels].isna().all(axis=None):
                continue
            label = name if phase == "rest" else f"{name} ({phase})"
            after = phase == "rest-after"
            if up is None:
                left.append(f"{label}: which way is up is not known")
            elif after and (not done.loc[name, "complete"] or pd.isna(row["angle"])):
                left.append(f"{label}: its attitude is not known, for the turn is not whole")
            else:
                angle = float(row["angle"]) if after else 0.0
                mean, sigma = _mean(part, channels, name, noise, seconds)
                axis = up if about is None else about
                found.append(Still(label, row, up, axis, angle, mean, sigma))
    return found, left


def _mean(
    part: pd.DataFrame, channels: list[str], name: str, noise: pd.DataFrame, seconds: float
) -> tuple[Array, Array]:
    if part["seconds"].notna().all():
        begins = part["seconds"].cumsum() - part["seconds"]
        part = part[begins < seconds]
    weights = part["count"].to_numpy()
    mean = np.array([np.average(part[channel], weights=weights) for channel in channels])
    return mean, density(noise, name, "rest", channels) / np.sqrt(part["seconds"].sum())


def density(noise: pd.DataFrame, name: str, phase: str, channels: Sequence[str]) -> Array:
    """White noise of the channels, per √s: in this manoeuvre and phase, else in all rests."""
    own = noise[(noise["manoeuvre"] == name) & (noise["phase"] == phase)]
    resting = noise[noise["phase"] == "rest"]

    def one(channel: str) -> float:
        for rows in (own, resting):
            values = rows.loc[rows["channel"] == channel, "white_noise"]
            if len(values):
                return float(np.sqrt(np.mean(values**2)))
        return float("nan")

    return np.array([one(channel) for channel in channels])


def averaging_times(blocks: pd.DataFrame, steps: int) -> Iterator[float]:
    """Lengths of rest from one block to the longest, in equal ratios, s."""
    rests = blocks[(blocks["phase"] == "rest") & blocks["seconds"].notna()]
    if len(rests):
        longest = float(rests.groupby("manoeuvre")["seconds"].sum().max())
        shortest = float(rests["seconds"].max())
        yield from np.unique(np.geomspace(shortest, longest, steps).round(6)).tolist()
