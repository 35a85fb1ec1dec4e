"""Which sensors have a result with effects in its model."""

from collections.abc import Container, Iterable

from inertial.campaign.records import Row
from inertial.text.parameters import JOINT


def extended_sensors(verdicts: Iterable[Row]) -> set[tuple[str, str]]:
    """Sensor and mount of every result that is final and has effects in its model.

    `verdicts`: the rows of the diagnosis.
    """
    return {(row["sensor"], row["mount"]) for row in verdicts if row["method"] != JOINT}


def of_sensors(rows: Iterable[Row], sensors: Container[tuple[str, str]]) -> list[Row]:
    """The rows of these sensors and mounts."""
    return [row for row in rows if (row["sensor"], row["mount"]) in sensors]
