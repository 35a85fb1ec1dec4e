"""Drafts of logs that a test writes, and what they say."""

from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML

from commands.draft.__main__ import draft

Document = dict[str, Any]


def told(folder: Path) -> Document:
    return YAML(typ="safe").load(folder / "campaign.yaml")


def drafted(logs: dict[str, str], tmp_path: Path, **options: Any) -> Path:
    """The folder of a campaign drafted from logs with these contents."""
    for name, text in logs.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return draft([tmp_path / name for name in logs], "drafted", tmp_path / "data", **options)


def written(columns: list[np.ndarray], between: str = ",", digits: int = 7) -> str:
    """Rows of numbers as text."""
    rows = np.column_stack(columns)
    return "".join(between.join(f"{v:.{digits}g}" for v in row) + "\n" for row in rows)


def comments(folder: Path) -> str:
    """What a draft says at its top, without the ends of lines."""
    lines = (folder / "campaign.yaml").read_text(encoding="utf-8").splitlines()
    return " ".join(" ".join(line.lstrip("# ") for line in lines if line[:1] == "#").split())
