"""`make injections`: effects and faults in the bytes of real recordings; can be resumed.

    python -m injections <injections> <folder>

Every outcome is a line of `injections.jsonl` in the folder. At the end docs/injections.md is
written.
"""

import sys
from pathlib import Path

import resumable

from injections.injected import INTO, code, folder_of_recordings, outcome
from injections.injections_page import write


def main(count: int, folder: Path) -> None:
    """Draw what is missing, the recordings as they are first, then write the page of all."""
    if not folder_of_recordings().is_dir():
        sys.exit(f"injections: no recordings at {folder_of_recordings()}; set RECORDINGS")
    resumable.with_all_stages()
    jobs = [(number,) for number in range(-len(INTO), count)]
    outcomes = resumable.drawn(folder / "injections.jsonl", code(), ("number",), outcome, jobs)
    sys.stdout.write(write(outcomes, count))


if __name__ == "__main__":
    main(int(sys.argv[1]), Path(sys.argv[2]))
