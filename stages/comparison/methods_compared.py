"""The joint estimate against the formulas of the sources, from the same data."""

from collections.abc import Iterator

from inertial.campaign.differences import Difference
from inertial.text.messages import _
from stages.comparison.results import Results

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
            between=(WORDS[method], _("the joint estimate")),
            place=method,
            remark=(
                _(
                    "{words} and the joint estimate are not independent: they use the same data "
                    "with the same sigma",
                    words=WORDS[method],
                )
                if alike
                else ""
            ),
        )
