"""The sample rate that a campaign states, and logs whose records are means."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from inertial.campaign.records import Row
from inertial.formats.columns.column_layout import has_stamps
from inertial.sensors import FILE_KEYS
from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.messages import _
from inertial.text.units import CHANNEL_UNITS

SAMPLE_RATE = "rate_hz"


@dataclass(frozen=True)
class StatedRate:
    """What the instrument states, Hz, if it does, and where: file, line and key."""

    value: float | None
    place: str

    @classmethod
    def of(cls, file: YamlFile, listed: YamlFile) -> "StatedRate":
        """Of the instrument of a campaign, written out in it or one of the listed."""
        key, stated = "instrument", file.content["instrument"]
        if isinstance(stated, str):
            file, key = listed, stated
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
    if time and rate and (not has_stamps(time) or time.get("unit") == "sample"):
        return layout | {"time": {**time, SAMPLE_RATE: rate}}
    return layout


MIN_MEANS = 15  # of a sensor: 12 parameters, and three degrees of freedom for their scatter
IN_LOG = BY_RESIDUALS = 0.0  # the sigma where the log or the residuals show it


def each(stated: float | list[float]) -> list[float]:
    """One number for each column."""
    return stated if isinstance(stated, list) else [stated] * 3


def are_means(layout: Mapping[str, Any]) -> bool:
    """Whether the rows of a log are means without a time."""
    return "mean_of" in layout and "time" not in layout


class MeanSigmas:
    """How well each mean of a sensor is known: as stated, by the data sheet, or by residuals.

    `rate`: Hz, of the samples.
    """

    def __init__(self, manoeuvres: Sequence[Row], sensors: Sequence[Row], rate: float | None):
        self._layouts = [row["layout"] for row in manoeuvres]
        self._sheet = {row["sensor"]: row["white_noise"] for row in sensors}
        self._rate = rate

    def of(self, layout: Mapping[str, Any], sensor: str, key: str, place: int) -> float | None:
        """Of one sample of a mean, or of the mean where the number of its samples is not known.

        0 where it is not one for all means.
        """
        triad = layout.get(key)
        if triad is None or not are_means(layout):
            return None
        if "sigma_columns" in triad:
            return IN_LOG
        if "sigma" in triad:
            return float(each(triad["sigma"])[place] * CHANNEL_UNITS[triad["unit"]])
        if layout["mean_of"] is not None and self._rate and self._sheet[sensor]:
            return float(self._sheet[sensor] * self._rate**0.5)
        alike = [one for one in self._layouts if are_means(one) and key in one]
        return BY_RESIDUALS if len(alike) >= MIN_MEANS else None


def one_by_one(manoeuvre: Row) -> Iterator[Row]:
    """A manoeuvre as it is; positions that are rows of means as a static position for each row."""
    if manoeuvre["do"] != "positions" or not are_means(manoeuvre["layout"]):
        yield manoeuvre
        return
    first, after = manoeuvre["from_row"], manoeuvre["to_row"]
    digits = len(str(after - 1))
    for row in range(first, after):
        name = f"{manoeuvre['manoeuvre']}-{row:0{digits}d}"
        own = {"manoeuvre": name, "position": name, "do": "rest", "seconds": None}
        yield manoeuvre | own | {"from_row": row, "to_row": row + 1}


def refuse_without_time(
    file: YamlFile, key: Key, item: Mapping[str, Any], layout: Mapping[str, Any]
) -> None:
    """Refuse what rows without time cannot show, and a sigma of rows that are no means."""
    for sensor in FILE_KEYS.values():
        triad = layout.get(sensor, {})
        stated = [name for name in ("sigma", "sigma_columns") if name in triad]
        if stated and not are_means(layout):
            raise file.refuse_text(
                key,
                _("{sigma} of {sensor}, whose rows are no means", sigma=stated[0], sensor=sensor),
                _("{sigma} with mean_of; the noise of samples is measured", sigma=stated[0]),
                _(
                    "remove {sigma}; or state mean_of, null where the number is not known",
                    sigma=stated[0],
                ),
            )
        if len(stated) > 1:
            raise file.refuse_text(
                key,
                _("both sigma and sigma_columns of {sensor}", sensor=sensor),
                _("one for all means, or a column with that of each"),
                _("remove one of the two"),
            )
        pairs = zip(triad.get("sigma_columns", ()), triad.get("columns", ()), strict=False)
        if any(sigma is None and mean is not None for sigma, mean in pairs):
            raise file.refuse_text(
                key,
                _("null in sigma_columns of {sensor}, whose means are recorded", sensor=sensor),
                _("a column with the standard deviation of each mean"),
                _("name the column, or remove sigma_columns"),
            )
    if not are_means(layout):
        if item["do"] == "positions" and "seconds" not in item:
            raise file.refuse_text(
                key, _("no key 'seconds'"), _("seconds: the shortest rest, s"), _("add seconds")
            )
        return
    if item["do"] in ("turn", "modulate") and item.get("recorded") != "steady":
        raise file.refuse_text(
            key,
            _("a whole turn in rows that are means"),
            _("recorded: steady, a mean at a known rate"),
            _("add recorded: steady and the signed rate_deg_s"),
        )
    if item["do"] == "positions" and "rows" not in item:
        raise file.refuse_text(
            key,
            _("positions without rows, where each row is the mean of one"),
            _("rows: [first, number of the last + 1]"),
            _("add rows, which count from 0"),
        )
