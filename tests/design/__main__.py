"""`make designs`: designs recorded by the simulated laboratory, in docs/design.md; can be resumed.

    PYTHONPATH=tests:tests/hidden:tests/bounds python -m design <folder> [<draws of each part>]

Every outcome is a line of `design.jsonl` in the folder. At the end docs/design.md is written of
what is there.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

import resumable
from design_draws import PARTS, code, outcome
from design_page import write


def main(folder: Path, most: int) -> None:
    """Draw what is missing, then write the page of all."""
    # Those of a second first, the others in turn.
    quick = [
        (part, n) for part, count in PARTS.items() if part.endswith("blocks") for n in range(count)
    ]
    rest = [(part, n) for n in range(max(PARTS.values())) for part in PARTS if n < PARTS[part]]
    jobs = [job for job in dict.fromkeys([*quick, *rest]) if job[1] < most]
    file = folder / "design.jsonl"
    resumable.with_all_stages()
    resumable.drawn(file, code(), ("part", "number"), outcome, jobs)
    sys.stdout.write(write(resumable.outcomes_of(file, code())))


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else sys.maxsize)
