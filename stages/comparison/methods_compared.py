"""What the methods of a stage found: the joint estimate against the formulas of the sources."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from inertial.campaign.differences import Difference
from inertial.campaign.records import Row, rows_of, with_mount
from inertial.text.messages import _

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


@dataclass(frozen=True)
class Results:
    """What the methods of one stage found for one mount."""

    stage: str
    parameters: pd.DataFrame
    mount: str

    def id(self, method: str, name: str = "") -> str:
        """The identifier of a parameter, or of all that a method determined."""
        group = f"{self.stage}/{with_mount(method, self.mount)}"
        return f"{group}/{name}" if name else group

    @cached_property
    def _rows(self) -> dict[tuple[str, str], Row]:
        return {
            (row["method"], row["parameter"]): row
            for row in rows_of(self.parameters)
            if row["mount"] == self.mount
        }

    def of(self, method: str, name: str) -> Row | None:
        """The row of a parameter; none where the method does not have it."""
        return self._rows.get((method, name))

    def determined(self, method: str, name: str) -> Row | None:
        """The same; none where it is not determined either."""
        row = self.of(method, name)
        return None if row is None or row["value"] is None else row

    def names(self, method: str) -> Iterator[str]:
        """Names of the parameters that a method determined."""
        for of_method, name in self._rows:
            if of_method == method and self.determined(method, name):
                yield name


def method_against_method(results: Results, method: str) -> Iterator[Difference]:
    """Every parameter that both `method` and the joint estimate have determined.

    The two use the same data, so their errors are correlated. Of all unbiased estimates the joint
    one has the smallest variance; then the variance of the difference is the difference of the
    variances, σ² = σ₁² − σ₂² (Hausman 1978). Where the joint estimate has the larger variance of
    any parameter, it allows for more than the method does, such as a drift between the positions:
    then how they are correlated is not known, and the variances are added.
    """
    efficient = not _smaller_somewhere(results, method)
    for name in results.names(method):
        other, joint = results.of(method, name), results.determined("joint", name)
        if other is None or joint is None:
            continue
        alike = efficient and other["sigma"] < (1 + MIN_SIGMA_DIFFERENCE) * joint["sigma"]
        sign = -1 if efficient else 1
        sigma = max(other["sigma"] ** 2 + sign * joint["sigma"] ** 2, 0.0) ** 0.5
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


def _smaller_somewhere(results: Results, method: str) -> bool:
    """Whether a method has a clearly smaller sigma of any parameter than the joint estimate."""
    pairs = (
        (results.determined(method, name), results.determined("joint", name))
        for name in results.names(method)
    )
    return any(
        other["sigma"] < (1 - MIN_SIGMA_DIFFERENCE) * joint["sigma"]
        for other, joint in pairs
        if other is not None and joint is not None
    )
