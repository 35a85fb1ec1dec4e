"""The logs of a campaign as files: they are there, and finished."""

from pathlib import Path

from inertial.tables.errors import Refusal


def path_of(file: str, raw: list[Path]) -> Path:
    """The log of this name; refused where there is none."""
    paths = {path.name: path for path in raw if path.is_file()}
    if file not in paths:
        raise Refusal(
            file,
            "",
            "no such file",
            f"the log of the campaign beside {', '.join(sorted(paths)) or 'its campaign.yaml'}",
            "put it into the campaign's folder, or correct its name in campaign.yaml",
        )
    return paths[file]


def refuse_grown(path: Path, size: int) -> None:
    """A log that is still written to would be another one in every run."""
    if (now := path.stat().st_size) != size:
        raise Refusal(
            path.name,
            "",
            f"{now} bytes, {now - size} more than when it was opened",
            "a log that is finished",
            "copy it when the recording has ended, and run again",
        )
