"""The archive of calibrations: one file for each, which never changes.

    data/history/<instrument>/<serial>/<date>-<campaign>-<hash>.parquet
    data/history/simulated/<instrument>/<serial>/<date>-<campaign>-<hash>.parquet

A file that supersedes others names them; the current calibrations are those that no other file
names.
"""

import glob
import hashlib
import json
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from urllib.parse import quote_plus

from inertial.campaign.records import Row
from inertial.tables import CALIBRATION
from inertial.tables.errors import Refusal
from inertial.tables.parquet import write_once
from inertial.tables.table import Table
from inertial.text.parameters import EXTENDED, JOINT, SENSOR_OF

SIMULATED = "simulated"  # folder of simulated calibrations; no instrument's folder has this name
RESULT = "diagnosis"  # stage of the rows that are the result that counts
REFERENCES = "references"  # column of what of each sigma is the error of a reference
SHARED = ("mounting", "switch_on")  # labels that calibrations may have in common
COMPARABLE_BY = ("instrument", "serial", "compensated")  # equal where calibrations are compared
FILE_HASH_DIGITS = 12
NAMED = re.compile(rf"(.+)-[0-9a-f]{{{FILE_HASH_DIGITS}}}\.parquet")  # date and campaign before
MAX_NAME_LENGTH = 100  # characters; a file name holds campaign, date and hash, 255 at most
NAME_HASH_DIGITS = 16  # of the hash that replaces the end of a longer name


@dataclass(frozen=True)
class Entry:
    """A file of the archive, by its path inside it, and its content: a row of CALIBRATION."""

    file: str
    row: Row


class Archive:
    """The calibrations below `root`: those of real recordings, or those of simulated ones."""

    def __init__(self, root: Path, *, simulated: bool) -> None:
        self.root = root
        self._base = root / SIMULATED if simulated else root
        self._read: dict[Path, Entry] = {}  # a file never changes

    def add(self, calibration: Row) -> Entry:
        """Add a calibration, unless a current one has the same content.

        Two processes that add the same content write one file, for its name follows from the
        content. Two that add different content of one campaign leave both current, until a
        third supersedes them.
        """
        content, current = content_hash(calibration), self.current(calibration["campaign"])
        for entry in current:
            if entry.row["content"] == content:
                return entry
        superseded = [entry.file for entry in current]
        path = self._folder(calibration) / _path_name(calibration, content, superseded)
        row = calibration | {"content": content, "supersedes": superseded}
        write_once(CALIBRATION, path, [row])
        return self._entry(path)

    def current(self, *campaigns: str) -> list[Entry]:
        """The current entries of campaigns, also where their IMU or their date was corrected."""
        names = {file_name(campaign) for campaign in campaigns}
        # The archive may be large: its names are looked through once.
        paths = (path for path in self._base.glob("*/*/*.parquet") if names & _campaigns_of(path))
        entries = [entry for entry in self._entries(paths) if entry.row["campaign"] in campaigns]
        superseded = {file for entry in entries for file in entry.row["supersedes"]}
        return [entry for entry in entries if entry.file not in superseded]

    def earlier(self, calibration: Row) -> list[Entry]:
        """Current entries of other campaigns of the same IMU that are not dated later.

        Calibrations of compensated logs hold what the first compensation left over, so they are
        not compared with the others. The order of campaigns without a date is unknown, so they
        are included. IMUs without a known serial number may be different ones, so they have no
        earlier calibrations. The same logs once more, as with something confirmed, are the same
        calibration by another name.
        """
        if calibration["serial"] == "unknown":
            return []
        neighbours = self._entries(self._folder(calibration).glob("*.parquet"))
        campaigns = {entry.row["campaign"] for entry in neighbours} - {calibration["campaign"]}
        comparable = [
            entry
            for entry in self.current(*campaigns)
            if all(entry.row[key] == calibration[key] for key in COMPARABLE_BY)
            and _is_not_later(entry.row["date"], calibration["date"])
            and _logs(entry.row) != _logs(calibration)
        ]
        comparable = sorted(comparable, key=lambda entry: (entry.row["date"], entry.file))
        once = {_logs(entry.row) or entry.file: entry for entry in comparable}
        return list(once.values())

    def of_serial(self, folder: str) -> list[Entry]:
        """The current entries of a serial number in the order of their dates; unknown ones first.

        `folder`: its `file_name`; instruments of different type may have the same number.
        """
        entries = self._entries(self._base.glob(f"*/{glob.escape(folder)}/*.parquet"))
        current = [
            entry
            for entry in self.current(*{entry.row["campaign"] for entry in entries})
            if file_name(entry.row["serial"]) == folder
        ]
        return sorted(current, key=lambda e: (e.row["date"][:1].isdigit(), e.row["date"], e.file))

    def _folder(self, calibration: Row) -> Path:
        return self._base / file_name(calibration["instrument"]) / file_name(calibration["serial"])

    def _entries(self, paths: Iterable[Path]) -> list[Entry]:
        return [self._entry(path) for path in sorted(paths) if path.is_file()]

    def _entry(self, path: Path) -> Entry:
        if path not in self._read:
            try:
                row = _row(path)
            except Refusal as refusal:
                raise replace(refusal, cure="move this file out of the archive") from None
            self._read[path] = Entry(path.relative_to(self.root).as_posix(), row)
        return self._read[path]


def _logs(calibration: Row) -> frozenset[str]:
    """The SHA-256 of the logs of a calibration."""
    inputs = calibration["inputs"]
    return frozenset(row["sha256"] for row in inputs if row["file"] != "campaign.yaml")


def results(entry: Entry) -> list[Row]:
    """The parameters of the result that counted in an archived calibration, with its verdict.

    `shared`: by reference, what of a sigma is its error.
    """
    verdicts = {(row["mount"], row["sensor"]): row for row in entry.row["verdicts"]}
    origin = {key: entry.row[key] for key in ("campaign", "date", "table")} | {"file": entry.file}
    nothing: Row = {"verdict": None, "condition": None}
    shared: dict[tuple[str, str, str], dict[str, float]] = {}
    for row in entry.row[REFERENCES]:
        shared.setdefault(_key(row), {})[row["reference"]] = row["sigma"]
    rows = []
    for row in entry.row["parameters"]:
        if row["stage"] == RESULT and row["effect"] is None and row["value"] is not None:
            verdict = verdicts.get((row["mount"], row["sensor"]), nothing)
            rows.append(
                origin
                | {key: row[key] for key in ("id", "mount", "sensor", "value", "sigma", "unit")}
                | {"quantity": row["parameter"], "shared": shared.get(_key(row), {})}
                | {key: verdict[key] for key in nothing}
            )
    return rows


def _row(path: Path) -> Row:
    """The one row of a file of the archive, as the newest version has it."""
    try:
        return _row_of(CALIBRATION, path)
    except Refusal as refusal:
        for version, read in OLDER.items():
            try:
                return read(_row_of(replace(CALIBRATION, version=version), path))
            except Refusal:
                continue
        raise refusal


def _row_of(contract: Table, path: Path) -> Row:
    return {str(name): value for name, value in contract.read(path).iloc[0].items()}


def _of_version_1(row: Row) -> Row:
    """A row of version 1, which wrote mount, sensor and parameter into the identifiers alone.

    stage/method/parameter, or extension/stage/parameter; with @mount after the method or stage.
    """
    parameters = []
    for old in row["parameters"]:
        stage, _, rest = old["id"].partition("/")
        group, _, parameter = rest.rpartition("/")
        name, _, mount = group.partition("@")
        is_extended = stage == "extension"
        parameters.append(
            {
                **old,
                "mount": mount,
                "sensor": SENSOR_OF[name if is_extended else stage],
                "method": EXTENDED if is_extended else name,
                "parameter": parameter,
            }
        )
    return _of_version_2(row | {"parameters": parameters})


def _of_version_2(row: Row) -> Row:
    """A row of version 2, which had no verdict, and no rows of the result that counts.

    That was the joint one, with value and sigma of the extended one where that was archived.
    """
    rows = [{**old, "stage": old["id"].partition("/")[0]} for old in row["parameters"]]
    for old in rows:
        effect, point, _parameter = old["parameter"].partition(".")
        old["effect"] = effect if point else None
    better = {_key(old): old for old in rows if old["method"] == EXTENDED}
    counted = [
        old | {key: better.get(_key(old), old)[key] for key in ("value", "sigma")}
        for old in rows
        if old["method"] == JOINT
    ]
    parameters = rows + [old | {"stage": RESULT} for old in counted]
    return _of_version_3(row | {"parameters": parameters, "verdicts": []})


def _of_version_3(row: Row) -> Row:
    """A row of version 3, which did not say what it shares with other calibrations."""
    return _of_version_4(row | dict.fromkeys(SHARED))


def _of_version_4(row: Row) -> Row:
    """A row of version 4, which did not say what its sigmas have in common with others."""
    return row | {REFERENCES: []}


def _key(row: Row) -> tuple[str, str, str]:
    return row["mount"], row["sensor"], row["parameter"]


OLDER = {
    4: _of_version_4,
    3: _of_version_3,
    2: _of_version_2,
    1: _of_version_1,
}  # how a row of each older version is read


def content_hash(calibration: Row) -> str:
    """SHA-256 over IMU, campaign, numbers, verdicts, inputs and settings of a row of the archive.

    The code is left out: where a change of it leaves all numbers unchanged, the calibration is
    the same.
    """
    content: Row = {
        "of": [calibration[key] for key in ("campaign", "simulated", "instrument", "serial")],
        "date": calibration["date"],
        "parameters": sorted(
            [row["id"], row["unit"], row["frame"], row["value"], row["sigma"]]
            for row in calibration["parameters"]
        ),
        "verdicts": sorted(
            [row["mount"], row["sensor"], row["verdict"], row["method"], row["condition"] or ""]
            for row in calibration["verdicts"]
        ),
        "covariance": sorted(
            [row["first"], row["second"], row["covariance"]] for row in calibration["covariance"]
        ),
        "inputs": sorted([row["file"], row["sha256"]] for row in calibration["inputs"]),
        "settings": {row["stage"]: row["settings"] for row in calibration["made_by"]},
    }
    if shared := {key: calibration[key] for key in SHARED if calibration.get(key)}:
        content["shared"] = shared  # without them the hash is that of older versions
    if len(references := calibration.get(REFERENCES, ())):
        content[REFERENCES] = sorted(
            [row[key] for key in ("mount", "sensor", "parameter", "reference", "sigma")]
            for row in references
        )
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def file_name(text: str) -> str:
    """A file name for any text: unique, and without path separators or a leading dot.

    Other characters than letters, digits, '-', '_' and inner '.' are written as in a web address:
    `A/17 b` is `A%2F17+b`. A name that would be too long ends with '~' and a hash of the text.
    """
    name = quote_plus(text, safe="").replace("~", "%7E")
    if name.startswith("."):
        name = f"%2E{name[1:]}"
    if name == SIMULATED:
        name = f"%{ord(name[0]):X}{name[1:]}"
    if len(name) > MAX_NAME_LENGTH:
        digest = hashlib.sha256(text.encode()).hexdigest()[:NAME_HASH_DIGITS]
        name = f"{name[: MAX_NAME_LENGTH - 1 - NAME_HASH_DIGITS]}~{digest}"
    return name


def _path_name(calibration: Row, content: str, superseded: list[str]) -> str:
    """The name of a new file.

    Its hash includes the superseded files, so that going back to an older content adds a file.
    """
    digest = hashlib.sha256(json.dumps([content, *sorted(superseded)]).encode()).hexdigest()
    date, campaign = file_name(calibration["date"]), file_name(calibration["campaign"])
    return f"{date}-{campaign}-{digest[:FILE_HASH_DIGITS]}.parquet"


def _campaigns_of(path: Path) -> set[str]:
    """The names of campaigns of which a file may be: those of its date have hyphens, too."""
    words = NAMED.fullmatch(path.name)
    parts = words[1].split("-") if words else []
    return {"-".join(parts[first:]) for first in range(1, len(parts))}


def _is_not_later(date: str, than: str) -> bool:
    return "unknown" in (date, than) or date <= than
