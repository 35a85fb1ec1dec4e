"""Writing of the folder data/raw/<campaign>/."""

import io
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ruamel.yaml import YAML
from ruamel.yaml.comments import CommentedMap, CommentedSeq
from ruamel.yaml.scalarstring import DoubleQuotedScalarString

from laboratory.recording import Recording

CAMPAIGN_FILE = "campaign.yaml"
QUOTED = ("serial", "date", "laboratory", "operator", "notes", "mounting", "switch_on")


def write(recording: Recording, folder: Path) -> None:
    """Write the logs and, last, campaign.yaml: where it exists, all logs are complete.

    The campaign.yaml of an earlier run is deleted before any of its logs changes.
    """
    folder.mkdir(parents=True, exist_ok=True)
    (folder / CAMPAIGN_FILE).unlink(missing_ok=True)
    for name, content in recording.logs.items():
        put(folder / name, content)
    put(folder / CAMPAIGN_FILE, campaign_yaml(recording.campaign))


def put(path: Path, content: bytes) -> None:
    """Write a file under a temporary name and rename it, so that it is complete or missing."""
    part = path.with_name(path.name + ".part")
    with part.open("wb") as file:
        file.write(content)
        file.flush()
        os.fsync(file.fileno())
    part.replace(path)


def campaign_yaml(campaign: Mapping[str, Any]) -> bytes:
    """campaign.yaml, one manoeuvre a line, free text in quotes."""
    page = CommentedMap(
        {
            key: DoubleQuotedScalarString(value) if key in QUOTED else in_a_line(value)
            for key, value in campaign.items()
            if key != "plan"
        }
    )
    page["plan"] = CommentedSeq([in_a_line(manoeuvre) for manoeuvre in campaign["plan"]])
    yaml = YAML()
    yaml.width = 4096
    yaml.indent(mapping=2, sequence=4, offset=2)
    yaml.allow_unicode = True
    stream = io.BytesIO()
    yaml.dump(page, stream)
    return stream.getvalue()


def in_a_line(value: Any) -> Any:
    """Mappings and lists in braces and brackets."""
    if isinstance(value, Mapping):
        line = CommentedMap({key: in_a_line(inner) for key, inner in value.items()})
        line.fa.set_flow_style()
        return line
    if isinstance(value, list):
        row = CommentedSeq([in_a_line(inner) for inner in value])
        row.fa.set_flow_style()
        return row
    return value
