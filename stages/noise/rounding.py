"""What the rounding of coarse counts makes the mean of a manoeuvre uncertain by."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, Booleans
from inertial.sensors import COLUMNS
from inertial.signal.scatter import noise_before_rounding, rounded_mean, smallest_step
from stages.noise.spectra import Spectra

Level = tuple[str, str, str]  # manoeuvre, phase, channel

MAX_COARSE_VARIANCE = 0.5  # steps²: rounding alone makes up to a quarter
MIN_ROUNDED_MEAN = 1e-3  # steps
MAX_ALIKE = 0.25  # steps between means whose errors have anything in common
DEAD = 1e-6  # steps, by which the means of a channel differ that reads the same in all


def count_sizes(changes: Array, readings: Array) -> Array:
    """The size of a count of each channel, (6,): the smallest of its changes.

    That of a channel which stands still in each piece is no larger than the smallest difference of
    the magnitudes of readings of its sensor, or change of another axis.

    Parameters
    ----------
    changes : (6,), the smallest change of each channel within unbroken pieces, infinite for none
    readings : (pieces, 6), one of each piece
    """
    sizes = changes.copy()
    for columns in COLUMNS.values():
        seen = np.unique(np.abs(readings[:, columns]))
        least = min(smallest_step(seen[np.isfinite(seen)]), changes[columns].min())
        sizes[columns] = np.where(np.isfinite(changes[columns]), changes[columns], least)
    return sizes


def rounding_levels(
    spectra: Mapping[tuple[str, str], Spectra], counts: Array
) -> dict[Level, float]:
    """What the rounding of readings adds to the level of each manoeuvre, phase and channel.

    counts : (6,), the size of a count of each channel

    The mean of a manoeuvre is off by the same however long it is; so is the sigma that this level
    gives it. Means that are alike are off by the same, so each of k of them has √k of it.

    The variance of rounded readings depends on where the truth lies between two steps: half-way it
    is 1/4, with next to no noise. So the noise is that of the mean variance of all rests, and a
    channel that may stand half-way in all of them has that of the quietest axis of its sensor. A
    manoeuvre that clearly shakes has its own.
    """
    found: dict[Level, float] = {}
    for sensor, columns in COLUMNS.items():
        means = {
            place: _means_of(spectra, sensor, place, float(counts[place]))
            for place in np.arange(6)[columns]
            if np.isfinite(counts[place])
        }
        known = {place: own for place, own in means.items() if own.keys}
        noises = {place: own.noise_at_rest * counts[place] for place, own in known.items()}
        alive = [noises[place] for place, own in known.items() if not own.dead]
        for place, own in known.items():
            noise = min(alive or noises.values()) / counts[place]
            off = rounded_mean(np.where(own.coarse, noise, noise_before_rounding(own.spread)))
            level = off * counts[place] * np.sqrt(own.alike * own.seconds)
            found |= {
                (*key, tables.CHANNELS[place]): size
                for key, one, size in zip(own.keys, off, level.tolist(), strict=True)
                if one > MIN_ROUNDED_MEAN
            }
    return found


def carried_rounding(
    spectra: Mapping[tuple[str, str], Spectra], counts: Array, noise: pd.DataFrame
) -> dict[str, float]:
    """The quantisation of channels whose coarse counts carry over what they leave, rad or m/s.

    A sum of increments is then off by what is left over at either edge, up to one count, whatever
    the sum is. Of counts that are finer than the noise of a sample the fit of the terms shows it;
    of coarser ones at rest it goes in steps, of which no spectrum is that of the term.

    counts : (6,), the size of a count of each channel
    noise : table of stage noise
    """
    found: dict[str, float] = {}
    white = noise.groupby("channel")["white_noise"].median()
    for channel, count in zip(tables.CHANNELS, counts.tolist(), strict=True):
        sensor = channel.split("_")[0]
        own = [one for one in spectra.values() if sensor in one.carried and sensor in one.samples]
        if not own or channel not in white or not np.isfinite(count):
            continue
        interval = sum(sum(one.seconds[sensor]) for one in own)
        interval /= sum(one.samples[sensor] for one in own)
        if count > white[channel] / np.sqrt(interval):
            found[channel] = count * interval / np.sqrt(12)
    return found


@dataclass(frozen=True)
class _Means:
    """The means of one channel by manoeuvre and phase: `keys`, and (n,) of each, in steps.

    mean, spread: of the readings, steps and steps²; coarse: whether the latter is little; seconds:
    how long they are.
    """

    keys: Sequence[tuple[str, str]]
    mean: Array
    spread: Array
    seconds: Array

    @property
    def alike(self) -> Array:
        """How many means share their error."""
        apart = np.minimum(np.abs(self.mean - self.mean[:, None]), MAX_ALIKE)
        return np.asarray(np.sum(np.cos(2 * np.pi * apart), axis=1))

    @property
    def dead(self) -> bool:
        """Whether it reads the same in all manoeuvres, and so says nothing of other axes."""
        return not self.spread.any() and bool(np.ptp(self.mean) < DEAD)

    @property
    def coarse(self) -> Booleans:
        return np.asarray(self.spread < MAX_COARSE_VARIANCE)

    @property
    def noise_at_rest(self) -> float:
        """Steps, by the mean variance of the rests; infinite where no channel is coarse."""
        resting = self.coarse & np.array([phase == "rest" for _manoeuvre, phase in self.keys])
        of = resting if resting.any() else self.coarse
        return float(noise_before_rounding(self.spread[of].mean())) if of.any() else np.inf


def _means_of(
    spectra: Mapping[tuple[str, str], Spectra], sensor: str, place: int, step: float
) -> _Means:
    own = {
        key: one
        for key, one in spectra.items()
        if sensor not in one.carried and np.isfinite(one.squares[place])
        if sensor in one.samples
    }
    count = np.array([one.samples[sensor] for one in own.values()])
    spread = np.array([one.squares[place] for one in own.values()]) / count / step**2
    mean = np.array([one.sums[place] for one in own.values()]) / count / step
    seconds = np.array([sum(one.seconds[sensor]) for one in own.values()])
    return _Means(list(own), mean, spread, seconds)
