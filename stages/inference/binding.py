"""Whether an oscillation is bound to time or to the table's angle.

In time it has in each turn a phase of its own, for nothing ties one turn to the next; frequency and
amplitude are the same in all turns, or not. Against the angle it has an order and one a and b for
all turns. Each is scored by half the drop of chi-squared, less what its free parameters and its
search cost. At a signal-to-noise ratio R a phase takes up 1/(√(2π) R) of its room, an amplitude
that was known to be no larger than twice what is found √(2π)/(2 R), a frequency that was known to a
bin about 1/R; a search over m values costs ln m. The difference of two scores is the natural
logarithm of the odds.
"""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TELLS = 3.0  # natural logarithm of odds of 20 to 1, from which one of two is named alone


def in_time(own: Array, amplitudes: Array, drops: Array, searched: float) -> float:
    """Score of an oscillation bound to time; in a turn that is better without it, it is not.

    own : (k,), drops of chi-squared with a frequency, an amplitude and a phase of each turn's own
    amplitudes, drops : (k,), in each turn and by it, at one frequency for all
    searched : how many frequencies and axes were tried
    """
    room = _phase(own) + _amplitude(own)
    each = np.maximum(own / 2 - room - _frequency(own), 0.0)
    there = each > 0
    if not there.any():
        return float(-np.log(searched))
    # One of the frequencies is that of the search.
    apart = float(each.sum() + _frequency(own[there]).max())
    weight = drops[there] / amplitudes[there] ** 2
    off = amplitudes[there] - np.average(amplitudes[there], weights=weight)
    same = (drops[there] - weight * off**2) / 2 - _phase(drops[there])
    together = float(same.sum() - _amplitude(drops[there].sum()))
    return max(apart, together) - float(np.log(searched))


def in_angle(drop: float, searched: float) -> float:
    """Score of an oscillation bound to the angle, by the drop of chi-squared in all turns."""
    room = _phase(np.asarray(drop)) + _amplitude(np.asarray(drop))
    return float(drop / 2 - room - np.log(searched))


def _phase(drop: Array) -> Array:
    """ln of prior over posterior room of a phase; R² is the drop."""
    return np.asarray(np.log(np.maximum(np.sqrt(2 * np.pi * drop), 1.0)))


def _amplitude(drop: Array) -> Array:
    """The same of an amplitude."""
    return np.asarray(np.log(np.maximum(2 * np.sqrt(drop / (2 * np.pi)), 1.0)))


def _frequency(drop: Array) -> Array:
    """The same of a frequency: sigma is √6/(π R T), Rife & Boorstyn (1974)."""
    return np.asarray(np.log(np.maximum(np.sqrt(drop), 1.0)))
