"""How far the effects move each of the 24 parameters."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from stages.extending.solved import Solved

Row = dict[str, Any]


def moved(solution: Solved, joint: Sequence[Row], scatter: bool) -> Iterator[Row]:
    """Each parameter by the joint and by the extended fit.

    Nested fits of the same data differ by a variance σ²(extended) − σ²(joint) (Hausman 1978), if
    both allow for the same noise; `scatter`: the joint one has held the effect as a scatter of the
    manoeuvres, and then they do not.
    """
    before = {row["parameter"]: row for row in joint}
    for row in solution.of_sensor:
        name = row["parameter"]
        old = before.get(name, {"value": None, "sigma": None, "id": ""})
        both = row["value"] is not None and old["value"] is not None
        difference = row["value"] - old["value"] if both else None
        added = row["sigma"] ** 2 - old["sigma"] ** 2 if both and not scatter else 0.0
        yield {
            "id": row["id"],
            "joint_id": old["id"],
            "parameter": name,
            "unit": row["unit"],
            "joint": old["value"],
            "joint_sigma": old["sigma"],
            "extended": row["value"],
            "extended_sigma": row["sigma"],
            "difference": difference,
            "difference_sigma": float(np.sqrt(added)) if added > 0 else None,
            "in_sigmas": difference / old["sigma"] if both and old["sigma"] else None,
        }
