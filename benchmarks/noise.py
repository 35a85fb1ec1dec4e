"""White noise of a long record: our spectrum compared with allantools' Allan deviation."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.processes import Answer, in_own, in_peers
from benchmarks.tables import Table
from benchmarks.timing import HEADS, REMARK, Seconds

SAMPLES = 10_000_000
RATE = 200.0  # Hz
WHITE = 1.0  # U/√Hz
OSCILLATION = (1.37, 0.5)  # Hz; amplitude in deviations of a sample
RUNS = 3


def measured() -> list[Table]:
    """Time, memory, and errors without and with an oscillation in the band."""
    chance = np.random.default_rng(1)
    scatter = WHITE * np.sqrt(RATE)
    quiet = scatter * chance.standard_normal(SAMPLES)
    frequency, amplitude = OSCILLATION
    ringing = quiet + amplitude * scatter * np.sin(
        2 * np.pi * frequency / RATE * np.arange(SAMPLES)
    )
    with TemporaryDirectory() as name:
        paths = Path(name) / "quiet.npy", Path(name) / "ringing.npy"
        for path, record in zip(paths, (quiet, ringing), strict=True):
            np.save(path, record)
        del quiet, ringing, record
        ours = [in_own("spectrum", path, str(RATE), str(RUNS)) for path in paths]
        others = [in_peers("allan", path, str(RATE), str(RUNS)) for path in paths]
    table = Table(
        f"White noise of {SAMPLES:,} samples of one channel",
        ("method", *HEADS, "memory\nMB", "error\n%", "ringing\n%", "sigma\n%"),
    )
    sigma = ours[0]["sigma"] / ours[0]["white"]
    taus = others[0]["taus"]
    table.add("this project, median of the spectrum", *_cells(ours), f"{sigma:.2%}".rstrip("%"))
    table.add(f"allantools, oadev at {taus} times, read at 1 s", *_cells(others), "–")
    table.remarks.append(
        f"{REMARK} Memory: the whole process, the record among it (80 MB). Ringing: the error with"
        f" an oscillation of {frequency} Hz and {amplitude} deviations of a sample in the record."
        " An Allan deviation shows more than white noise: drifts too, which are not compared here."
    )
    return [table]


def _cells(answers: list[Answer]) -> tuple[str, ...]:
    quiet, ringing = (one["white"] / WHITE - 1 for one in answers)
    memory = max(one["memory"] for one in answers) / 1e6
    times = Seconds.answered(answers).cells()
    return *times, f"{memory:.0f}", f"{100 * quiet:+.2f}", f"{100 * ringing:+.1f}"
