"""`make scale`: what campaigns cost, many and long ones, in docs/scale.md; can be resumed.

    PYTHONPATH=tests python -m scale <folder> [<campaigns that are run>]

Every outcome is a line of `scale.jsonl` in the folder. SCALE_PLANNED sets the numbers of campaigns
that are only planned, instead of "100 1000".
"""

import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import resumable
from measured import code, outcome
from scale_page import write

SMALL = 20  # campaigns
LONG = (1_000_000, 10_000_000)  # samples
ARCHIVED = (1, 100, 500)  # earlier calibrations of an IMU
FOLDER = (1, 1000, 10_000)  # campaigns of a folder of which one is planned


def main(folder: Path, small: int) -> None:
    """Measure what is missing, then write the page of all."""
    planned = [int(size) for size in os.environ.get("SCALE_PLANNED", "100 1000").split()]
    jobs = [
        *(("planned", size) for size in planned),
        *(("folder", size) for size in FOLDER),
        *(("archive", size) for size in ARCHIVED),
        *(("long", size) for size in LONG),
        ("kilohertz", 3_600_000),
        ("small", small),
    ]
    file = folder / "scale.jsonl"
    sys.stdout.write(write(resumable.drawn(file, code(), ("part", "size"), outcome, jobs)))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else SMALL)
