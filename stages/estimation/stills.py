"""The stretches of a campaign in which the IMU stands still, each with its attitude."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.records import Manoeuvre, Performed
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
    manoeuvre: Manoeuvre
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
        there = np.isfinite(self.means[used])
        weight = there * self.counts[used, None]
        lasted = (there * self.seconds[used, None]).sum(axis=0)
        with np.errstate(invalid="ignore", divide="ignore"):  # a channel that is not recorded
            mean = np.sum(weight * np.nan_to_num(self.means[used]), axis=0) / weight.sum(axis=0)
            return mean, self.density / np.sqrt(lasted)


def stills(
    blocks: pd.DataFrame,
    plan: Sequence[Manoeuvre],
    performed: Mapping[str, Performed],
    noise: NoiseLevels,
    sensor: str,
) -> tuple[list[Still], list[str]]:
    """The stretches at rest with a known attitude, and what is left out with the reason.

    After a turn the IMU stands where the turn has brought it, so that stretch counts
    where the turn was recorded from rest to rest. `sensor` is accel or gyro.
    """
    found: list[Still] = []
    left: list[str] = []
    channels = [f"{sensor}_{axis}" for axis in AXES]
    at_rest = blocks[blocks["phase"].str.startswith("rest") & (blocks["count"] > 0)]
    groups = dict(list(at_rest.groupby(["manoeuvre", "phase"])))
    for m in plan:
        if m.do == "positions":
            left.append(f"{m.name}: the attitudes of its rests are not known")
        if m.do == "rest" and not performed[m.name].found:
            left.append(f"{m.name}: not found in its log")
        for phase in ("rest", "rest-before", "rest-after"):
            part = groups.get((m.name, phase))
            if part is None or part[channels].isna().all(axis=None):
                continue
            density = noise.of(m.name, "rest", channels)
            label = m.name if phase == "rest" else f"{m.name} ({phase})"
            after, whole = phase == "rest-after", performed[m.name].complete
            if m.up is None:
                left.append(f"{label}: which way is up is not known")
            elif after and (not (whole or performed[m.name].bridged) or m.angle is None):
                left.append(f"{label}: its attitude is not known, for the turn is not whole")
            elif part["seconds"].isna().any() or np.isnan(density).all():
                left.append(f"{label}: its noise is not known, for it has no time or is too short")
            else:
                found.append(
                    Still(
                        label,
                        m,
                        m.up,
                        m.up if m.about is None else m.about,
                        (m.angle or 0.0) if after else 0.0,
                        part[channels].to_numpy(np.float64),
                        part["count"].to_numpy(np.float64),
                        part["seconds"].to_numpy(np.float64),
                        density,
                    )
                )
    return found, left


def averaging_times(found: list[Still], steps: int) -> list[float]:
    """Lengths of rest from one block to the longest, in equal ratios, s."""
    lengths = [still.seconds for still in found if still.manoeuvre.do == "rest"]
    if not lengths:
        return []
    shortest = max(float(seconds.max()) for seconds in lengths)
    longest = max(float(seconds.sum()) for seconds in lengths)
    return [float(t) for t in np.unique(np.geomspace(shortest, longest, steps).round(6))]
