"""The profile for Slurm on a real one: nothing is lost where a node dies or memory is short."""

import os
from pathlib import Path

import pytest
from on_slurm import through_slurm
from slurm import missing

GOALS = [
    f"data/derived/{{campaign}}/{of}/parameters.parquet" for of in ("accelerometer", "gyroscope")
]


@pytest.mark.slow
@pytest.mark.skipif(bool(missing()), reason=f"needs Debian's slurm-wlm and munge: {missing()}")
@pytest.mark.skipif(os.geteuid() != 0, reason="slurmd and munged run as root here")
def test_a_dead_node_and_a_job_over_its_memory_lose_nothing(tmp_path: Path) -> None:
    outcome = through_slurm(tmp_path, campaigns=2, goals=GOALS, compared=1, patience=500)
    said = [(tmp_path / run / "said.txt").read_text()[-3000:] for run in ("many", "one")]
    assert outcome.lossless, (outcome, *said)
    assert outcome.lost_processes > 3  # the daemon, and what it ran
    assert outcome.requeued == 1
    assert outcome.over_memory == 1
    # One job of Slurm for each campaign, whatever its stages.
    assert said[0].count("submitted with SLURM jobid") == 2
    assert set(outcome.benchmarks["stage"]) == {
        *("plan", "decode", "quality", "segment", "noise", "accelerometer", "gyroscope")
    }
