"""Whether static positions of unknown attitude determine every parameter of the accelerometers."""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from commands.draft.manoeuvres import Manoeuvre
from commands.draft.questions import GRAVITY, GRAVITY_SIGMA
from commands.draft.sensors import Kind
from commands.draft.series import Divided
from inertial.arrays import Array
from inertial.campaign.unknown_attitude import in_words
from inertial.estimation.length_outliers import off_lengths
from inertial.estimation.multi_position import (
    SCATTER_RANGE,
    FreeRest,
    free_positions,
    unobservable,
)
from inertial.estimation.scatter_and_random_walk import with_scatter

MIN_SIGMA = 1e-3  # m/s², of a mean: what its samples, or a row of means, do not show
MIN_BINS = 3  # short means of a rest, to show its noise


def not_determined(kinds: Sequence[Kind], plan: Sequence[Manoeuvre]) -> list[str]:
    """What the positions of the plan leave open, each with the rest that would determine it.

    By the fit of the pipeline, |f| = g with a scatter between the positions, on the means that the
    draft has; noise is that of the short means of each rest.
    """
    parts = {id(m.part) for m in plan if m.do == "positions"}
    every = [
        each
        for kind in kinds
        for part, own in zip(kind.parts, kind.divided, strict=True)
        if id(part) in parts
        for each in _rests(own)
    ]
    means, sigma = (np.array(values) for values in zip(*every, strict=True))
    off = {each.number for each in off_lengths(means, sigma, GRAVITY)}
    rests = [FreeRest("", *each) for i, each in enumerate(every) if i not in off]
    fit = partial(free_positions, rests, GRAVITY, GRAVITY_SIGMA)
    found = with_scatter(fit, between=SCATTER_RANGE, noise_degrees=np.inf).estimate
    return list(dict.fromkeys(map(in_words, unobservable(found))))


def _rests(own: Divided) -> Iterator[tuple[Array, Array]]:
    """The mean of each rest, m/s², and its sigma, (3,) each."""
    for rest in own.rests:
        first, after = own.inside(rest)
        noise = np.zeros(3)
        if after - first >= MIN_BINS:
            noise = own.forces[first:after].std(axis=0, ddof=1) / np.sqrt(after - first)
        yield rest.accel, np.maximum(noise, MIN_SIGMA)
