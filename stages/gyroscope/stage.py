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
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from stages.gyroscope.declared import DECLARED
from stages.gyroscope.free_positions import add_free_gyros
from stages.gyroscope.stated_heading import without_wrong_heading

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
    """Parameters of the joint estimate and of the sources' formulas, with covariance.

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
