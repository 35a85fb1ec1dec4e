"""Whole campaigns from logs to report, each ten times as long as the last: time and memory.

BENCH_SAMPLES sets how many samples the longest may have, instead of 10⁸.
"""

import os
from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.long_campaign import record
from benchmarks.processes import Answer, in_own
from benchmarks.tables import Table, digits

SIZES = (10**6, 10**7, 10**8)
BAR = 2000.0  # MB
LONGEST = 4  # stages that are named
CAMPAIGN = "long"
HEADS = (
    "samples",
    "logs\nMB",
    "time\ns",
    "processor\ns",
    "grows as\nsamples to the",
    "memory\nMB",
    "largest\nprocess",
    "longest stages\nprocessor s",
)


def measured() -> list[Table]:
    """One run of the workflow for every size."""
    table = Table("A campaign from logs to report, as its rests grow longer", HEADS)
    most = int(float(os.environ.get("BENCH_SAMPLES", SIZES[-1])))
    before: tuple[float, float] | None = None
    largest = 0.0
    for size in (size for size in SIZES if size <= most):
        samples, written, answer = _run(size)
        cpu, memory = answer["cpu"], answer["together"] / 1e6
        growth = log(cpu / before[1]) / log(samples / before[0]) if before else None
        stages = sorted(answer["stages"].items(), key=lambda stage: -stage[1]["cpu"])[:LONGEST]
        table.add(
            f"{samples:,}",
            digits(written / 1e6),
            digits(answer["seconds"]),
            digits(cpu),
            "" if growth is None else f"{growth:.2f}",
            digits(memory),
            digits(answer["largest"] / 1e6),
            ", ".join(f"{stage} {digits(took['cpu'])}" for stage, took in stages),
        )
        before, largest = (samples, cpu), max(largest, memory)
    table.remarks.append(
        "Binary logs, two processors. Processor and memory: of all processes of a run, Snakemake"
        " among them; memory is sampled five times a second, and shared memory counts once. Bar:"
        f" {BAR:,.0f} MB, {'kept' if largest < BAR else 'MISSED'}."
    )
    return [table]


def _run(size: int) -> tuple[int, int, Answer]:
    with TemporaryDirectory() as name:
        folder = Path(name)
        samples, written = record(folder / "data" / "raw" / CAMPAIGN, size)
        return samples, written, in_own("running", folder, CAMPAIGN)
