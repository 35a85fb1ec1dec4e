"""Figures of a sensor by n pairs of input and output, as IEEE Std 528-2019 defines them.

Errors are relative to the largest input that was applied, the tested range, not to the range of
the data sheet.
"""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.special import log_ndtr, ndtr

from inertial.arrays import Array
from inertial.estimation.least_squares import pseudo_inverse
from inertial.estimation.probability import norm_isf

MIN_APART = 1e-3  # of the largest input: inputs that are closer count as one
CONFIDENCE = 0.95
SAME = 1e-3  # of an input, within which another is none
MAX_CHANGE = 0.1  # of the largest input: a change that says something of the resolution
SENSED_SHARE = 0.5  # of the expected output, which an input above the threshold gives at least


@dataclass(frozen=True)
class LargestError:
    """The largest error of n outputs, with its sign, over the largest input.

    `sigma`: of that output; `by_noise`: what the largest error does not exceed in 95 % of the cases
    if the outputs are in error by their sigmas alone.
    """

    value: float
    sigma: float
    by_noise: float


def composite_error(applied: Array, read: Array, sigma: Array) -> LargestError:
    """The largest difference of an output from its input ('composite error'), (n,) each."""
    return _largest(read - applied, sigma, float(np.abs(applied).max()))


def linearity_error(applied: Array, read: Array, sigma: Array) -> LargestError | None:
    """The largest deviation from the least-squares line ('linearity error'), (n,) each.

    None where fewer than three different inputs were applied: any two lie on a line.
    """
    largest = float(np.abs(applied).max())
    if len(np.unique(np.round(applied / largest / MIN_APART))) < 3:
        return None
    line = np.column_stack([np.ones(len(applied)), applied / largest])
    off_line = np.eye(len(applied)) - line @ np.linalg.pinv(line)
    return _largest(off_line @ read, np.linalg.norm(off_line * sigma, axis=1), largest)


def asymmetry(applied: Array, read: Array, sigma: Array) -> tuple[float, float] | None:
    """Scale factor of positive input less that of negative, over both, and its sigma.

        output = bias + K (input + a/2 |input|)        ('asymmetry error')

    None where the inputs do not tell the bias from the asymmetry.
    """
    largest = float(np.abs(applied).max())
    along = applied / largest
    design = np.column_stack([np.ones(len(along)), along, np.abs(along)]) / sigma[:, None]
    found = pseudo_inverse(design)
    if not found.determined.all():
        return None
    _bias, scale, half = found.inverse @ (read / sigma)
    return 2 * half / scale, 2 * float(np.linalg.norm(found.inverse[2])) / abs(scale)


def at_no_force(rate: Array, sigma: Array, force: Array) -> tuple[float, float] | None:
    """Rate that n readings at rest have in common, whatever they change with force; its sigma.

        reading = D + D_x f_x + D_y f_y + D_z f_z        ('acceleration-insensitive drift rate')

    `rate`, `sigma`: (n,), rad/s, the earth's rate taken out; `force`: (n, 3). None where the
    positions do not tell D from the other coefficients.
    """
    design = np.column_stack([np.ones(len(rate)), force]) / sigma[:, None]
    found = pseudo_inverse(design)
    if not found.determined[0]:
        return None
    weights = found.inverse[0]
    return float(weights @ (rate / sigma)), float(np.linalg.norm(weights))


@dataclass(frozen=True)
class Limits:
    """Between which a threshold or a resolution lies, with 95 % confidence for all inputs together.

    `lower`: the largest input that gave less than half of its output for certain; `upper`: the
    least that gave more; None where there is none.
    """

    lower: float | None
    upper: float | None


def threshold(applied: Array, read: Array, sigma: Array) -> Limits:
    """Limits of 'threshold': the least input that gives half of its output, (n,) each."""
    return _limits(np.abs(applied), np.sign(applied) * read, sigma)


def resolution(applied: Array, read: Array, sigma: Array, stated: Array | None = None) -> Limits:
    """Limits of 'resolution': the least change of input that gives half of its output.

    Between inputs on one side of zero, above the threshold, that are not far apart; as `threshold`.
    `stated`: the inputs that were set, (n,), where `applied` are means over time with other inputs
    in them. Two means that differ by how long those lasted are no change of the input.
    """
    stated = applied if stated is None else stated
    least = threshold(applied, read, sigma).upper
    if least is None:
        return Limits(None, None)
    i, j = np.triu_indices(len(applied), 1)
    above = (np.minimum(np.abs(applied[i]), np.abs(applied[j])) >= least) & (
        applied[i] * applied[j] > 0
    )
    above &= np.abs(applied[i] - applied[j]) <= MAX_CHANGE * np.abs(applied).max()
    above &= np.abs(stated[i] - stated[j]) > SAME * np.abs(stated[i])
    change = (applied[i] - applied[j])[above]
    output = np.sign(change) * (read[i] - read[j])[above]
    return _limits(np.abs(change), output, np.hypot(sigma[i], sigma[j])[above])


def least_by_counts(noise: float) -> float:
    """The least change that rounding to whole counts lets through at least by half, in counts.

    At the place between two counts where it is lost most; `noise`: of a reading before rounding,
    in counts. The mean of rounded readings is Σ Φ((x − j − ½)/σ) over the counts j (Widrow &
    Kollár 2008), so noise above 0.27 counts lets the mean of many feel any change: 0.
    """
    size = max(noise, 1e-3)
    counts = np.arange(-8, 12)[:, None, None] + 0.5
    place, change = np.arange(0, 1, 0.01)[:, None], np.arange(0.01, 2.01, 0.01)
    means = [ndtr((x - counts) / size).sum(axis=0) for x in (place + change, place)]
    lost = ((means[0] - means[1]) < SENSED_SHARE * change - 1e-9).any(axis=0)
    return float(change[lost].max(initial=0.0))


def _limits(inputs: Array, outputs: Array, sigma: Array) -> Limits:
    """Of n positive inputs the largest that was lost for certain, and the least that was not."""
    if not len(inputs):
        return Limits(None, None)
    beyond = float(norm_isf((1 - CONFIDENCE) / len(inputs))) * sigma
    excess = outputs - SENSED_SHARE * inputs
    lost, sensed = inputs[excess < -beyond], inputs[excess > beyond]
    return Limits(
        float(lost.max()) if len(lost) else None, float(sensed.min()) if len(sensed) else None
    )


def _largest(errors: Array, sigma: Array, largest: float) -> LargestError:
    worst = int(np.argmax(np.abs(errors)))

    def beyond(size: float) -> float:
        within = np.log1p(-2 * np.exp(log_ndtr(-size / sigma[sigma > 0])))
        return float(within.sum() - np.log(CONFIDENCE))

    most = float(sigma.max())
    by_noise = brentq(beyond, 1e-3 * most, 40 * most) if most else 0.0
    return LargestError(errors[worst] / largest, sigma[worst] / largest, by_noise / largest)
