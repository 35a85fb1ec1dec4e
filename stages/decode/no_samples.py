"""Why a log gives no sample at all: what stands in it instead, and the cure."""

import json
import re
from collections.abc import Mapping
from typing import Any

from inertial.formats.account import (
    BLANK,
    HEADER,
    NOT_SELECTED,
    OTHER_MESSAGE,
    REFUSED,
    Account,
    RefusedLine,
)
from inertial.sensors import FILE_KEYS
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import counted, shortened

MIN_FIELDS = 3  # of a row, the last not counted
_NUMBER = {
    decimal: re.compile(rf" *[+-]?\d+(?:[{decimal}]\d*)?(?:[eE][+-]?\d+)? *") for decimal in ".,"
}
MAX_NAMES = 8  # of messages that are listed
# Source: NovAtel OEM7 Commands and Logs Reference Manual.
_NAMES = {
    **{"binary 42": "BESTPOS", "binary 507": "INSPVA", "binary 508": "INSPVAS"},
    **{"binary 812": "CORRIMUDATA", "binary 813": "CORRIMUDATAS", "binary 1465": "INSPVAX"},
    **{"binary 1362": "IMURATECORRIMUS", "binary 1945": "INSCONFIG", "binary 2051": "INSSTDEV"},
    "binary 2264": "CORRIMUS",
}


def no_samples(
    file: str, layout: Mapping[str, Any], account: Account, first: RefusedLine | None
) -> Refusal:
    """The refusal of a log without samples; `first`: the first of its lines that was refused."""
    count = dict.fromkeys((REFUSED, OTHER_MESSAGE, NOT_SELECTED, HEADER, BLANK), 0)
    names: dict[str, int] = {}
    for kind, name, lines, _size in account:
        count[kind] = count.get(kind, 0) + lines
        if kind == OTHER_MESSAGE:
            names[_NAMES.get(name, name)] = lines
    receiver = layout["kind"] == "rawimus"
    if receiver and names:
        return Refusal(
            file,
            "",
            _("no raw data of an IMU, but {messages}", messages=_listed(names)),
            "RAWIMU, RAWIMUS, RAWIMUX, RAWIMUSX",
            _(
                "record anew with LOG RAWIMUSXB ONNEW (RAWIMUSB on an older receiver); what the "
                "receiver has corrected, such as CORRIMU and INSPVA, cannot be calibrated"
            ),
        )
    if "message" in layout and names:
        return Refusal(
            file,
            "",
            _("no ${name}, but {messages}", name=layout["message"], messages=_listed(names)),
            f"${layout['message']}",
            _(
                "record anew with $VNWRG,06,19*XX; what the sensor has compensated, such as "
                "VNYMR, cannot be calibrated"
            ),
        )
    if first is not None:
        return _all_refused(file, layout, count[REFUSED], first)
    if names or count[NOT_SELECTED]:
        stated = {key: layout.get(key, {}).get("rows") for key in FILE_KEYS.values()}
        rows = {key: rows for key, rows in stated.items() if rows}
        return Refusal(
            file,
            "",
            _("none of its {rows} holds a sensor", rows=counted(count[NOT_SELECTED], "row")),
            _("rows with {values}", values=json.dumps(rows, ensure_ascii=False)),
            _("correct the key rows of its format"),
        )
    return Refusal(
        file,
        "",
        _("no row of data behind {count} of header", count=counted(header, "line"))
        if (header := count[HEADER] + count[BLANK])
        else _("no row of data"),
        _("a row for each sample"),
        _("correct header_lines of its format, or copy the log anew from where it was recorded"),
    )


def _all_refused(file: str, layout: Mapping[str, Any], count: int, first: RefusedLine) -> Refusal:
    """Not one line fits the format; the first one shows why."""
    text = f" ('{first.text}')" if first.text else ""
    if layout["kind"] == "rawimus":
        expected = _("messages of a NovAtel receiver, as the format of the instrument says")
        cure = _("name the right log, or give its manoeuvres a format of kind columns")
    else:
        expected = _("rows as its format says: {format}", format=_described(layout))
        cure = _("compare this line with the format in campaign.yaml, and correct the format")
        if seems := _seems(first.text, layout):
            cure = _("state {keys} in the format, for so the line is written", keys=seems)
    return Refusal(
        file,
        _("line {line}", line=first.line),
        _(
            "all {count} are refused, this one because: {reason}{text}",
            reason=first.reason,
            text=text,
            count=counted(count, "line"),
        ),
        expected,
        cure,
    )


def _seems(line: str, layout: Mapping[str, Any]) -> str:
    """What the format should say of delimiter and decimal, for it makes numbers of all fields."""
    for delimiter, decimal in ((";", ","), (";", "."), (None, ","), (",", ".")):
        fields = line.split(delimiter)[:-1]  # the last may be cut short
        if len(fields) >= MIN_FIELDS and all(_NUMBER[decimal].fullmatch(one) for one in fields):
            seems = {"delimiter": delimiter, "decimal": decimal}
            stated = {"delimiter": layout.get("delimiter"), "decimal": layout.get("decimal", ".")}
            other = {key: value for key, value in seems.items() if value != stated[key]}
            return ", ".join(
                f'{key}: "{mark}"' if mark else _("no {key}", key=key)
                for key, mark in other.items()
            )
    return ""


def _described(layout: Mapping[str, Any]) -> str:
    """The keys of a format that say how a line is read."""
    keys = (
        "delimiter",
        "decimal",
        "header_lines",
        "comment",
        "labelled",
        "message",
        "time",
        *FILE_KEYS.values(),
    )
    stated = {key: layout[key] for key in keys if key in layout}
    for sensor in FILE_KEYS.values():
        if sensor in stated:
            stated[sensor] = stated[sensor]["columns"]
    return shortened(", ".join(f"{key} {_plain(value)}" for key, value in stated.items()), 300)


def _plain(value: object) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if isinstance(value, str) else text.replace('"', "")


def _listed(names: Mapping[str, int]) -> str:
    often = sorted(names.items(), key=lambda item: -item[1])
    listed = [f"{count} {name}" for name, count in often[:MAX_NAMES]]
    if others := sum(count for _name, count in often[MAX_NAMES:]):
        listed.append(_("{others} others", others=others))
    return ", ".join(listed)
