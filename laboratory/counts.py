"""Increments of an IMU as whole counts; what one leaves over is in the next, or is lost."""

import numpy as np

from laboratory.arrays import Array, Counts


def count(running: Array, size: float | Array) -> Counts:
    """counts_k = round(S_k / q) − round(S_{k−1} / q),  S₀ = 0.

    running: the running integral S₁ … S_n of the reading, (n, …), rad or m/s; size: one count q,
    same unit. The sum of any segment of counts is off by one count at most, however long it is.
    """
    whole = np.rint(running / size).astype(np.int64)
    return np.diff(whole, axis=0, prepend=np.zeros((1, *whole.shape[1:]), dtype=np.int64))


def rounded(running: Array, size: float | Array) -> Counts:
    """counts_k = round((S_k − S_{k−1}) / q): each reading by itself, as a converter has it."""
    increments = np.diff(running, axis=0, prepend=np.zeros((1, *running.shape[1:])))
    return np.rint(increments / size).astype(np.int64)
