"""Drafts of logs that a test writes, and what they say."""

from pathlib import Path
from typing import Any

import numpy as np
from ruamel.yaml import YAML
from scipy.spatial.transform import Rotation

from commands.draft.__main__ import draft

Document = dict[str, Any]
Rates = list[tuple[float, tuple[float, float, float]]]  # s, and rad/s about x, y, z


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


def moved(rates: Rates) -> np.ndarray:
    """Time, accelerometers in m/s² and gyros in °/s at 100 Hz, (n, 7)."""
    rate = np.concatenate([np.tile(one, (round(100 * seconds), 1)) for seconds, one in rates])
    up, down = np.empty_like(rate), np.array([0.0, 0.0, 1.0])
    for k, turned in enumerate(rate / 100):
        up[k] = down
        down = Rotation.from_rotvec(-turned).apply(down)
    noise = np.random.default_rng(0).standard_normal((2, *rate.shape))
    time = np.arange(len(rate)) / 100
    return np.column_stack([time, 9.8 * up + 0.01 * noise[0], np.degrees(rate) + 0.05 * noise[1]])
