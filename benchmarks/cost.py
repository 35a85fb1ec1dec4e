"""Cost of the estimation: time and memory from blocks to parameters, as campaigns grow.

The laboratory records long campaigns with 5 samples per second instead of 200. A sample is a mean
over its interval, so one of 0.2 s is a block of a turn, and all blocks are those that a log of 200
samples per second would give, without the log of gigabytes.
"""

from math import log
from pathlib import Path
from tempfile import TemporaryDirectory

import chain  # of the tests: the stages one after another in this process

import laboratory
from benchmarks.campaign import RATE, RESTS, TURNS, document, performed
from benchmarks.processes import Answer, in_own
from benchmarks.tables import Table, digits
from benchmarks.timing import REMARK, Seconds

SAMPLED = 5.0  # Hz
LONGER = {1: 5, 10: 3, 100: 1}  # factor of duration, and number of runs
TIMES = {1: 5, 4: 2, 8: 1}  # repetitions of the plan, and number of runs
BAR = 2.0  # s, for the first campaign
MANOEUVRES = len(RESTS) + len(TURNS)
HEADS = (
    "campaign",
    "samples",
    "blocks",
    "accelerometers\ns",
    "gyros\ns",
    "processor\ns",
    "grows as\nsamples to the",
    "memory\nMB",
    "of it by\nestimation",
)


def measured() -> list[Table]:
    """Campaigns of longer manoeuvres, and of more of them."""
    longer = Table("Cost of the estimation: the same manoeuvres, longer", HEADS)
    best = _fill(longer, [(f"{n} × as long", n, 1, runs) for n, runs in LONGER.items()])
    kept = "kept" if best < BAR else "MISSED"
    longer.remarks.append(f"Bar: the first campaign in {BAR:g} s: {best:.2f} s, {kept}.")
    more = Table("Cost of the estimation: more manoeuvres, each a position of its own", HEADS)
    _fill(more, [(f"{n * MANOEUVRES} manoeuvres", 1, n, runs) for n, runs in TIMES.items()])
    more.remarks.append(REMARK)
    return [longer, more]


def _fill(table: Table, rows: list[tuple[str, int, int, int]]) -> float:
    """One row for each campaign: name, how many times as long, how many times, runs.

    Returns the best time of the first, s.
    """
    before: tuple[float, float] | None = None
    best = []
    for name, longer, times, runs in rows:
        samples, answer = _solved(longer, times, runs)
        stages = [Seconds(answer["seconds"][s], answer["cpu"][s]) for s in answer["seconds"]]
        cpu = sum(min(stage.cpu) for stage in stages)
        growth = log(cpu / before[1]) / log(samples / before[0]) if before else None
        table.add(
            name,
            f"{samples:,.0f}",
            f"{answer['blocks']:,}",
            *(stage.cells()[0] for stage in stages),
            digits(cpu),
            "" if growth is None else f"{growth:.2f}",
            digits(answer["memory"] / 1e6),
            digits((answer["memory"] - answer["memory_before"]) / 1e6),
        )
        best.append(sum(stage.best for stage in stages))
        before = samples, cpu
    return best[0]


def _solved(longer: int, times: int, runs: int) -> tuple[float, Answer]:
    """The samples that a campaign would have at 200 Hz, and the cost of its estimation."""
    with TemporaryDirectory() as folder:
        raw, derived = Path(folder) / "raw" / "bench", Path(folder) / "derived" / "bench"
        recording = performed(document(1, longer=longer, times=times, rate=SAMPLED))
        laboratory.write(recording, raw)
        samples = sum(len(log.time) for log in recording.truth.values()) * RATE / SAMPLED
        del recording
        chain.run(raw, derived, "noise")
        return samples, in_own("solving", derived, str(runs))
