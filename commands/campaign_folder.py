"""A folder for a new campaign; one that is there is never written to."""

import re
from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.messages import _

NAME = re.compile(r"[a-z0-9][a-z0-9-]*")


def free_folder(name: str, data: Path) -> Path:
    """The folder of a campaign that is not there yet.

    Raises
    ------
    Refusal
        where the name is none, or is taken
    """
    if not NAME.fullmatch(name):
        raise Refusal(
            "NAME",
            "",
            repr(name),
            _("small letters a-z, digits and hyphens, a letter or digit first"),
            _("name the campaign: NAME=june"),
        )
    folder = data / "raw" / name
    if folder.exists() or (data / "simulated" / f"{name}.yaml").exists():
        raise Refusal(
            str(folder),
            "",
            _("there is a campaign of this name"),
            _("a name that is free; nothing is overwritten"),
            _("give another: NAME=…"),
        )
    return folder
