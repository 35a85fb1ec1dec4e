"""Jumps of the angle of the table's encoder that the gyros do not feel, in stretches of records."""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.encoder_edges import stretches_with_angle
from inertial.campaign.masked_samples import Batch
from inertial.campaign.sums import Stretches
from inertial.tables import GYRO

JUMP_SECONDS = 0.1  # within which an encoder jumps, in its log of 10 Hz or more
MIN_SCATTERS = 10.0  # of the differences over that time, from which one is a jump
MAX_EVEN_PAUSE = 1.5  # sample intervals: over more nothing is known of what the gyros felt
SIGMA_OF_DEVIATION = 1.4826  # of normal noise, by its median absolute deviation


@dataclass(frozen=True)
class Jump:
    """The largest of a stretch: by how much, and at which angle of the encoder, rad; NaN: none."""

    size: float = np.nan
    at: float = np.nan


class JumpsOver:
    """The largest jump of the encoder against the gyros in each of some stretches of records.

    An encoder and the gyros differ by a scale factor, a bias and a delay, so slowly; what they
    differ by within a tenth of a second, beyond its median and ten times its scatter, is a jump of
    the encoder's count, for no table turns so without its gyros.

    about : by log the axis of each stretch, (k, 3), unit vectors in body axes
    """

    columns = ("time", "table_angle", *GYRO)

    def __init__(self, stretches: Stretches, about: dict[str, Array]) -> None:
        self._stretches, self._about = stretches, about
        self._jumps = {log: [Jump()] * len(axes) for log, axes in about.items()}

    def add(self, batch: Batch) -> None:
        """Take in the next batch."""
        rates = np.column_stack([batch[name] for name in GYRO])
        for k, start, end in stretches_with_angle(batch, self._stretches):
            own = self._jumps[batch.log]
            part, axis = slice(start, end), self._about[batch.log][k]
            along = rates[part][:, axis != 0] @ axis[axis != 0]
            jump = largest_jump(batch["time"][part], batch["table_angle"][part], along)
            if not abs(jump.size) <= abs(own[k].size):
                own[k] = jump

    def result(self) -> dict[str, list[Jump]]:
        """By log, in the order of the stretches."""
        return self._jumps


def largest_jump(time: Array, angle: Array, rate: Array) -> Jump:
    """The largest jump of an encoder beyond its scatter; time, s, angle, rad, rate, rad/s, (n,)."""
    pause = np.diff(time)
    if len(pause) < 2 or not (np.isfinite(pause).all() and np.isfinite(angle).all()):
        return Jump()
    step = float(np.median(pause))
    span = round(JUMP_SECONDS / step) if step > 0 else 0
    if span < 1 or len(time) <= 4 * span:
        return Jump()
    sense = np.sign(np.nansum(rate * np.append(pause, step)) * (angle[-1] - angle[0]))
    off = np.diff(angle) - sense * rate[1:] * pause
    off[pause > MAX_EVEN_PAUSE * step] = np.nan  # and with it every difference over it
    beyond = np.convolve(off, np.ones(span), "valid")
    known = np.isfinite(beyond)
    if known.sum() <= 3 * span:
        return Jump()
    beyond = np.where(known, beyond - np.median(beyond[known]), 0.0)
    scatter = SIGMA_OF_DEVIATION * float(np.median(np.abs(beyond[known])))
    place = int(np.argmax(np.abs(beyond)))
    size = float(beyond[place])
    # What is off for longer than the jump takes, and the window, is no jump.
    long = np.count_nonzero(np.abs(beyond) > abs(size) / 2) > 2 * span
    if long or abs(size) <= MIN_SCATTERS * scatter:
        return Jump()
    within = np.nan_to_num(np.abs(off[place : place + span] - np.nanmedian(off)))
    return Jump(size, float(angle[place + int(np.argmax(within))]))
