"""The stage `decode` on one log: text to Parquet, checksums verified, every byte accounted for.

python -m benchmarks.own.decoding <campaign.yaml> <log> <folder for the tables>
"""

import sys
from pathlib import Path

import pyarrow.parquet as pq

from benchmarks.answering import answer
from benchmarks.timing import timed
from stages.decode import STAGE as DECODE
from stages.plan import STAGE as PLAN

INSTRUMENTS = Path(__file__).parents[2] / "data" / "instruments.yaml"


def main(campaign: str, log: str, folder: str) -> None:
    """Answer with the number of records and the seconds that the stage took."""
    made, raw = Path(folder), [Path(log)]
    files = {"campaign": [Path(campaign)], "raw": raw, "instruments": [INSTRUMENTS]}
    PLAN.run({}, {name: files.get(name, []) for name in PLAN.files}, made / "plan", {})
    logs = {"logs": made / "plan" / "logs.parquet"}
    seconds = timed(lambda: DECODE.run(logs, {"raw": raw}, made / "decode", {}), 1)
    records = pq.read_metadata(made / "decode" / "samples.parquet").num_rows
    answer(records=records, seconds=seconds.runs, cpu=seconds.cpu)


main(*sys.argv[1:])
