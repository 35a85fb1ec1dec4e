"""The gyros by the formulas of the sources, for comparison with the joint fit.

`static`: S0 (3-13), (3-14), rests with the axis up and down. `turns`: S0 (3-9), (3-10), turns of a
known angle. `turn_and_stop` and `stops`: S3 (13) to (15), M from turns both ways, the bias by turns
and by rests. `rate_table`: S4's least squares of steady runs. All have sigmas, which the
sources do not state.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import NAMES, Estimates, Wanted
from inertial.campaign.rate_segments import GyroInputs, angles_about, position_of
from inertial.estimation import gyroscopes
from inertial.estimation.gyroscope_formulas import (
    CROSS_SIGMA,
    Solution,
    Upright,
    turn_and_stop,
    two_positions,
)
from inertial.estimation.rate_table import rate_table
from inertial.estimation.scatter_and_random_walk import ScatterFit
from inertial.estimation.triad import errors_of
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import BIAS

NO_TURNS = _(
    "no readings, recorded and not masked, of turns about {axis} both ways over the same known "
    "angle: add such turns"
)
MIN_SIGMA = 1e-15  # rad/s, in place of zero
NOT_RECORDED = _("the {axis} gyro is not recorded in these manoeuvres, or masked there")


def add_formulas(
    estimates: Estimates, data: CampaignData, joint: ScatterFit, wanted: float
) -> None:
    """The rows of every formula that the plan allows, with the scatter of the joint fit.

    `wanted`: rad/s, required sigma of a bias, from which the length of the rests follows.
    """
    inputs = data.gyro_inputs
    scatter, determined = joint.scatter, joint.estimate.determined[:9]
    cross = np.where(determined, joint.estimate.values[:9], CROSS_SIGMA).reshape(3, 3)
    _add_static(estimates, inputs, cross, (scatter, wanted))
    _add_known_angle(estimates, data, scatter)
    runs = rate_table(inputs.steady_rates, inputs.earth, inputs.position_sigma, scatter)
    if runs is not None:
        _add_solution(estimates, "rate_table", runs.solution, runs.refusals())


def upright_positions(inputs: GyroInputs, i: int) -> Iterator[tuple[str, Upright]]:
    """The static positions of the plan with body axis i up or down, each with its name."""
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
    sigma_limits: tuple[float, float],  # between manoeuvres, and wanted of a bias, rad/s
) -> None:
    scatter, wanted = sigma_limits
    seconds = [s.seconds.sum() for s in inputs.static_positions if s.manoeuvre.do == "rest"]
    for i, axis in enumerate(AXES):
        upright = [rest for _unused, rest in upright_positions(inputs, i)]
        rests = [replace(rest, sigma=float(np.hypot(rest.sigma, scatter))) for rest in upright]
        about = (cross[i] * (np.arange(3) != i), inputs.earth, inputs.position_sigma)
        result = two_positions(rests, *about)
        if result is None:
            continue
        names, values = (f"bias_{axis}", f"scale_{axis}"), [result.bias, result.scale or 0.0]
        sigmas = np.array([result.bias_sigma, result.scale_sigma or 0.0])
        reason = _("the upward earth rate is not known well enough to be an input")
        reasons = {names[1]: reason} if result.scale is None else {}
        estimates.add("static", names, np.array(values), np.diag(sigmas**2), reasons)
        ideal = two_positions(
            [replace(rest, sigma=max(scatter, MIN_SIGMA)) for rest in rests], *about
        )
        if ideal is not None:
            required = Wanted(result.bias_sigma, ideal.bias_sigma, float(np.mean(seconds)))
            estimates.add_wanted("static", axis, required, wanted)


def _add_known_angle(estimates: Estimates, data: CampaignData, scatter: float) -> None:
    """Axis by axis; whole rotations in both directions about the vertical axis are needed."""
    method, inputs = "turns", data.gyro_inputs
    for i, axis in enumerate(AXES):
        whole = [r for r in inputs.recorded if r.plan.recorded == "whole"]
        about_axis = [r for r in whole if abs(r.plan.axis[i]) > 1 - 1e-9]
        turns = [angle for _unused, angle in angles_about(data, i)]
        names = (f"bias_{axis}", f"scale_{axis}")
        if len({np.sign(turn.angle) for turn in turns}) == 2:
            estimate = gyroscopes.bias_and_scale(turns, inputs.earth, scatter)
            estimates.add(method, names, estimate.values[:2], estimate.covariance[:2, :2], {})
        elif about_axis:
            reason = _("the formula needs whole turns about {axis} forward and backward", axis=axis)
            refused = [r.plan.name for r in about_axis if r.refusal or not r.done.complete]
            reason += _("; not whole: {refused}", refused=", ".join(refused)) if refused else ""
            nothing = (np.zeros(2), np.zeros((2, 2)))
            estimates.add(method, names, *nothing, dict.fromkeys(names, reason))


def add_turn_and_stop(estimates: Estimates, inputs: GyroInputs, scatter: float) -> None:
    """S3's formulas, for plans with rotations both ways and stops at common positions."""
    inputs = inputs.of_known_attitude
    result = turn_and_stop(
        inputs.turns, inputs.static_rates, inputs.earth, inputs.position_sigma, scatter
    )
    if not result.pairs or result.by_turns is None:
        return
    _add_solution(estimates, "turn_and_stop", result.by_turns, _reasons(result.by_turns))
    if result.by_rests is not None:
        bias = slice(NAMES.index(BIAS[0]), None)
        values, covariance = result.by_rests.values[bias], result.by_rests.covariance[bias, bias]
        missing = zip(BIAS, result.by_rests.determined[bias], strict=True)
        reasons = {
            name: NOT_RECORDED.format(axis=name[-1])
            for name, is_determined in missing
            if not is_determined
        }
        estimates.add("stops", BIAS, values, covariance, reasons)


def _reasons(solution: Solution) -> dict[str, str]:
    """Why S3's formulas do not determine a parameter, by its name."""
    reasons = {}
    for name, is_determined in zip(NAMES, solution.determined, strict=True):
        if not is_determined:
            words = NOT_RECORDED if name in BIAS else NO_TURNS
            reasons[name] = words.format(axis=name[-1])
    return reasons


def _add_solution(
    estimates: Estimates, method: str, solution: Solution, reasons: dict[str, str]
) -> None:
    estimates.add(method, NAMES, errors_of(solution.values), solution.covariance, reasons)
