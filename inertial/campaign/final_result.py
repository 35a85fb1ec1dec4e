"""The final result of a sensor, the joint or the extended one, and how their rows correspond."""

from collections.abc import Iterable, Sequence

from inertial.campaign.records import Row, with_mount

STAGES = {"gyro": "gyroscope", "accel": "accelerometer"}
EXTENDED = "extended"


def extended_methods(decision: Iterable[Row]) -> set[str]:
    """The methods of the extension whose result is final.

    `decision`: the rows of the extension's table.
    """
    return {
        with_mount(STAGES[row["sensor"]], row["mount"])
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
