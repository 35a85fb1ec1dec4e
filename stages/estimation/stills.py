"""The stretches of a campaign in which the IMU stands still, each with its attitude."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.tables import AXES
from stages.estimation.noise_levels import NoiseLevels
from stages.model.motion import turned

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Still:
    """One stretch at rest in k blocks.

    `up`, `about`: (3,), body axes at the start of its manoeuvre; `angle`: rad, by which
    it has turned about `about` since; `means`: (k, 3), rad/s or m/s², NaN where not
    recorded; `counts`, `seconds`: (k,); `density`: (3,), white noise per √s.
    """

    label: str
    row: dict[str, Any]  # its manoeuvre
    up: Array
    about: Array
    angle: float
    means: Array
    counts: Array
    seconds: Array
    density: Array

    @property
    def up_now(self) -> Array:
        """The direction that points up in this stretch, (3,)."""
        return turned(self.up, self.about, self.angle)

    def over(self, seconds: float = np.inf) -> tuple[Array, Array]:
        """Mean reading over the first so many seconds, and the sigma that white noise leaves."""
        used = np.cumsum(self.seconds) - self.seconds < seconds
        mean = np.average(self.means[used], weights=self.counts[used], axis=0)
        return mean, self.density / np.sqrt(np.sum(self.seconds[used]))


def vector(row: dict[str, Any], stem: str) -> Array | None:
    """The body vector `stem` of a manoeuvre; None where it is not known."""
    components = np.array([row[f"{stem}_{axis}"] for axis in AXES], dtype=np.float64)
    return None if np.isnan(components).any() else components


def stills(
    blocks: pd.DataFrame,
    plan: pd.DataFrame,
    performed: pd.DataFrame,
    noise: NoiseLevels,
    sensor: str,
) -> tuple[list[Still], list[str]]:
    """The stretches at rest with a known attitude, and what is left out with the reason.

    After a turn the IMU stands where the turn has brought it, so that stretch counts
    where the turn was recorded whole. `sensor` is accel or gyro.
    """
    found: list[Still] = []
    left: list[str] = []
    channels = [f"{sensor}_{axis}" for axis in AXES]
    done = performed.set_index("manoeuvre")
    at_rest = blocks[blocks["phase"].str.startswith("rest") & (blocks["count"] > 0)]
    groups = dict(list(at_rest.groupby(["manoeuvre", "phase"])))
    for row in plan.to_dict("records"):
        name, up, about = row["manoeuvre"], vector(row, "up"), vector(row, "about")
        if row["do"] == "positions":
            left.append(f"{name}: the attitudes of its rests are not known")
        if row["do"] == "rest" and not done.loc[name, "found"]:
            left.append(f"{name}: not found in its log")
        for phase in ("rest", "rest-before", "rest-after"):
            part = groups.get((name, phase))
            if part is None or part[channels].isna().all(axis=None):
                continue
            density = noise.of(name, "rest", channels)
            label = name if phase == "rest" else f"{name} ({phase})"
            after = phase == "rest-after"
            if up is None:
                left.append(f"{label}: which way is up is not known")
            elif after and (not done.loc[name, "complete"] or pd.isna(row["angle"])):
                left.append(f"{label}: its attitude is not known, for the turn is not whole")
            elif part["seconds"].isna().any() or np.isnan(density).all():
                left.append(f"{label}: its noise is not known, for it has no time or is too short")
            else:
                found.append(
                    Still(
                        label,
                        row,
                        up,
                        up if about is None else about,
                        float(row["angle"]) if after else 0.0,
                        part[channels].to_numpy(),
                        part["count"].to_numpy(),
                        part["seconds"].to_numpy(),
                        density,
                    )
                )
    return found, left


def averaging_times(found: list[Still], steps: int) -> list[float]:
    """Lengths of rest from one block to the longest, in equal ratios, s."""
    lengths = [still.seconds for still in found if still.row["do"] == "rest"]
    if not lengths:
        return []
    shortest = max(float(seconds.max()) for seconds in lengths)
    longest = max(float(seconds.sum()) for seconds in lengths)
    return [float(t) for t in np.unique(np.geomspace(shortest, longest, steps).round(6))]
