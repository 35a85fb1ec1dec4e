"""The joint estimate against the formulas of the sources, and against published values."""

from collections.abc import Iterator, Mapping

import numpy as np
import pandas as pd

from inertial.campaign.records import rows_of
from inertial.text.messages import _
from inertial.text.parameters import STAGES
from stages.comparison.difference import Difference, Results

# --- The joint estimate against the formulas of the sources, from the same data ---

METHOD_AGAINST_METHOD = "method_against_method"
MIN_SIGMA_DIFFERENCE = 0.01  # relative difference of two sigmas below which two methods are one
WORDS = {
    "six_position": _("the six-position formula"),
    "pooled_positions": _("the formula for pooled positions"),
    "turns": _("the formula for turns"),
    "turn_and_stop": _("the turn-and-stop formulas"),
    "stops": _("the mean of the stops"),
    "rate_table": _("the least squares of the rate table"),
}


def method_against_method(results: Results, method: str) -> Iterator[Difference]:
    """Every parameter that both `method` and the joint estimate have determined.

    The two use the same data, so their errors are correlated. Of all unbiased estimates the joint
    one has the smallest variance; then the variance of the difference is the difference of the
    variances, σ² = |σ₁² − σ₂²| (Hausman 1978).
    """
    for name in results.names(method):
        other, joint = results.of(method, name), results.determined("joint", name)
        if other is None or joint is None:
            continue
        alike = abs(other["sigma"] / joint["sigma"] - 1) < MIN_SIGMA_DIFFERENCE
        sigma = abs(other["sigma"] ** 2 - joint["sigma"] ** 2) ** 0.5
        yield Difference(
            kind=METHOD_AGAINST_METHOD,
            mount=results.mount,
            stage=results.stage,
            quantity=name,
            unit=joint["unit"],
            first=other["id"],
            second=joint["id"],
            first_value=other["value"],
            second_value=joint["value"],
            sigma=None if alike else sigma,
            between=(WORDS[method], "the joint estimate"),
            place=method,
            remark=(
                _(
                    "{words} and the joint estimate use the same data with the same sigma: there "
                    "is nothing to compare",
                    words=WORDS[method],
                )
                if alike
                else _("Both are from the same data, so their variances are subtracted")
            ),
        )


# --- The joint estimate against published values ---

PUBLISHED = "published"


def against_published(
    published: pd.DataFrame, results: Mapping[str, Results]
) -> Iterator[Difference]:
    """Every published parameter, with the results of accelerometer and gyroscope by stage.

    The sigma is of both; of ours alone where none is published.
    """
    for row in rows_of(published):
        stage, name = STAGES[row["sensor"]], row["quantity"]
        of_mount = results[stage]
        joint_row = of_mount.of("joint", name)
        missing = joint_row is None or joint_row["value"] is None
        reason = joint_row["reason"] if joint_row else _("nothing was recorded that shows it")
        table = of_mount.of("rate_table", name)
        if table is not None and table["reason"]:  # with the rank of what was put in
            reason = table["reason"]
        alone = row["sigma"] is None
        yield Difference(
            kind=PUBLISHED,
            mount=of_mount.mount,
            stage=stage,
            quantity=name,
            unit=row["unit"],
            first=of_mount.id("joint", name),
            second=row["source"],
            first_value=None if joint_row is None else joint_row["value"],
            second_value=row["value"],
            sigma=(
                None
                if joint_row is None or missing
                else float(np.hypot(joint_row["sigma"], 0.0 if alone else row["sigma"]))
            ),
            between=("this calibration", _("the published value ({source})", source=row["source"])),
            remark=(
                _(
                    "it is not determined here, so {source} cannot be judged: {reason}",
                    source=row["source"],
                    reason=reason,
                )
                if missing
                else _("No sigma is published, so it is ours alone")
                if alone
                else ""
            ),
        )
