"""Which campaigns there are and which logs they name, before anything is run.

The workflow asks this to know its files. It never fails: what is wrong with a
campaign is said by its plan, so that one bad campaign does not stop the others.
"""

from pathlib import Path
from typing import Any

import yaml

from inertial.tables.yaml_file import MAX_BYTES, MAX_DEPTH


class _Texts(yaml.CSafeLoader):
    """YAML read by a library in C, every scalar as text: names need no types, many files time."""


_Texts.yaml_implicit_resolvers = {"<": yaml.CSafeLoader.yaml_implicit_resolvers["<"]}  # merged keys


def campaigns(folder: str, pattern: str) -> list[str]:
    """Names of the campaigns under `folder`: of the files, or of the folders they lie in."""
    found = sorted(Path(folder).glob(pattern))
    return [path.stem if "/" not in pattern else path.parent.name for path in found]


def logs_of(path: Path) -> list[str]:
    """The log files that a campaign names, or the campaign inside a simulated one's description."""
    content = _texts(path)
    if isinstance(content, dict) and isinstance(content.get("campaign"), dict):
        content = content["campaign"]
    if not isinstance(content, dict) or not isinstance(content.get("plan"), list):
        return []
    manoeuvres = [item for item in content["plan"] if isinstance(item, dict)]
    logs = [item.get("log") or content.get("log") for item in manoeuvres]
    apart = [content.get("encoder"), content.get("gyro"), *(m.get("gyro") for m in manoeuvres)]
    logs += [other.get("log") for other in apart if isinstance(other, dict)]
    return sorted({log for log in logs if isinstance(log, str) and Path(log).name == log})


def _texts(path: Path) -> Any:
    try:
        if path.stat().st_size > MAX_BYTES:
            return None
        text, depth = path.read_bytes(), 0
        for event in yaml.parse(text, _Texts):  # to load it the library calls itself for each level
            depth += isinstance(event, yaml.CollectionStartEvent)
            depth -= isinstance(event, yaml.CollectionEndEvent)
            if depth > MAX_DEPTH:
                return None
        return _Texts(text).get_single_data()
    except (yaml.YAMLError, OSError, ValueError):
        return None
