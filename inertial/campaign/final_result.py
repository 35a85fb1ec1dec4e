"""Which result of a sensor counts, the joint one or the extended one, and how their rows belong."""

from collections.abc import Iterable, Sequence
from typing import Any

Row = dict[str, Any]

STAGES = {"gyro": "gyroscope", "accel": "accelerometer"}
EXTENDED = "extended"


def extended_methods(decision: Iterable[Row]) -> set[str]:
    """The methods of the extension that count: stage, with @ and the mount where there are several.

    `decision`: the rows of the extension's table.
    """
    return {
        STAGES[row["sensor"]] + (f"@{row['mount']}" if row["mount"] else "")
        for row in decision
        if row["result"] == EXTENDED
    }


def extended_id(joint: str) -> str:
    """What the extension calls the parameter that the joint fit calls `joint`.

    gyroscope/joint@upright/bias_x is extension/gyroscope@upright/bias_x.
    """
    stage, _, rest = joint.partition("/")
    method, _, parameter = rest.rpartition("/")
    return f"extension/{stage}{method.removeprefix('joint')}/{parameter}"


def counting(parameters: Sequence[Row], extended: Iterable[Row]) -> list[Row]:
    """The rows, with value and sigma of the extended fit where it has them; the ids stay."""
    better = {row["id"]: row for row in extended if row["value"] is not None}
    return [
        row | {key: better[other][key] for key in ("value", "sigma")}
        if (other := extended_id(row["id"])) in better
        else row
        for row in parameters
    ]
