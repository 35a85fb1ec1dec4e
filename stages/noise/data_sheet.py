"""White noise at rest that is far above the data sheet's: the IMU is another one, or is shaken."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from inertial.campaign.findings import Finding
from inertial.campaign.records import Row
from inertial.sensors import PLURAL
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import quantity

CAUSE = "noise_above_data_sheet"
MAX_RATIO = 3.0  # to the data sheet: types differ by less from one to the next, and with the range


def louder(terms: Sequence[Row]) -> Iterator[Finding]:
    """A finding for each sensor of which channels are; `terms`: rows of the terms of the noise."""
    above = [
        row
        for row in terms
        if row["term"] == "white_noise"
        and row["value"]
        and row["data_sheet"]
        and row["value"] > MAX_RATIO * row["data_sheet"]
    ]
    for sensor, rows in groupby(above, lambda row: row["channel"].partition("_")[0]):
        own = list(rows)
        most = max(own, key=lambda row: row["value"] / row["data_sheet"])
        ratio = most["value"] / most["data_sheet"]
        unit = quantity("white_noise", most["unit"]).laboratory
        yield Finding(
            id=f"noise/{CAUSE}/{sensor}",
            cause=CAUSE,
            sensor=sensor,
            size=ratio,
            severity=1,
            sentence=_(
                "At rest the {sensors} {axes} have up to {ratio} times the white noise of the data "
                "sheet: {axis} {value} {unit} in place of {stated}.",
                sensors=PLURAL[sensor],
                axes=", ".join(row["channel"][-1] for row in own),
                ratio=significant(ratio, 3),
                axis=most["channel"][-1],
                value=significant(unit.of(most["value"]), 3),
                stated=significant(unit.of(most["data_sheet"]), 3),
                unit=unit.name,
            ),
            consequence=_(
                "The sigmas stand, for they are by the noise that is measured; they are larger "
                "than those that the instrument could have."
            ),
            action=_(
                "See whether it is the instrument, and the range, of the data sheet; look for what "
                "shakes the table, and for a supply or a connector that is not right."
            ),
        )
