"""The stage `plan` of one campaign, in a process of its own, for its memory is no later stage's.

python -m benchmarks.own.planning <campaign.yaml> <log> <folder for the tables>
"""

import sys
from pathlib import Path

from benchmarks.answering import answer
from stages.plan.stage import STAGE as PLAN

INSTRUMENTS = Path(__file__).parents[2] / "data" / "instruments.yaml"


def main(campaign: str, log: str, folder: str) -> None:
    """Write the tables; answer with nothing."""
    files = {"campaign": [Path(campaign)], "raw": [Path(log)], "instruments": [INSTRUMENTS]}
    PLAN.run({}, {name: files.get(name, []) for name in PLAN.files}, Path(folder), {})
    answer()


main(*sys.argv[1:])
