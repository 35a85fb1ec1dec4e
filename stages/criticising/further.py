"""Manoeuvres that a laboratory might add: copies of what it did, to foresee what they would tell.

Only their information counts, which depends on attitude, rate and noise; the readings are those
of the originals and mean nothing.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np
import pandas as pd

from stages.contracts.records import Manoeuvre, Performed
from stages.contracts.tables import GYRO

PAUSE = 60.0  # s, before a manoeuvre that is added
TURNED_OVER = "turn also at the same rate with the axis down"
FASTER = "turn also at twice the rate"
BETWEEN_AXES = "rest also with two axes at 45° to the vertical"
ONCE_MORE = "do the rests once more, in the reverse order"


@dataclass(frozen=True)
class Further:
    """A campaign with some manoeuvres more: its plan, what was performed, and its blocks."""

    plan: list[Manoeuvre]
    performed: dict[str, Performed]
    blocks: pd.DataFrame


def further(
    plan: Sequence[Manoeuvre], performed: Mapping[str, Performed], blocks: pd.DataFrame
) -> dict[str, Callable[[], Further]]:
    """What might be added to a campaign, by its name; made when it is asked for."""
    rows = blocks.groupby("manoeuvre").indices
    complete = [m for m in plan if performed[m.name].complete]
    whole = [m for m in complete if m.up is not None and m.name in rows]
    turns = [m for m in whole if m.do == "turn" and m.recorded == "whole" and m.rate is not None]
    rests = [m for m in whole if m.do == "rest"]

    def added(pairs: Sequence[tuple[Manoeuvre, Manoeuvre, float]]) -> Further:
        done, times, start = dict(performed), [], float(blocks["time"].max())
        for original, copy, faster in pairs:
            own = blocks["time"].to_numpy()[rows[original.name]]
            times.append(start + PAUSE + (own - np.fmin.reduce(own)) / faster)
            start = float(np.fmax.reduce(times[-1]))
            done[copy.name] = replace(performed[original.name], manoeuvre=copy.name)
        parts = [rows[original.name] for original, _, _ in pairs]
        each = np.repeat(np.arange(len(pairs)), [len(part) for part in parts])
        more = blocks.iloc[np.concatenate(parts)].copy()
        more["manoeuvre"] = np.array([copy.name for _, copy, _ in pairs])[each]
        more["time"] = np.concatenate(times)
        factor = np.array([faster for _, _, faster in pairs])[each]
        more["seconds"] /= factor
        more["count"] /= factor
        moving = ~more["phase"].str.startswith("rest").to_numpy(bool)
        more[GYRO] *= np.where(moving, factor, 1.0)[:, None]
        manoeuvres = [*plan, *(copy for _, copy, _ in pairs)]
        return Further(manoeuvres, done, pd.concat([blocks, more], ignore_index=True))

    found: dict[str, Callable[[], Further]] = {}
    if turns:
        found[TURNED_OVER] = partial(added, [(m, _turned_over(m), 1.0) for m in turns])
        found[FASTER] = partial(added, [(m, _named(m, "faster"), 2.0) for m in turns])
    if rests:
        like = rests[0]
        ups = [
            (np.eye(3)[i] + sign * np.eye(3)[j]) / np.sqrt(2)
            for i, j in combinations(range(3), 2)
            for sign in (1, -1)
        ]
        diagonal = [
            replace(_named(like, f"at 45° {number}"), up=up, mark=None)
            for number, up in enumerate(ups, 1)
        ]
        found[BETWEEN_AXES] = partial(added, [(like, copy, 1.0) for copy in diagonal])
        again = [(m, _named(m, "once more"), 1.0) for m in reversed(rests)]
        found[ONCE_MORE] = partial(added, again)
    return found


def _named(m: Manoeuvre, what: str) -> Manoeuvre:
    """A copy at a position of its own."""
    return replace(m, name=f"{m.name} {what}", position=f"{m.position} {what}")


def _turned_over(m: Manoeuvre) -> Manoeuvre:
    assert m.up is not None  # else it is not chosen
    return replace(_named(m, "turned over"), up=-m.up)
