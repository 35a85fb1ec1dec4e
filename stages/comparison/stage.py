"""What should agree: rests and turns, both ways of turning, methods, rates."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.differences import Difference, table_of
from inertial.campaign.gyroscope_methods import upright_positions
from inertial.campaign.rate_segments import angles_about
from inertial.campaign.records import Row, rows_of, with_mount
from inertial.campaign.solution import scatter_by_mount
from inertial.estimation.consistency import outliers
from inertial.estimation.gyroscope_formulas import both_ways, paired, two_positions
from inertial.estimation.gyroscope_observations import Earth, SteadyRate, WholeTurn
from inertial.estimation.gyroscopes import bias_and_scale
from inertial.estimation.rate_table import columns_of, nonlinearities, own_axis
from inertial.tables import AXES
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from stages.comparison.declared import DECLARED

# ---- What should agree: the methods of a stage, and the gyros in rate segments and at rest.

# ---- What the methods of a stage found: the joint fit against the formulas of the sources.

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
    """Every parameter that both `method` and the joint fit have determined.

    The two use the same data, so their errors are correlated. Of all unbiased estimates the joint
    one has the smallest variance; then the variance of the difference is the difference of the
    variances, σ² = σ₁² − σ₂² (Hausman 1978). Where the joint fit has the larger variance of
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
            between=(WORDS[method], _("the joint fit")),
            place=method,
            remark=(
                _(
                    "{words} and the joint fit are not independent: they use the same data "
                    "with the same sigma",
                    words=WORDS[method],
                )
                if alike
                else ""
            ),
        )


def _smaller_somewhere(results: Results, method: str) -> bool:
    """Whether a method has a clearly smaller sigma of any parameter than the joint fit."""
    pairs = (
        (results.determined(method, name), results.determined("joint", name))
        for name in results.names(method)
    )
    return any(
        other["sigma"] < (1 - MIN_SIGMA_DIFFERENCE) * joint["sigma"]
        for other, joint in pairs
        if other is not None and joint is not None
    )


# ---- Gyros in static positions against rate segments, forward against backward.

# --- Rotation forward against backward about the same axis ---

FORWARD_AGAINST_BACKWARD = "forward_against_backward"
Pair = tuple[tuple[str, WholeTurn], tuple[str, WholeTurn]]


def forward_against_backward(
    data: CampaignData, gyro: Results, scatter: float
) -> Iterator[Difference]:
    """The scale factor by each direction alone, pair by pair, the joint bias taken out."""
    for i, axis in enumerate(AXES):
        bias = gyro.determined("joint", f"bias_{axis}")
        pairs = _pairs(angles_about(data, i))
        if bias is None:
            continue
        for (forward_name, forward), (backward_name, backward) in pairs:
            scale_factors = both_ways(
                forward, backward, bias["value"], bias["sigma"], data.earth, scatter
            )
            yield Difference(
                kind=FORWARD_AGAINST_BACKWARD,
                mount=data.mount,
                stage="gyroscope",
                quantity=f"scale_{axis}",
                unit="1",
                first=forward_name,
                second=backward_name,
                first_value=scale_factors.forward,
                second_value=scale_factors.backward,
                sigma=scale_factors.sigma,
                between=(forward_name, backward_name),
                place=f"{forward_name},{backward_name}" if len(pairs) > 1 else "",
            )


def _pairs(turns: list[tuple[str, WholeTurn]]) -> list[Pair]:
    """Forward turns, each with a backward one of the same angle, the same end of the axis up."""
    pairs: list[Pair] = []
    for up in (1, -1):
        same_end = [(name, turn) for name, turn in turns if turn.up * up > 0]
        forward, backward = ([t for t in same_end if t[1].angle * way > 0] for way in (1, -1))
        pairs += paired(forward, backward, lambda a, b: abs(a[1].angle + b[1].angle) < 1e-9)
    return pairs


# --- Static positions against rate segments: S0, tables 5-2 and 5-7 ---

STATIC_AGAINST_TURNS = "static_against_turns"
UNKNOWN_CROSS = 0.01  # rad, half a degree: assumed for a cross term that is not determined


def static_against_turns(data: CampaignData, gyro: Results) -> Iterator[Difference]:
    """Bias and scale factor of each axis from its rests up and down, and from its turns.

    Both sigmas are of noise and of what is known of table and site. The scatter between
    manoeuvres that the joint fit may allow for is left out: it represents unmodelled
    effects, which are compared here.
    """
    for i, axis in enumerate(AXES):
        rests = list(upright_positions(data.gyro_inputs, i))
        static = two_positions(
            [rest for _unused, rest in rests], _cross(gyro, axis), data.earth, data.position_sigma
        )
        if static is None or gyro.determined("turns", f"bias_{axis}") is None:
            continue
        turns = bias_and_scale([turn for _unused, turn in angles_about(data, i)], data.earth)
        estimates = {
            "bias": (static.bias, static.bias_sigma, 0, "rad/s"),
            "scale": (static.scale, static.scale_sigma, 1, "1"),
        }
        for name, (value, sigma, column, unit) in estimates.items():
            if value is None or sigma is None:
                continue
            yield Difference(
                kind=STATIC_AGAINST_TURNS,
                mount=data.mount,
                stage="gyroscope",
                quantity=f"{name}_{axis}",
                unit=unit,
                first=_(
                    "rests with {axis} up and {axis} down: {join}",
                    axis=axis,
                    join=", ".join((n for n, _unused in rests)),
                ),
                second=gyro.id("turns", f"{name}_{axis}"),
                first_value=value,
                second_value=float(turns.values[column]),
                sigma=float(np.hypot(sigma, turns.sigma[column])),
                between=(_("rests"), _("turns")),
            )


def _cross(gyro: Results, axis: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """Cross terms of a gyro to rates along x, y, z, 0 for its own axis, (3,)."""
    rows = [gyro.of("joint", f"cross_{axis}{other}") for other in AXES]
    values = [
        UNKNOWN_CROSS if row is None or row["value"] is None else row["value"] for row in rows
    ]
    return np.where([other == axis for other in AXES], 0.0, np.array(values, dtype=np.float64))


# ---- The gyros on a rate table against straight lines: S4's runs at many rates.

KIND = "straight_line"
MAX_OUTLIER_P = 0.05  # chance below which a run, after Bonferroni, is left out
FORMS = {"cubic": "s²/rad²", "asymmetry": "1"}


def straight_line(
    runs: Sequence[SteadyRate], earth: Earth, scatter: Sequence[float]
) -> Iterator[Difference]:
    """Whether what the gyros read goes with the rate alone; the runs of all mounts at once.

    The noise is that of the residuals; `scatter`, rad/s, between the runs of each mount, serves
    for their weights only. Runs that do not belong to the others are left out. One form
    for all gyros may be the table's as well as the gyros'. Where no mount recorded another gyro
    than the one that turned, it is also all that "installation errors" can be made of: S4's least
    squares, its inputs in another order, turns the bend into cross terms.
    """
    data = own_axis(runs, earth, float(np.sqrt(np.mean(np.square(scatter)))))
    if not len(data.rate):
        return
    bent = np.hstack([data.straight, columns_of(data)["cubic"]])
    outlying = [one.row for one in outliers(bent, data.mean, data.sigma, MAX_OUTLIER_P)]
    tests = nonlinearities(data.less(outlying))
    left_out = ", ".join(runs[data.run[row]].position.name for row in outlying)
    for form, unit in FORMS.items():
        if form in tests:
            test = tests[form]
            yield Difference(
                kind=KIND,
                stage="gyroscope",
                quantity=form,
                unit=unit,
                first=_("{rate} steady runs", rate=len(data.rate) - len(outlying)),
                second=_("a scale factor and a bias for each gyro"),
                first_value=float(test.values[0]),
                second_value=0.0,
                sigma=float(test.sigma[0]),
                degrees=test.degrees,
                between=(_("the steady runs"), _("straight lines")),
                remark=_(
                    "Left out, for they do not belong to the others: {left_out}", left_out=left_out
                )
                if outlying
                else "",
            )


# ---- The stage.


def comparison(
    mounts: Sequence[CampaignData],
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    *,
    level: float,
) -> Tables:
    """Every difference in units of its sigma, with the verdict in a sentence.

    They are evidence for the diagnosis: the result that counts is not known yet.
    """
    scatter = scatter_by_mount(gyroscope_fit)

    def of_mount(data: CampaignData) -> Iterator[Difference]:
        gyro = Results("gyroscope", gyroscope_parameters, data.mount)
        accelerometer = Results("accelerometer", accelerometer_parameters, data.mount)
        yield from static_against_turns(data, gyro)
        between = scatter.get(data.mount, 0.0)
        yield from forward_against_backward(data, gyro, between)
        for method in ("six_position", "pooled_positions"):
            yield from method_against_method(accelerometer, method)
        for method in ("turns", "turn_and_stop", "stops", "rate_table"):
            yield from method_against_method(gyro, method)

    differences = [difference for data in mounts for difference in of_mount(data)]
    differences += straight_line(
        [run for data in mounts for run in data.gyro_inputs.steady_rates],
        mounts[0].earth,
        [scatter.get(data.mount, 0.0) for data in mounts],
    )
    return {"differences": table_of(differences, level)}


STAGE = Stage(comparison, DECLARED, gathers=MOUNTS)
