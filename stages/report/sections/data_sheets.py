"""The data sheets with which the noise is compared."""

from collections.abc import Sequence

from inertial.text.enumeration import listed
from inertial.text.messages import _
from inertial.text.numbers import shortened
from stages.report.tables import Record
from stages.report.words import SENSORS, capital

DATA_SHEET = _("data sheet")


def of_data_sheets(sheet: Sequence[Record]) -> str:
    """Whence the data sheet of each sensor is; nothing without one."""
    sensors: dict[str, list[str]] = {}
    for row in sheet:
        if row["source"] and SENSORS[row["sensor"]] not in sensors.setdefault(row["source"], []):
            sensors[row["source"]].append(SENSORS[row["sensor"]])
    each = (
        _("{sensors}: {source}.", sensors=capital(listed(names)), source=shortened(source, 300))
        for source, names in sensors.items()
    )
    return _("Data sheet. {each}", each=" ".join(each)) if sensors else ""
