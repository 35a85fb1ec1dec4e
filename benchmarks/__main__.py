"""The command line of `make bench`: all parts, or those that are named.

    python -m benchmarks [bounds calibration faults cost campaigns noise temperature decoding
        dry_run scale kills]

Prints the tables, keeps those of each part in data/derived/benchmarks, and writes
docs/benchmarks.md of all that are there. BENCH_LOG_MB is the size of the log in `decoding`, in
units of 10⁶ byte; BENCH_SAMPLES bounds the campaigns of `scale`, BENCH_CAMPAIGNS sets the numbers
of campaigns of `dry_run`.
"""

import sys
import time
from importlib import import_module
from pathlib import Path

from benchmarks.machine import described

PARTS = (
    "bounds",
    "calibration",
    "faults",
    "cost",
    "campaigns",
    "noise",
    "temperature",
    "decoding",
    "dry_run",
    "scale",
    "kills",
)
ROOT = Path(__file__).parent.parent
KEPT = ROOT / "data/derived/benchmarks"
PAGE = ROOT / "docs/benchmarks.md"
HEAD = """# Benchmarks

`make bench` compares the project with other programs, side by side on one machine;
`make bench ONLY=bounds` runs one part again. This page is written by the runs; no figure in it is
set by hand.
"""


def main(names: list[str]) -> None:
    """Run the parts and print their tables; then write the page."""
    if unknown := [name for name in names if name not in PARTS]:
        sys.exit(f"benchmarks: there is no part {', '.join(unknown)}; parts: {', '.join(PARTS)}")
    KEPT.mkdir(parents=True, exist_ok=True)
    for name in names or PARTS:
        part = [f"## {name.replace('_', ' ').capitalize()}", "", *described(), ""]
        start = time.perf_counter()
        for table in import_module(f"benchmarks.{name}").measured():
            sys.stdout.write(f"{table.text()}\n")
            sys.stdout.flush()
            part += ["```", table.text().rstrip(), "```", ""]
        sys.stdout.write(f"({name}: {time.perf_counter() - start:.0f} s)\n\n")
        (KEPT / f"{name}.md").write_text("\n".join(part), encoding="utf-8")
    kept = [file for name in PARTS if (file := KEPT / f"{name}.md").exists()]
    page = "\n".join([HEAD, *(file.read_text(encoding="utf-8") for file in kept)])
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
