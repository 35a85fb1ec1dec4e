"""`make cluster-test`: campaigns through a Slurm on this machine, and docs/scale.md.

    PYTHONPATH=tests:tests/cluster python -m cluster [<campaigns>]

All it starts ends with it. SCALE_PLANNED sets the numbers of campaigns that are only planned.
"""

import os
import signal
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from types import FrameType

sys.path.insert(0, str(Path(__file__).parent))

from on_slurm import benchmarks, local, through_slurm
from scale_page import Long, write
from slurm import missing

from benchmarks.dry_run import planned
from benchmarks.long_campaign import record

GOALS = ("reports/{campaign}.html", "reports/{campaign}.calibration.json")
SAMPLES = 1_000_000  # of the long campaign
SECONDS = 600.0  # until a run has ended, and for each campaign as much as
SECONDS_EACH = 150.0


def main(campaigns: int) -> None:
    """Run, and write the page."""
    if missing():
        sys.exit(
            f"cluster-test: not installed: {', '.join(missing())}; on Debian:"
            " apt-get install slurm-wlm munge"
        )
    sizes = [int(size) for size in os.environ.get("SCALE_PLANNED", "100 1000").split()]
    with TemporaryDirectory() as name:
        folder = Path(name)
        patience = SECONDS + SECONDS_EACH * campaigns
        outcome = through_slurm(folder, campaigns, GOALS, min(2, campaigns), patience)
        samples, size = record(folder / "long/data/raw/long", SAMPLES)
        done = local(folder / "long", "--", *(goal.format(campaign="long") for goal in GOALS))
        if done.returncode:
            sys.exit(done.stderr)
        long = Long(samples, size / 1e6, benchmarks(folder / "long"), folder / "long")
        short = Long.of(folder / "beside", "c000")
        plans = {size: planned(size) for size in sizes}
        sys.stdout.write(write(outcome, short, long, plans))
    sys.exit(0 if outcome.lossless else 1)


def _end(number: int, frame: FrameType | None) -> None:
    sys.exit(128 + number)  # what is to be stopped is stopped on the way out


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, _end)
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 40)
