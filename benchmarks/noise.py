"""Noise of a long record: Allan deviation, its terms and the white noise, beside allantools."""

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
        factors = Path(name) / "factors.npy"
        np.save(factors, np.unique(others[0]["factors"]))
        curve = in_own("allan", paths[0], str(RATE), str(RUNS), factors)
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
    return [_curves(curve, others[0]), table]


def _curves(ours: Answer, theirs: Answer) -> Table:
    """The overlapping Allan deviation at the same averaging times, and what is fitted to it."""
    table = Table(
        f"Overlapping Allan deviation of {SAMPLES:,} samples at {theirs['taus']} averaging times",
        ("method", *HEADS, "memory\nMB", "largest\ndifference"),
    )
    known = dict(zip(theirs["factors"], theirs["deviations"], strict=True))
    pairs = zip(ours["factors"], ours["deviations"], strict=True)
    off = max(abs(value / known[factor] - 1) for factor, value in pairs)
    memory = f"{ours['memory'] / 1e6:.0f}"
    times = Seconds(ours["seconds"], ours["cpu"])
    table.add("this project, in pieces", *times.cells(), memory, f"{off:.1e}")
    of_terms = Seconds(ours["seconds_of_terms"], ours["cpu_of_terms"])
    table.add("this project, the five terms with sigma", *of_terms.cells(), memory, "–")
    times = Seconds(theirs["seconds"], theirs["cpu"])
    table.add("allantools, oadev", *times.cells(), f"{theirs['memory'] / 1e6:.0f}", "–")
    value, sigma, _ = ours["terms"]["white_noise"]
    limits = ", ".join(
        f"{name.replace('_', ' ')} below {upper:.2g}"
        for name, (_, _, upper) in ours["terms"].items()
        if np.isfinite(upper)
    )
    table.remarks.append(
        f"{REMARK} In pieces: read from the file 65,536 samples at a time; its memory does not grow"
        " with the record but with the longest average, at most 64 byte for each of its samples."
        f" Terms: white noise {value:.5f} ± {sigma:.5f} of {WHITE:g}, {limits}."
    )
    return table


def _cells(answers: list[Answer]) -> tuple[str, ...]:
    quiet, ringing = (one["white"] / WHITE - 1 for one in answers)
    memory = max(one["memory"] for one in answers) / 1e6
    times = Seconds.answered(answers).cells()
    return *times, f"{memory:.0f}", f"{100 * quiet:+.2f}", f"{100 * ringing:+.1f}"
