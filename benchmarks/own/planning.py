"""The stage `plan` of one campaign, in a process of its own: its memory counts for no later stage.

python -m benchmarks.own.planning <campaign.yaml> <log> <folder of derived tables>
"""

import sys
from pathlib import Path

from benchmarks.answering import answer
from stages.plan.stage import STAGE as PLAN

INSTRUMENTS = Path(__file__).parents[2] / "data" / "instruments.yaml"


def main(campaign: str, log: str, derived: str) -> None:
    """Write the tables of the stage; answer with the memory alone."""
    files = {"campaign": [Path(campaign)], "raw": [Path(log)], "instruments": [INSTRUMENTS]}
    PLAN.run(Path(derived), {name: files.get(name, []) for name in PLAN.declared.files}, {})
    answer()


main(*sys.argv[1:])
