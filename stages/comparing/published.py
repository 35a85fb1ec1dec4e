"""What others published of this IMU against the joint estimate."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from stages.comparing.difference import Difference
from stages.comparing.results import Results
from stages.contracts.records import rows_of

KIND = "published"


def against_published(
    published: pd.DataFrame, results: Mapping[str, Results]
) -> Iterator[Difference]:
    """Every published parameter, with the results of accelerometer and gyroscope by stage.

    The sigma is of both; of ours alone where none is published.
    """
    for told in rows_of(published):
        stage, _, name = told["parameter"].partition("/")
        own = results[stage]
        ours = own.of("joint", name)
        missing = ours is None or ours["value"] is None
        reason = ours["reason"] if ours else "nothing was recorded that shows it"
        table = own.of("rate_table", name)
        if table is not None and table["reason"]:  # with the rank of what was put in
            reason = table["reason"]
        alone = told["sigma"] is None
        yield Difference(
            kind=f"{KIND}{own.suffix}",
            parameter=told["parameter"],
            unit=told["unit"],
            first=f"{stage}/joint{own.suffix}/{name}",
            second=told["source"],
            first_value=None if ours is None else ours["value"],
            second_value=told["value"],
            sigma=(
                None
                if ours is None or missing
                else float(np.hypot(ours["sigma"], 0.0 if alone else told["sigma"]))
            ),
            between=("this calibration", f"the published value ({told['source']})"),
            remark=(
                f"it is not determined here, so {told['source']} cannot be judged: {reason}"
                if missing
                else "No sigma is published, so it is ours alone"
                if alone
                else ""
            ),
        )
