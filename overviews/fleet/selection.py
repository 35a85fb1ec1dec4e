"""Which campaigns a fleet is of: by serial number, type of IMU or table, or by their names.

A selection is kept as data/fleets/<name>.txt, from which the workflow makes the page.
"""

import re
import shlex
from collections.abc import Mapping, Sequence
from pathlib import Path

from inertial import tables
from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole
from inertial.text.messages import _
from inertial.text.numbers import shortened
from overviews.fleet.declared import READ

FLEETS = Path("data/fleets")
KEYS = ("serial", "instrument", "table")
EVERY = "all"
MAX_NAME = 60  # characters


def parts(text: str) -> tuple[Mapping[str, str], Sequence[str]]:
    """The conditions and the names of a selection.

    Raises
    ------
    Refusal
        where it is none
    """
    try:
        words = shlex.split(text)
    except ValueError as error:
        raise _refused(text, str(error)) from None
    conditions = dict(word.split("=", 1) for word in words if "=" in word)
    names = [word for word in words if "=" not in word]
    unknown = [key for key in conditions if key not in KEYS]
    if unknown:
        raise _refused(text, _("the key {key}", key=unknown[0]))
    if not words or (names and conditions):
        raise _refused(text, _("names and conditions together") if names else _("nothing"))
    return conditions, names


def _refused(text: str, found: str) -> Refusal:
    return Refusal(
        "SELECT",
        shortened(text, 80),
        found,
        _("serial=…, instrument=… or table=…, several of them, or names of campaigns, or all"),
        _("put values with blanks into quotes: SELECT=\"table='rate table'\""),
    )


def name_of(text: str) -> str:
    """The name of a fleet, by what is selected."""
    words = re.sub(r"[^a-z0-9]+", "-", text.lower().replace("=", "-")).strip("-")
    return words[:MAX_NAME].strip("-") or EVERY


def selected(name: str, known: Sequence[str], derived: Path) -> list[str]:
    """The campaigns of a fleet, of those that are `known`; by conditions those with a result.

    Raises
    ------
    Refusal
        where the selection is not there, or is of fewer than two campaigns
    """
    file = FLEETS / f"{name}.txt"
    if not file.is_file():
        raise Refusal(
            str(file), "", _("no such file"), _("a selection"), _("make fleet SELECT=… writes it")
        )
    conditions, names = parts(file.read_text(encoding="utf-8"))
    complete = [
        one
        for one in known
        if all((derived / one / read.place).is_file() for read in READ.values())
    ]
    if names and names != [EVERY]:
        unknown = [one for one in names if one not in known]
        if unknown:
            raise Refusal(
                str(file),
                "",
                _("the campaign {campaign}, which is not known", campaign=unknown[0]),
                _("names of folders of data/raw"),
                _("correct the name, or select by serial=…, instrument=… or table=…"),
            )
        chosen = list(dict.fromkeys(names))
    else:
        chosen = [one for one in complete if _meets(conditions, derived / one)]
    if len(chosen) < 2:
        raise Refusal(
            str(file),
            "",
            _("{count} of {all} campaigns with a result", count=len(chosen), all=len(complete)),
            _("two or more"),
            _("see reports/index.html for what there is; make report CAMPAIGN=… makes a result"),
        )
    return chosen


def _meets(conditions: Mapping[str, str], campaign: Path) -> bool:
    row = tables.CAMPAIGN.read(campaign / "plan/campaign.parquet").iloc[0]
    return all(row[key] == value for key, value in conditions.items())


def keep(selection: str, name: str, fleets: Path = FLEETS) -> str:
    """Keep a selection, by this name or one made of it; the name.

    Raises
    ------
    Refusal
        where it is no selection, or the name is none
    """
    name = name or name_of(selection)
    parts(selection)
    if name != name_of(name):
        raise Refusal(
            "NAME", name, _("another character"), _("a-z, digits, hyphens"), _("rename it")
        )
    write_whole({fleets / f"{name}.txt": f"{selection}\n".encode()})
    return name
