"""The result that counts against what others published of the same IMU."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from inertial.campaign.differences import Difference
from inertial.campaign.measurement import Measurement
from inertial.campaign.records import Row, rows_of
from inertial.text.messages import _
from inertial.text.parameters import STAGES

PUBLISHED = "published"
RATE_TABLE = "rate_table"


def against_published(
    published: pd.DataFrame, result: Measurement, mount: str, gyro_methods: Sequence[Row]
) -> Iterator[Difference]:
    """Every published parameter; the sigma is of both, of ours alone where none is published.

    `gyro_methods`: the parameters of the gyros by all methods, on this mount.
    """
    of_table = {r["parameter"]: r["reason"] for r in gyro_methods if r["method"] == RATE_TABLE}
    sensors = {"accel": result.accelerometer, "gyro": result.gyro}
    for row in rows_of(published):
        name, alone = row["quantity"], row["sigma"] is None
        ours = sensors[row["sensor"]].rows.get(name)
        value = None if ours is None else ours["value"]
        reason = ours["reason"] if ours else _("nothing was recorded that shows it")
        if row["sensor"] == "gyro" and of_table.get(name):  # with the rank of what was put in
            reason = of_table[name]
        yield Difference(
            kind=PUBLISHED,
            mount=mount,
            stage=STAGES[row["sensor"]],
            quantity=name,
            unit=row["unit"],
            first=ours["id"] if ours else _("the final result"),
            second=row["source"],
            first_value=value,
            second_value=row["value"],
            sigma=(
                None
                if ours is None or value is None
                else float(np.hypot(ours["sigma"], 0.0 if alone else row["sigma"]))
            ),
            between=(
                _("this calibration"),
                _("the published value ({source})", source=row["source"]),
            ),
            remark=(
                _(
                    "it has no value here, so {source} cannot be judged: {reason}",
                    source=row["source"],
                    reason=reason,
                )
                if value is None
                else _("No sigma is published, so it is ours alone")
                if alone
                else ""
            ),
        )
