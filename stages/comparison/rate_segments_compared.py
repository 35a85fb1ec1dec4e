"""The gyros in rate segments: against static positions, both directions, straight lines."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.differences import Difference
from inertial.campaign.gyroscope_methods import upright_positions
from inertial.campaign.rate_segments import angles_about
from inertial.estimation.consistency import outliers
from inertial.estimation.gyroscope_formulas import both_ways, paired, two_positions
from inertial.estimation.gyroscope_observations import Earth, SteadyRate, WholeTurn
from inertial.estimation.gyroscopes import bias_and_scale
from inertial.estimation.rate_table import columns_of, nonlinearities, own_axis
from inertial.tables import AXES
from inertial.text.messages import _
from stages.comparison.methods_compared import Results

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
    manoeuvres that the joint estimate may allow for is left out: it represents unmodelled
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
