"""The sample rate, which stands in one place: in the instrument, or in the time of a format."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.messages import _

SAMPLE_RATE = "rate_hz"


@dataclass(frozen=True)
class StatedRate:
    """What the instrument states, Hz, if it does, and where: file, line and key."""

    value: float | None
    place: str

    @classmethod
    def of(cls, file: YamlFile, instruments: Path) -> "StatedRate":
        """Of the instrument of a campaign, written out in it or one of the listed."""
        key, stated = "instrument", file.content["instrument"]
        if isinstance(stated, str):
            file, key = YamlFile(instruments), stated
            stated = file.content[stated]
        place = f"{file.path.name}, {file.place([key, SAMPLE_RATE])}"
        return cls(stated.get(SAMPLE_RATE), place)


def with_rate(
    file: YamlFile, key: Key, layout: dict[str, Any], instrument: StatedRate
) -> dict[str, Any]:
    """The layout with the rate by which rows or samples are counted, where they are.

    Raises
    ------
    Refusal
        where two rates are stated that differ, or none and there is no time
    """
    time = layout.get("time")
    stated = (time or {}).get(SAMPLE_RATE)
    if stated is not None and instrument.value not in (None, stated):
        raise file.refuse(
            [*key, "time", SAMPLE_RATE],
            stated,
            _(
                "{rate:g}, the rate of the instrument by {place}",
                rate=instrument.value,
                place=instrument.place,
            ),
            _("state the rate once: remove the one of the two that is wrong"),
        )
    rate = instrument.value if stated is None else stated
    if time is None and "mean_of" not in layout:
        if rate is None:
            raise file.refuse_text(
                key,
                _("neither time nor a rate"),
                _("time of the rows, or the number of rows in a second"),
                _(
                    "add time: {example}, or rate_hz to the instrument",
                    example="{column: …, unit: s}",
                ),
            )
        return layout | {"time": {SAMPLE_RATE: rate}}
    if time and rate and (time.get("column") is None or time.get("unit") == "sample"):
        return layout | {"time": {**time, SAMPLE_RATE: rate}}
    return layout
