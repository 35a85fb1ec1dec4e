"""The command line of `make bench`: all parts, or those that are named.

    python -m benchmarks [bounds calibration faults cost campaigns noise temperature decoding
        dry_run scale kills]

Prints the tables; a run of all parts also writes them to benchmarks/results.md. BENCH_LOG_MB is the
size of the log in `decoding`, in units of 10⁶ byte; BENCH_SAMPLES bounds the campaigns of `scale`,
BENCH_CAMPAIGNS sets the numbers of campaigns of `dry_run`.
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
RESULTS = Path(__file__).parent / "results.md"


def main(names: list[str]) -> None:
    """Run the parts and print their tables."""
    if unknown := [name for name in names if name not in PARTS]:
        sys.exit(f"benchmarks: there is no part {', '.join(unknown)}; parts: {', '.join(PARTS)}")
    page = ["# Benchmarks", "", *(f"- {line}" for line in described()), ""]
    sys.stdout.write("\n".join(page[2:]) + "\n")
    for name in names or PARTS:
        start = time.perf_counter()
        for table in import_module(f"benchmarks.{name}").measured():
            sys.stdout.write(f"{table.text()}\n")
            sys.stdout.flush()
            page += ["```", table.text().rstrip(), "```", ""]
        sys.stdout.write(f"({name}: {time.perf_counter() - start:.0f} s)\n\n")
    if not names:
        RESULTS.write_text("\n".join(page), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
