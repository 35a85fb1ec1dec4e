"""The profile for Slurm on a real one: nothing is lost where a node dies or memory is short."""

import os
import re
import sys
from pathlib import Path

import pytest
from on_slurm import through_slurm
from slurm import missing

CAMPAIGNS = int(os.environ.get("CLUSTER_CAMPAIGNS", "2"))
PATIENCE, PATIENCE_EACH = 400, 60  # s
GOALS = [
    f"data/derived/{{campaign}}/{of}/parameters.parquet" for of in ("accelerometer", "gyroscope")
]


@pytest.mark.slow
@pytest.mark.skipif(bool(missing()), reason=f"needs Debian's slurm-wlm and munge: {missing()}")
@pytest.mark.skipif(os.geteuid() != 0, reason="slurmd and munged run as root here")
def test_a_dead_node_and_a_job_over_its_memory_lose_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    patience = PATIENCE + PATIENCE_EACH * CAMPAIGNS
    compared = max(CAMPAIGNS // 4, 1)
    outcome = through_slurm(tmp_path, CAMPAIGNS, GOALS, compared, patience)
    said = [(tmp_path / run / "said.txt").read_text() for run in ("many", "one")]
    jobs = [len(re.findall("submitted with SLURM jobid", text)) for text in said]
    with capsys.disabled():
        sys.stdout.write(
            f"\n{outcome.campaigns} campaigns in {outcome.seconds:.0f} s, {sum(jobs)} jobs; begun"
            f" again: {outcome.requeued} by the dead node, {outcome.over_memory} by its memory; the"
            f" controller crashed {outcome.restarts} times\n"
        )
    assert outcome.lossless, (outcome, *(text[-3000:] for text in said))
    assert outcome.lost_processes > 3  # the daemon, and what it ran
    assert outcome.requeued == 1
    assert outcome.over_memory == 1
    # One job of Slurm for each campaign, whatever its stages.
    assert CAMPAIGNS <= jobs[0] <= CAMPAIGNS + outcome.restarts
    assert jobs[1] == 2  # the second with more memory
    assert set(outcome.benchmarks["stage"]) == {
        *("plan", "decode", "quality", "segment", "noise", "accelerometer", "gyroscope")
    }
