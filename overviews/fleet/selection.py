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
from inertial.text.messages import _, listed
from inertial.text.numbers import shortened
from overviews.fleet.declared import READ

FLEETS = Path("data/fleets")
KEYS = ("serial", "instrument", "table")
EVERY = "all"
MAX_NAME = 60  # characters
MOST_OFFERED = 20  # values that a refusal lists
SELECT = "SELECT"  # the place of a selection that is given on the command line


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
        SELECT,
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
    return chosen(file.read_text(encoding="utf-8").strip(), known, derived, str(file))


def chosen(text: str, known: Sequence[str], derived: Path, of: str = SELECT) -> list[str]:
    """The campaigns of a selection; `of`: where it is given.

    Raises
    ------
    Refusal
        where it is none, or is of fewer than two campaigns
    """
    conditions, names = parts(text)
    shown = shortened(text, 80)
    complete = [
        one
        for one in known
        if all((derived / one / read.place).is_file() for read in READ.values())
    ]
    if names and names != [EVERY]:
        unknown = [one for one in names if one not in known]
        if unknown:
            raise Refusal(
                of,
                shown,
                _("the campaign {campaign}, which is not known", campaign=unknown[0]),
                _("names of folders of data/raw"),
                _("correct the name, or select by serial=…, instrument=… or table=…"),
            )
        found = list(dict.fromkeys(names))
    else:
        about = {one: _about(derived / one) for one in complete}
        missing = [(k, v) for k, v in conditions.items() if v not in _there(about, k)]
        if missing:
            raise Refusal(
                of,
                shown,
                _("no campaign with a result has {condition}", condition="=".join(missing[0])),
                _("one of these: {there}", there=_offered(about, missing[0][0])),
                _("correct SELECT; make report CAMPAIGN=… makes a result"),
            )
        found = [one for one in complete if conditions.items() <= about[one].items()]
    if len(found) < 2:
        raise Refusal(
            of,
            shown,
            _("{count} of {all} campaigns with a result", count=len(found), all=len(complete))
            + (f": {found[0]}" if found else ""),
            _("two or more"),
            _("see reports/index.html for what there is; make report CAMPAIGN=… makes a result"),
        )
    return found


def _about(campaign: Path) -> dict[str, str]:
    row = tables.CAMPAIGN.read(campaign / "plan/campaign.parquet").iloc[0]
    return {key: str(row[key]) for key in KEYS}


def _there(about: Mapping[str, Mapping[str, str]], key: str) -> list[str]:
    return sorted({row[key] for row in about.values()})


def _offered(about: Mapping[str, Mapping[str, str]], key: str) -> str:
    """The values of a key as they are written in a selection."""
    every = _there(about, key)
    words = [shlex.quote(f"{key}={value}") for value in every[:MOST_OFFERED]]
    return listed(words + ["…"] * (len(every) > MOST_OFFERED), "or") if words else _("none")


def keep(selection: str, name: str, known: Sequence[str], folder: Path) -> str:
    """Keep a selection, by this name or one made of it, if it is one of `known`; the name.

    `known`: campaigns of the folder. A selection that is refused leaves no file.

    Raises
    ------
    Refusal
        where it is no selection, or of fewer than two campaigns, or the name is none
    """
    name = name or name_of(selection)
    parts(selection)
    if name != name_of(name):
        raise Refusal(
            "NAME", name, _("another character"), _("a-z, digits, hyphens"), _("rename it")
        )
    chosen(selection, known, folder / "data/derived")
    write_whole({folder / FLEETS / f"{name}.txt": f"{selection}\n".encode()})
    return name
