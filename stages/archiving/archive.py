"""The files of the archive: which hold good today, and how one is added.

    data/history/<instrument>/<serial>/<date>-<campaign>-<hash>.parquet
    data/history/simulated/<instrument>/<serial>/<date>-<campaign>-<hash>.parquet

A file never changes. One that replaces others names them, so what holds good is what no other
file names.
"""

import glob
import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import pandas as pd

from inertial.campaign.records import Row
from inertial.tables import CALIBRATION
from inertial.tables.errors import Refusal
from inertial.tables.parquet import write_once
from stages.archiving.content import content_of
from stages.archiving.names import SIMULATED, file_name

HEX = 12  # digits of the hash in the name of a file
ALIKE = ("instrument", "serial", "compensated")  # what calibrations that can be compared share


@dataclass(frozen=True)
class Entry:
    """A file of the archive, by its path inside it, and what it holds: a row of CALIBRATION."""

    file: str
    row: Row


class Archive:
    """The calibrations below `root`: those of real recordings, or those of simulated ones."""

    def __init__(self, root: Path, *, simulated: bool) -> None:
        self.root = root
        self._place = root / SIMULATED if simulated else root

    def add(self, calibration: Row) -> Entry:
        """Bring a calibration into the archive; what holds good already stays as it is.

        Two that come at once with the same content are one file, for its name follows from
        the content. Two with different content of one campaign both hold good, until a third
        replaces them.
        """
        content, held = content_of(calibration), self.current(calibration["campaign"])
        for entry in held:
            if entry.row["content"] == content:
                return entry
        replaced = [entry.file for entry in held]
        path = self._folder(calibration) / _name(calibration, content, replaced)
        row = calibration | {"content": content, "supersedes": replaced}
        write_once(CALIBRATION, path, pd.DataFrame([row]))
        return self._entry(path)

    def current(self, campaign: str) -> list[Entry]:
        """What holds good of a campaign, also where its IMU or its date has been corrected."""
        pattern = f"*/*/*-{glob.escape(file_name(campaign))}-{'[0-9a-f]' * HEX}.parquet"
        entries = self._entries(self._place.glob(pattern))
        own = [entry for entry in entries if entry.row["campaign"] == campaign]
        replaced = {file for entry in own for file in entry.row["supersedes"]}
        return [entry for entry in own if entry.file not in replaced]

    def earlier(self, calibration: Row) -> list[Entry]:
        """What holds good of the other campaigns of the same IMU that are not dated later.

        Where the errors were taken out of the logs, what is left of them is another matter than
        the errors, so these and the others are not compared.

        The order of campaigns without a date is not known, so they count. IMUs whose serial
        number is not known may be different ones, so they have no earlier calibrations.
        """
        if calibration["serial"] == "unknown":
            return []
        beside = self._entries(self._folder(calibration).glob("*.parquet"))
        campaigns = {entry.row["campaign"] for entry in beside} - {calibration["campaign"]}
        found = [
            entry
            for campaign in campaigns
            for entry in self.current(campaign)
            if all(entry.row[key] == calibration[key] for key in ALIKE)
            and _not_later(entry.row["date"], calibration["date"])
        ]
        return sorted(found, key=lambda entry: (entry.row["date"], entry.file))

    def _folder(self, calibration: Row) -> Path:
        names = (file_name(calibration[key]) for key in ("instrument", "serial"))
        return self._place.joinpath(*names)

    def _entries(self, paths: Iterable[Path]) -> list[Entry]:
        return [self._entry(path) for path in sorted(paths) if path.is_file()]

    def _entry(self, path: Path) -> Entry:
        try:
            table = CALIBRATION.read(path)
        except Refusal as refusal:
            raise replace(refusal, cure="move this file out of the archive") from None
        row = {str(name): value for name, value in table.iloc[0].items()}
        return Entry(path.relative_to(self.root).as_posix(), row)


def _name(calibration: Row, content: str, replaced: list[str]) -> str:
    """The name of a new file.

    What it replaces is in the hash, so that going back to an older content adds a file again.
    """
    digest = hashlib.sha256(json.dumps([content, *sorted(replaced)]).encode()).hexdigest()
    date, campaign = file_name(calibration["date"]), file_name(calibration["campaign"])
    return f"{date}-{campaign}-{digest[:HEX]}.parquet"


def _not_later(date: str, than: str) -> bool:
    return "unknown" in (date, than) or date <= than
