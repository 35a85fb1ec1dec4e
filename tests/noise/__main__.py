"""`make noise`: what is found of simulated noise, in docs/noise.md; can be resumed.

    PYTHONPATH=tests python -m noise <folder> [<recordings>]

Every outcome is a line of `noise.jsonl` in the folder. At the end docs/noise.md and its figures are
written. With a number, so many recordings are drawn in each part at the most.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import resumable
from noise_draws import PARTS, code, outcome
from noise_page import write


def main(folder: Path, most: int) -> None:
    """Draw what is missing, then write the page of all."""
    jobs = [(part, n) for part, count in PARTS.items() for n in range(min(count, most))]
    file = folder / "noise.jsonl"
    sys.stdout.write(write(resumable.drawn(file, code(), ("part", "number"), outcome, jobs)))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else sys.maxsize)
