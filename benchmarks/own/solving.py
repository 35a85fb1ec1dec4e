"""The stages `accelerometer` and `gyroscope` on the tables of a campaign: blocks to parameters.

python -m benchmarks.own.solving <folder of the tables> <runs>
"""

import sys
from functools import partial
from pathlib import Path

from benchmarks.answering import answer, memory
from benchmarks.solving import run_again, tables_for
from benchmarks.timing import timed

STAGES = ("accelerometer", "gyroscope")


def main(derived: str, runs: str) -> None:
    """Answer with the seconds by stage, the number of blocks, and the memory before."""
    inputs = {stage: tables_for(Path(derived), stage) for stage in STAGES}
    before = memory()
    times = {stage: timed(partial(run_again, stage, inputs[stage]), int(runs)) for stage in STAGES}
    answer(
        seconds={stage: times[stage].runs for stage in STAGES},
        cpu={stage: times[stage].cpu for stage in STAGES},
        blocks=len(inputs["gyroscope"]["blocks"]),
        memory_before=before,
    )


main(*sys.argv[1:])
