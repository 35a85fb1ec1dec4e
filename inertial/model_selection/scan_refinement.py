"""Finer values of a scan where an effect was found: a second look, at the right value.

A scan whose steps suffice to find an effect leaves a trace of a strong one, whose true value
lies between two steps; that trace may be given a name of its own. So the evidence is built again
with finer values about those that were found, and the causes are named from it.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from inertial.model_selection.cause import Named
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.model_selection.scan import Candidates

Array = NDArray[np.float64]


def to_refine(
    evidence: Evidence, named: Named, effects: Sequence[SearchedEffect], sharp: float = 0.0
) -> dict[str, tuple[int, ...]]:
    """Which values of which scans: those of every member of a cause, beside the others and alone.

    Alone, because what a coarse scan leaves may have been given to others. `sharp`: the
    signal-to-noise ratio from which on a cause is worth it.
    """
    seen = evidence.seen()
    if not seen.sensors:
        return {}
    candidates = Candidates(effects)
    total = seen.total
    drops, _ = candidates.drops(total.information, total.right)
    found: dict[str, set[int]] = {}
    for cause in named.causes:
        if cause.snr < sharp:
            continue
        for member, value in zip(cause.members, cause.member_values, strict=True):
            found.setdefault(member, set()).add(value)
    refined = {}
    for number, one in enumerate(effects):
        if one.name in found and len(one.candidates) > 1 and one.between and not one.free:
            alone = int(np.argmax(drops[candidates.effect == number]))
            refined[one.name] = tuple(sorted(found[one.name] | {alone}))
    return refined


def finer(values: Array, chosen: Sequence[int], steps: int) -> Array:
    """The values of a scan with so many steps in each interval beside those chosen, sorted."""
    beside = {i for place in chosen for i in (place - 1, place) if 0 <= i < len(values) - 1}
    near = [np.linspace(values[i], values[i + 1], steps + 1)[1:-1] for i in sorted(beside)]
    return np.sort(np.concatenate([values, *near]))
