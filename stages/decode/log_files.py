"""The logs of a campaign as files: they are there, and finished."""

from pathlib import Path

from inertial.tables.errors import Refusal
from inertial.text.messages import _


def path_of(file: str, raw: list[Path]) -> Path:
    """The log of this name; refused where there is none."""
    paths = {path.name: path for path in raw if path.is_file()}
    if file not in paths:
        raise Refusal(
            file,
            "",
            "no such file",
            _(
                "the log of the campaign beside {value}",
                value=", ".join(sorted(paths)) or "its campaign.yaml",
            ),
            _("put it into the campaign's folder, or correct its name in campaign.yaml"),
        )
    return paths[file]


def refuse_grown(path: Path, size: int) -> None:
    """A log that is still written to would be another one in every run."""
    if (now := path.stat().st_size) != size:
        raise Refusal(
            path.name,
            "",
            _("{now} bytes, {now_2} more than when it was opened", now=now, now_2=now - size),
            _("a log that is finished"),
            _("copy it when the recording has ended, and run again"),
        )
