"""Where the mean of a series changes, and stays changed for a while."""

from itertools import pairwise

import numpy as np
from scipy.special import ndtri

from inertial.arrays import Array
from inertial.signal.scatter import in_blocks

MIN_CHANGE_SIGMA = 5.0  # sigma: 6·10⁻⁷ for one place, and errors of stamps cancel, so in truth less
MAX_BORDERS = 4  # of the largest differences of blocks, which may be borders


def changes(series: Array, length: int, shortest: int, least: float, finest: float) -> list[int]:
    """The borders of the parts of a series, (n,), that have each a mean of its own: 0, …, n.

    Binary segmentation by the likelihood ratio of a step in white noise, over means of blocks,
    for the errors of stamps cancel within a block; then to the value. Scott & Knott, Biometrics
    30 (1974), 507.

    Parameters
    ----------
    length : values of a block
    shortest : blocks that a part has at least
    least : means that differ by less are the same
    finest : sigma of the mean of a block is at least this
    """
    blocks = in_blocks(series, length).mean(axis=1)
    if len(blocks) < 2 * shortest:
        return [0, len(series)]
    sigma = max(_scatter(blocks), finest)
    borders = [0, len(series)]
    waiting = [(0, len(series))]
    while waiting:
        start, end = waiting.pop()
        step = _step(in_blocks(series[start:end], length).mean(axis=1), shortest, sigma)
        if step:
            border = start + _to_the_value(series[start:end], step * length, length)
            borders.append(border)
            waiting += [(start, border), (border, end)]
    return _told_apart(series, sorted(borders), least, sigma * np.sqrt(length))


def _scatter(blocks: Array) -> float:
    """The sigma of a block, from differences of neighbours without the largest."""
    squares = np.sort(np.diff(blocks) ** 2)
    kept = max(len(squares) - MAX_BORDERS, 1)
    # What is left of the variance of Gaussian values without those beyond the bound.
    share = kept / len(squares)
    bound = float(ndtri((1 + share) / 2))
    left = (
        1 - 2 * bound * np.exp(-(bound**2) / 2) / np.sqrt(2 * np.pi) / share if share < 1 else 1.0
    )
    return float(np.sqrt(squares[:kept].mean() / 2 / left))


def _step(blocks: Array, shortest: int, sigma: float) -> int:
    """Before which block the mean most likely changes; 0 if nowhere."""
    n = len(blocks)
    if n < 2 * shortest:
        return 0
    k = np.arange(shortest, n - shortest + 1)
    away = np.cumsum(blocks - blocks.mean())[k - 1]
    likely = np.abs(away) / np.sqrt(k * (n - k) / n)
    best = int(np.argmax(likely))
    return int(k[best]) if likely[best] > MIN_CHANGE_SIGMA * sigma else 0


def _to_the_value(series: Array, border: int, length: int) -> int:
    """The border of two means, within two blocks of `border`, with the least squares left over."""
    before, after = series[: border - length].mean(), series[border + length :].mean()
    start, end = max(border - 2 * length, 0), min(border + 2 * length, len(series))
    near = series[start:end]
    squares = np.cumsum((near - before) ** 2 - (near - after) ** 2)
    return start + 1 + int(np.argmin(squares[:-1]))


def _told_apart(series: Array, borders: list[int], least: float, sigma: float) -> list[int]:
    """The borders without those on both sides of which the mean is the same.

    That is within `least`, or within what values that scatter by `sigma` are sure of.
    """
    while len(borders) > 2:
        means = [float(series[a:b].mean()) for a, b in pairwise(borders)]
        unsure = (
            MIN_CHANGE_SIGMA * sigma * np.sqrt(1 / np.diff(borders)[1:] + 1 / np.diff(borders)[:-1])
        )
        apart = np.abs(np.diff(means)) / np.maximum(unsure, least)
        nearest = int(np.argmin(apart))
        if apart[nearest] >= 1:
            break
        borders = borders[: nearest + 1] + borders[nearest + 2 :]
    return borders
