"""A decoded piece of a log, and the clock of a log by its first pieces."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.formats.account import Account, RefusedLine

LOOK_AHEAD = 1000  # samples, where there are as many, of which the interval is the median

Reals = NDArray[np.float64]


@dataclass(frozen=True)
class Decoded:
    """What a piece of a log gives: n samples, the lines that were refused, and the account."""

    samples: dict[str, Any]  # columns of the table samples by name, (n,) each, SI
    refused: list[RefusedLine]
    account: Account
    imu_types: frozenset[int] = frozenset()  # in the messages, by NovAtel's list


def look_ahead(
    times: Iterable[NDArray[np.int64] | Reals],
) -> tuple[float | None, float | None, float | None]:
    """The first time of a log, and the time from sample to sample, by its first pieces.

    That is the median, and the mean of those steps that are no gaps: stamps of a
    millisecond make the median jump, not the mean.
    """
    times_so_far: list[NDArray[Any]] = []
    for some in times:
        times_so_far.append(some)
        if sum(len(part) for part in times_so_far) > LOOK_AHEAD:
            break
    together = np.concatenate(times_so_far) if times_so_far else np.array([])
    steps = np.diff(together)
    forward = steps[steps > 0]
    if not len(forward):
        return (together[0].item() if len(together) else None, None, None)
    median = float(np.median(forward))
    return together[0].item(), median, float(np.mean(forward[forward < 1.5 * median]))
