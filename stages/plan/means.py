"""Rows that are means of many samples: what they can show, and how well each is known."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.campaign_units import CHANNEL_UNITS
from inertial.text.messages import _

Row = dict[str, Any]

MIN_MEANS = 15  # of a sensor: 12 parameters, and three degrees of freedom for their scatter
BY_RESIDUALS = 0.0  # the sigma where the residuals show it


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
        """Of one sample of a mean, or of the mean where the number of its samples is not known."""
        triad = layout.get(key)
        if triad is None or not are_means(layout):
            return None
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
    if not are_means(layout):
        for sensor in ("accelerometer", "gyro"):
            if "sigma" in layout.get(sensor, {}):
                raise file.refuse_text(
                    key,
                    _("sigma of {sensor}, whose rows are no means", sensor=sensor),
                    _("sigma with mean_of; the noise of samples is measured"),
                    _("remove sigma; or state mean_of, null where the number is not known"),
                )
        if item["do"] == "positions" and "seconds" not in item:
            raise file.refuse_text(
                key, _("no key 'seconds'"), _("seconds: the shortest rest, s"), _("add seconds")
            )
        return
    if item["do"] == "turn" and item.get("recorded") != "steady":
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
