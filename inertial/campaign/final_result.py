"""The final result of a sensor, the joint or the extended one, and how their rows correspond."""

from collections.abc import Container, Iterable, Sequence

from inertial.campaign.records import Row
from inertial.text.parameters import EXTENDED, JOINT


def extended_sensors(verdicts: Iterable[Row]) -> set[tuple[str, str]]:
    """Sensor and mount of every result that is final and has effects in its model.

    `verdicts`: the rows of the diagnosis.
    """
    return {(row["sensor"], row["mount"]) for row in verdicts if row["method"] != JOINT}


def of_sensors(rows: Iterable[Row], sensors: Container[tuple[str, str]]) -> list[Row]:
    """The rows of these sensors and mounts."""
    return [row for row in rows if (row["sensor"], row["mount"]) in sensors]


def with_extended(parameters: Sequence[Row], extended: Iterable[Row]) -> list[Row]:
    """The rows, those of the joint method with value and sigma of the extended fit where it has.

    `extended`: of all methods of the extension. The ids stay.
    """
    better = {
        _key(row): row for row in extended if row["method"] == EXTENDED and row["value"] is not None
    }
    return [
        row | {key: better[_key(row)][key] for key in ("value", "sigma")}
        if row["method"] == JOINT and _key(row) in better
        else row
        for row in parameters
    ]


def _key(row: Row) -> tuple[str, str, str]:
    return row["mount"], row["sensor"], row["parameter"]
