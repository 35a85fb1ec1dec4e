"""`make histories`: intervals and jumps in simulated histories, in docs/repeatability.md.

PYTHONPATH=tests python -m histories <folder> [<histories>]
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import numpy as np
import resumable
from history_draws import JUMP_SIZES, KINDS, code, outcome

PAGE = Path(__file__).parents[2] / "docs/repeatability.md"
PARTS = {"next": 2000, "jump": 1500}
COUNTS = ((3, 3), (4, 5), (6, 8), (9, 12))

HEAD = """# Histories of calibrations

Written by `make histories`: simulated histories of one parameter, of 3 to 12 calibrations 0.3 to
1.5 years apart, whose own sigmas are known and differ by 30 %. Beside these there is nothing, or a
scatter of the days, a random walk, a steady drift, each of 0.5 to 20 sigmas in a year,
or all of them: `tests/histories/history_draws.py`.
"""


def page(outcomes: list[resumable.Outcome]) -> str:
    """What holds, and what is named."""
    following = [one for one in outcomes if one["part"] == "next"]
    jumps = [one for one in outcomes if one["part"] == "jump"]
    lines = [HEAD, "## The next calibration\n"]
    lines += [
        f"Of {len(following)} intervals of 95 %, {_share(following, 'holds')} hold the next.\n",
        "| beside its sigmas the history has | histories | held | median width, sigmas |",
        "|---|---|---|---|",
    ]
    for kind in KINDS:
        lines.append(_row(kind, [one for one in following if one["kind"] == kind]))
    lines += ["", "| calibrations | histories | held | median width, sigmas |", "|---|---|---|---|"]
    for least, most in COUNTS:
        own = [one for one in following if least <= one["calibrations"] <= most]
        lines.append(_row(f"{least}" if least == most else f"{least} to {most}", own))
    lines += [
        "\n## Jumps\n",
        "Histories of 5 to 12 calibrations whose days scatter by one sigma beside their own, with\n"
        "a step at any place, at the level of 1 % for one parameter.\n",
        "| step, sigmas | histories | named | at the right date |",
        "|---|---|---|---|",
    ]
    for size in JUMP_SIZES:
        own = [one for one in jumps if one["size"] == size]
        right = _share(own, "right") if size else "–"
        lines.append(f"| {size:.0f} | {len(own)} | {_share(own, 'named')} | {right} |")
    return "\n".join(lines) + "\n"


def _row(name: str, own: list[resumable.Outcome]) -> str:
    width = float(np.median([one["width"] for one in own]))
    return f"| {name} | {len(own)} | {_share(own, 'holds')} | {width:.1f} |"


def _share(own: list[resumable.Outcome], key: str) -> str:
    return f"{100 * float(np.mean([one[key] for one in own])):.1f} %"


def main(folder: Path, most: int) -> None:
    """Draw what is missing, then write the page of all."""
    jobs = [(part, n) for part, count in PARTS.items() for n in range(min(count, most))]
    file = folder / "histories.jsonl"
    outcomes = resumable.drawn(file, code(), ("part", "number"), outcome, jobs)
    PAGE.write_text(page(outcomes), encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else sys.maxsize)
