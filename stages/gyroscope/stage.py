"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""

from collections.abc import Sequence

import numpy as np

from inertial.arrays import Booleans
from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.estimates import Estimates, reasons, stops_between_turns
from inertial.campaign.findings import Finding, table_of
from inertial.campaign.gyroscope_methods import add_formulas, add_turn_and_stop
from inertial.campaign.rate_segments import GyroInputs
from inertial.campaign.recorded_turns import Rotation
from inertial.campaign.records import omissions, with_mount
from inertial.campaign.static_positions import averaging_times
from inertial.estimation import gyroscopes
from inertial.estimation.gyroscope_observations import TABLE
from inertial.estimation.least_squares import Estimate
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant, with_own_sigma
from inertial.text.units import DEGREE
from stages.gyroscope.declared import DECLARED
from stages.gyroscope.free_positions import add_free_gyros

OFF_RATE, OFF_ANGLE = "wrong_rate", "turn_angle_error"
CURES = {
    "bias": _("neither a rest nor a turn there and back shows it: add a rest"),
    "matrix": _(
        "this gyro recorded no whole turn about {axis}, its angle known to a few degrees: add one "
        "of 360° about {axis}"
    ),
}


def gyroscope(
    mounts: Sequence[CampaignData],
    *,
    averaging_steps: int,
    wanted_bias: float,
) -> Tables:
    """Parameters of the joint fit and of the sources' formulas, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    collected = Estimates("gyroscope")
    raised: list[Finding] = []
    for data in mounts:
        data, wrong = without_wrong_heading(data)
        raised += [wrong] if wrong else []
        estimates, inputs = collected.on(data.mount), data.gyro_inputs
        raised += add_free_gyros(estimates, data)
        raised += [_another_turn(r, data.mount) for r in inputs.recorded if r.off_ratio is not None]
        if inputs.is_empty:
            estimates.add_nothing("joint", omissions(inputs.left_out))
            continue
        moving = (inputs.segments, inputs.set_rates, inputs.earth, inputs.position_sigma)
        drift = data.noise.drift("gyro")
        fitted = gyroscopes.fit(inputs.static_rates, *moving, data.noise.degrees, drift)
        why = reasons(fitted.estimate.determined, _channels(inputs), "gyro", CURES)
        estimates.add_triad("joint", fitted.estimate, why)
        estimates.add_fit("joint", fitted, inputs.used, inputs.left_out)
        linear = gyroscopes.linearised(
            gyroscopes.linearisation_at(fitted.estimate, inputs.earth), *moving, None, drift
        )
        for seconds in averaging_times(inputs.static_positions, averaging_steps):
            shorter = linear.system(
                inputs.first_static_rates(seconds), fitted.scatter, fitted.random_walk
            )
            estimates.add_averaging(seconds, shorter.solve_shared())
        add_formulas(estimates, data, fitted, wanted_bias)
        if stops_between_turns(data.plan):
            add_turn_and_stop(estimates, inputs, fitted.scatter)
    return {**collected.tables(), "findings": table_of(raised)}


def _another_turn(turn: Rotation, mount: str) -> Finding:
    assert turn.off_ratio is not None
    steady = turn.plan.recorded == "steady"
    cause, angle = OFF_RATE if steady else OFF_ANGLE, abs(turn.plan.angle or 0.0)
    return Finding(
        id="/".join(("gyroscope", with_mount(cause, mount), turn.plan.name)),
        cause=cause,
        mount=mount,
        sensor="gyro",
        manoeuvre=turn.plan.name,
        size=turn.off_ratio if steady else (turn.off_ratio - 1) * angle,
        unit="1" if steady else "rad",
        severity=1,
        sentence=_("{name}: {why}.", name=turn.plan.name, why=turn.refusal),
        consequence=_("Taken as stated its scale factor would be wrong, so it is left out."),
        action=_what_to_do(turn),
    )


def _what_to_do(turn: Rotation) -> str:
    if turn.plan.recorded == "steady":
        return _("Correct the rate of the plan, or see what the table did.")
    if turn.may_lack:
        return _(
            "If it was the table, correct the angle of the plan; if not, record it again with a "
            "counter or a clock in which lost samples show."
        )
    return _("Correct the angle of the plan, or see what the table did.")


def _channels(inputs: GyroInputs) -> Booleans:
    """Which gyros are in the logs, (3,)."""
    readings = [rest.mean for rest in inputs.static_rates]
    readings += [steady.mean for steady in inputs.steady_rates]
    readings += [turn.sums.sum(axis=0) for turn in inputs.segments]
    return np.asarray(np.isfinite(np.array(readings)).any(axis=0))


STAGE = Stage(gyroscope, DECLARED, gathers=MOUNTS)


# ---- A stated heading that the gyros contradict by far: then they tell the azimuth of the table.
#
# The equations of criticism find a heading that is off by some degrees. With one that is off by
# tens the joint fit they rest on is none: the earth's rate, wrong within every turn, moves all of
# M.

CAUSE = "heading_error"
MIN_ANGLE = 15 * DEGREE  # less criticism finds, beside what else may be wrong
MAX_P_VALUE = 1e-6  # of the fit with the stated heading
MIN_SIGMAS = 10.0
MAX_REST = 1 / 3  # of what the stated heading leaves beyond noise: else more than it is wrong


def without_wrong_heading(data: CampaignData) -> tuple[CampaignData, Finding | None]:
    """The campaign without its stated heading, and a finding, where the gyros contradict it."""
    stated = data.heading
    if stated is None or data.gyro_inputs.is_empty:
        return data, None
    with_stated, free = _joint(data), data.without_heading
    if with_stated.p_value(data.noise.degrees) > MAX_P_VALUE:
        return data, None
    fitted = _joint(free)
    column = {name: i for i, name in enumerate(fitted.names)}
    own = [column[name] for k in (0, 1) if (name := (f"level {k}", TABLE)) in column]
    if not own or not fitted.determined[own].all():
        return data, None
    level = fitted.values[own]
    azimuth = float(np.arctan2(level[1], level[0]))
    # Of known size, so what both are uncertain by is all across.
    sigma = float(np.linalg.norm(fitted.sigma[own]) / np.linalg.norm(level))
    off = float(np.angle(np.exp(1j * (azimuth - stated))))
    left = [max(one.chi_squared - one.degrees, 0.0) for one in (with_stated, fitted)]
    if abs(off) < max(MIN_ANGLE, MIN_SIGMAS * sigma) or left[1] >= MAX_REST * left[0]:
        return data, None
    return free, _finding(data.mount, azimuth % (2 * np.pi), off, sigma)


def _joint(data: CampaignData) -> Estimate:
    """The joint fit with noise alone."""
    inputs = data.gyro_inputs
    moving = (inputs.segments, inputs.set_rates, inputs.earth, inputs.position_sigma)
    return gyroscopes.joint(inputs.static_rates, *moving, measured=data.noise.drift("gyro"))


def _finding(mount: str, azimuth: float, off: float, sigma: float) -> Finding:
    """`azimuth` of the mark, `off` from the stated one, rad."""
    measured = plus_minus(azimuth / DEGREE, sigma / DEGREE)
    return Finding(
        id="/".join(("gyroscope", with_mount(CAUSE, mount), "all")),
        cause=CAUSE,
        mount=mount,
        sensor="gyro",
        size=off,
        unit="rad",
        severity=2,
        sentence=_(
            "By the gyros the azimuth of the table's zero mark is {measured}°, by {off}° another "
            "than the heading that is stated.",
            measured=measured,
            off=significant(abs(off) / DEGREE, 3),
        ),
        consequence=_(
            "With the stated heading the horizontal component of the earth's rate would be taken "
            "off in the wrong direction; so its azimuth is estimated with the parameters."
        ),
        action=_(
            "State table.heading_deg: {azimuth}, or null; or set right the mark of the positions, "
            "if that is what is wrong.",
            azimuth=with_own_sigma(azimuth / DEGREE, sigma / DEGREE)[0],
        ),
    )
