"""The gyros by the sources' own formulas, beside the joint estimate: rows, and why there are none.

`static`: S0 (3-13), (3-14), rests with the axis up and down. `turns`: S0 (3-9), (3-10), turns of a
known angle. `turn_and_stop` and `stops`: S3 (13) to (15), M from turns both ways, the bias by turns
and by rests. `rate_table`: S4's least squares of steady runs. All have the sigmas that the sources
leave out.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import NAMES, Estimates, Wanted
from inertial.campaign.rate_segments import GyroInputs, angles_about, position_of
from inertial.estimation import gyroscopes
from inertial.estimation.gyroscope_formulas import Solution, Upright, two_positions
from inertial.estimation.rate_table import rate_table
from inertial.estimation.triad import BIAS, errors_of
from inertial.estimation.turn_and_stop import CROSS_SIGMA, turn_and_stop
from inertial.estimation.variance_components import ScatterFit
from inertial.tables import AXES
from inertial.text.messages import _

Array = NDArray[np.float64]

NO_TURNS = _("no axis {axis} was turned about both ways over the same known angle: add such turns")
MIN_SIGMA = 1e-15  # rad/s, a sigma as good as none
NOT_RECORDED = "the {axis} gyro is not recorded"


def add_formulas(
    estimates: Estimates, data: CampaignData, joint: ScatterFit, wanted: float
) -> None:
    """The rows of every formula that the plan feeds, with the scatter of the joint estimate.

    `wanted`: rad/s, sigma of a bias for which the length of the rests is reckoned.
    """
    inputs = data.gyro_inputs
    scatter, told = joint.scatter, joint.estimate.determined[:9]
    cross = np.where(told, joint.estimate.values[:9], CROSS_SIGMA).reshape(3, 3)
    _add_static(estimates, inputs, cross, (scatter, wanted))
    _add_known_angle(estimates, data, scatter)
    found = rate_table(inputs.steady_rates, inputs.earth, inputs.position_sigma, scatter)
    if found is not None:
        _add(estimates, "rate_table", found.solution, found.refusals())


def uprights(inputs: GyroInputs, i: int) -> Iterator[tuple[str, Upright]]:
    """The rests of the plan with body axis i up or down, each with its name."""
    for position in inputs.static_positions:
        up = float(position.up_now[i])
        mean, sigma = position.over()
        if (
            position.manoeuvre.do == "rest"
            and abs(up) > 1 - 1e-9
            and np.isfinite(mean[i] * sigma[i])
        ):
            set_position = position_of(position.manoeuvre, inputs.heading)
            yield (
                position.manoeuvre.name,
                Upright(set_position, up, float(mean[i]), float(sigma[i])),
            )


def _add_static(
    estimates: Estimates,
    inputs: GyroInputs,
    cross: Array,
    sigmas_of: tuple[float, float],  # between manoeuvres, and wanted of a bias, rad/s
) -> None:
    scatter, wanted = sigmas_of
    seconds = [s.seconds.sum() for s in inputs.static_positions if s.manoeuvre.do == "rest"]
    for i, axis in enumerate(AXES):
        read = [rest for _unused, rest in uprights(inputs, i)]
        rests = [replace(rest, sigma=float(np.hypot(rest.sigma, scatter))) for rest in read]
        about = (cross[i] * (np.arange(3) != i), inputs.earth, inputs.position_sigma)
        found = two_positions(rests, *about)
        if found is None:
            continue
        names, values = (f"bias_{axis}", f"scale_{axis}"), [found.bias, found.scale or 0.0]
        sigmas = np.array([found.bias_sigma, found.scale_sigma or 0.0])
        reason = _("the upward earth rate is not known well enough to be an input")
        why = {names[1]: reason} if found.scale is None else {}
        estimates.add("static", names, np.array(values), np.diag(sigmas**2), why)
        ideal = two_positions(
            [replace(rest, sigma=max(scatter, MIN_SIGMA)) for rest in rests], *about
        )
        if ideal is not None:
            told = Wanted(found.bias_sigma, ideal.bias_sigma, float(np.mean(seconds)))
            estimates.add_wanted("static", axis, told, wanted)


def _add_known_angle(estimates: Estimates, data: CampaignData, scatter: float) -> None:
    """Axis by axis: it needs whole turns both ways about the axis that is up."""
    method, inputs = "turns", data.gyro_inputs
    for i, axis in enumerate(AXES):
        whole = [r for r in inputs.recorded if r.plan.recorded == "whole"]
        own = [r for r in whole if abs(r.plan.axis[i]) > 1 - 1e-9]
        turns = [angle for _unused, angle in angles_about(data, i)]
        names = (f"bias_{axis}", f"scale_{axis}")
        if len({np.sign(turn.angle) for turn in turns}) == 2:
            estimate = gyroscopes.bias_and_scale(turns, inputs.earth, scatter)
            estimates.add(method, names, estimate.values[:2], estimate.covariance[:2, :2], {})
        elif own:
            reason = _("the formula needs whole turns about {axis} forward and backward", axis=axis)
            refused = [r.plan.name for r in own if r.refusal or not r.done.complete]
            reason += _("; not whole: {refused}", refused=", ".join(refused)) if refused else ""
            nothing = (np.zeros(2), np.zeros((2, 2)))
            estimates.add(method, names, *nothing, dict.fromkeys(names, reason))


def add_turn_and_stop(estimates: Estimates, inputs: GyroInputs, scatter: float) -> None:
    """S3's formulas, for plans that turn both ways and stop at positions in common."""
    found = turn_and_stop(
        inputs.turns, inputs.static_rates, inputs.earth, inputs.position_sigma, scatter
    )
    if not found.pairs or found.by_turns is None:
        return
    _add(estimates, "turn_and_stop", found.by_turns, _untold(found.by_turns))
    if found.by_rests is not None:
        bias = slice(NAMES.index(BIAS[0]), None)
        values, covariance = found.by_rests.values[bias], found.by_rests.covariance[bias, bias]
        missing = zip(BIAS, found.by_rests.determined[bias], strict=True)
        why = {name: NOT_RECORDED.format(axis=name[-1]) for name, there in missing if not there}
        estimates.add("stops", BIAS, values, covariance, why)


def _untold(solution: Solution) -> dict[str, str]:
    """Why S3's formulas leave a parameter open, by its name."""
    why = {}
    for name, there in zip(NAMES, solution.determined, strict=True):
        if not there:
            words = NOT_RECORDED if name in BIAS else NO_TURNS
            why[name] = words.format(axis=name[-1])
    return why


def _add(estimates: Estimates, method: str, solution: Solution, why: dict[str, str]) -> None:
    estimates.add(method, NAMES, errors_of(solution.values), solution.covariance, why)
