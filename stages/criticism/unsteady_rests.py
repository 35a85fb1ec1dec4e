"""Whether what is a random walk by the noise at rest is too fast for one of a sensor.

The spectrum of a slow oscillation, or of one that the sampling folds to a low frequency, falls with
the frequency as that of a random walk does. But a bias wanders within a minute by less than its
readings scatter from one to the next: of all grades, from a phone's sensors to a navigation grade.
"""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.tables import ACCEL, GYRO

WITHIN = 60.0  # s


@dataclass(frozen=True)
class Unsteady:
    """By how much the readings of an axis wander in so many seconds, and one of them scatters.

    rad/s or m/s².
    """

    seconds: float
    wander: float
    scatter: float


def unsteady_rests(data: CampaignData, sensor: str, sizes: Array) -> Unsteady | None:
    """The worst axis, by random walks `sizes`, (3,), rad/s/√s or m/s²/√s; None: like a sensor's."""
    positions, _ = data.gyro_positions if sensor == "gyro" else data.accelerometer_positions
    if not positions:
        return None
    channels = GYRO if sensor == "gyro" else ACCEL
    scatters = [data.noise.of_samples(p.manoeuvre.name, "rest", channels) for p in positions]
    longest = max(float(position.seconds.sum()) for position in positions)
    seconds = min(WITHIN, longest)
    wander, scatter = sizes * np.sqrt(seconds), np.nanmedian(scatters, axis=0)
    known = np.where(scatter > 0, scatter, np.inf)  # an axis that is not read, or stands still
    worst = int(np.argmax(wander / known))
    if not wander[worst] > known[worst]:
        return None
    return Unsteady(seconds, float(wander[worst]), float(scatter[worst]))
