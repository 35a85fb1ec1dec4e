"""The accelerometers from rests and steady turns: bias, M, mounting, with covariance."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from math import degrees

import numpy as np

from inertial.arrays import Array, nearest_axis
from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.estimates import NAMES, Estimates, Wanted, reasons, stops_between_turns
from inertial.campaign.findings import Finding, table_of
from inertial.campaign.records import omissions, with_mount
from inertial.campaign.rotating_positions import LEVER_ARM, turning_rests
from inertial.campaign.static_positions import StaticPosition, averaging_times
from inertial.campaign.unknown_attitude import add_free_accelerometers
from inertial.estimation import accelerometers, triad
from inertial.estimation.accelerometer_formulas import (
    Upright,
    pooled_positions,
    six_position_formula,
    up_and_down,
)
from inertial.estimation.accelerometers import Reference, StaticForce, equations, triad_of, weighted
from inertial.estimation.position_outlier import FarOff, OffPosition, far_off, off_position
from inertial.estimation.random_walk import MeasuredDrift
from inertial.estimation.scatter_and_random_walk import MIN_CONSISTENT_P_VALUE
from inertial.estimation.triad import UNKNOWNS, errors_of
from inertial.physics.forward import Triad
from inertial.tables import AXES
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from inertial.text.numbers import fixed, plus_minus, significant
from inertial.text.parameters import PARTS
from inertial.text.units import quantity
from stages.accelerometer.declared import DECLARED

CURES = {
    "bias": _(
        "the rests do not separate it from the scale factors: turn the IMU over, so that an "
        "axis points up once and down once"
    ),
    "matrix": _(
        "no rests differ enough along {axis}: add one with +{axis} up, one with -{axis} up"
    ),
}
ONE_MORE = _("no rests differ enough along {axis}: add one with {sign}{axis} up")
MIN_UPRIGHT = 0.7  # cosine of an axis to the vertical, which a rest with it up exceeds
NO_REST = _(
    "there is no rest whose upward direction is known, and turns alone are not enough: record one "
    "with each axis up and one with each axis down"
)
OFF = "table_position_error"
MIN_NOTABLE_SIGMA = 1.0  # sigmas of the estimate by which a term must move to be named
WORDS = {
    "bias": _("bias of the {row} accelerometer"),
    "scale": _("scale factor of the {row} accelerometer"),
    "cross": _("response of the {row} accelerometer to force along {column}"),
}


def _cures(ups: Array) -> dict[str, str]:
    """By kind and axis what to record; `ups`: (n, 3), of the rests that there are, body axes."""
    cures = dict(CURES)
    for axis, along in zip(AXES, ups.T, strict=True):
        lacking = [
            sign for sign, most in (("+", along.max()), ("-", -along.min())) if most < MIN_UPRIGHT
        ]
        if len(lacking) == 1:
            cures[f"matrix {axis}"] = ONE_MORE.format(sign=lacking[0], axis=axis)
    return cures


def accelerometer(
    mounts: Sequence[CampaignData],
    *,
    averaging_steps: int,
    wanted_bias: float,
) -> Tables:
    """Parameters of the joint weighted estimate and of S0's and S3's formulas, with covariance.

    Each mount has parameters of its own, for its mounting rotation is one of them.
    """
    collected = Estimates("accelerometer")
    raised: list[Finding] = []
    for data in mounts:
        estimates, reference = collected.on(data.mount), data.reference
        raised += add_free_accelerometers(estimates, data)
        positions, left_out = data.accelerometer_positions
        if not positions:
            estimates.add_nothing("joint", omissions(left_out) or NO_REST)
            continue
        turns = turning_rests(data)
        effect_sigma = LEVER_ARM if turns else None
        moving = [rest for _, rest in turns]
        stops = [position.force() for position in positions]
        rests = [*stops, *moving]
        drift = data.noise.drift("accel")
        off = far_off(rests, reference, effect_sigma, drift)
        reference = reference._replace(free=frozenset(one.position for one in off))
        raised += [_far_off(one, data.mount) for one in off]
        fitted = accelerometers.fit(rests, reference, data.noise.degrees, effect_sigma, drift)
        recorded = np.isfinite(np.array([rest.mean for rest in rests])).any(axis=0)
        ups = np.array([position.up_now for position in positions])
        why = reasons(fitted.estimate.determined, recorded, "accelerometer", _cures(ups))
        estimates.add_triad("joint", fitted.estimate, why)
        used = [position.part for position in positions] + list(
            dict.fromkeys(part for part, _ in turns)
        )
        estimates.add_fit("joint", fitted, used, left_out)
        result = triad_of(fitted.estimate)
        weighed = bool(
            np.all(fitted.estimate.determined[: triad.UNKNOWNS])
        )  # by criticism, against effects
        if not weighed and fitted.p_value < MIN_CONSISTENT_P_VALUE:
            raised += _position_findings(rests, reference, result, effect_sigma, drift, data.mount)
        for seconds in averaging_times(positions, averaging_steps):
            part = [*(position.force(seconds) for position in positions), *moving]
            shorter = equations(
                part, reference, fitted.scatter, result, effect_sigma, fitted.random_walk, drift
            )
            estimates.add_averaging(seconds, shorter.solve_shared())
        planned = [
            pair for pair in zip(positions, stops, strict=True) if pair[0].manoeuvre.do == "rest"
        ]
        add_six_positions(estimates, planned, reference, fitted.scatter, wanted_bias)
        if stops_between_turns(data.plan):
            add_pooled_positions(estimates, stops, reference, fitted.scatter)
    return {**collected.tables(), "findings": table_of(raised)}


def _position_findings(
    rests: list[StaticForce],
    reference: Reference,
    result: Triad,
    effect_sigma: Mapping[str, float] | None,
    drift: MeasuredDrift,
    mount: str,
) -> Iterator[Finding]:
    """The position in error, where a single one explains the misfit of the model.

    Only where the rests do not determine all parameters: else criticism weighs the position against
    every effect of the accelerometers, and what it finds likelier is said once.
    """
    off = off_position(rests, reference, result, effect_sigma, drift)
    if off is not None:
        joint = weighted(rests, reference, effect_sigma=effect_sigma, measured=drift)
        yield _finding(off, joint.sigma[: triad.UNKNOWNS], mount)


def _far_off(off: FarOff, mount: str) -> Finding:
    size = float(np.linalg.norm(off.tilt))
    return Finding(
        id="/".join(("accelerometer", with_mount(OFF, mount), off.position)),
        cause=OFF,
        mount=mount,
        sensor="accel",
        manoeuvre=off.position,
        size=size,
        unit="rad",
        severity=1,
        sentence=_(
            "By the accelerometers the position {name} is off by {size}°, mostly about {axis}; the "
            "others agree.",
            name=off.position,
            size=plus_minus(degrees(size), degrees(off.sigma)),
            axis=AXES[nearest_axis(off.tilt)],
        ),
        consequence=_("As it was planned it would move every parameter of the accelerometers."),
        action=_("Set this position again and record it; or state its attitude as it was."),
    )


def _finding(off: OffPosition, sigma: Array, mount: str) -> Finding:
    """With the affected parameters; `sigma`: (12,), of the parameters without the scatter."""
    several = len(off.positions) > 1
    names = _(" or ").join(off.positions)
    axis = nearest_axis(off.about)
    affected = [
        _change(name, float(off.moved[i]))
        for i, name in enumerate(NAMES)
        if abs(off.moved[i]) > MIN_NOTABLE_SIGMA * sigma[i]
    ]
    size = fixed(degrees(off.tilt), 4)
    return Finding(
        id="/".join(("accelerometer", with_mount(OFF, mount), off.positions[0])),
        cause=OFF,
        mount=mount,
        sensor="accel",
        manoeuvre=off.positions[0],
        size=off.tilt,
        unit="rad",
        p_value=off.p_value,
        severity=2,
        sentence=_(
            "The position {names} deviates by {size} ± {fixed}°, mostly about {axes}, "
            "from all others.",
            names=names,
            size=size,
            fixed=fixed(degrees(off.sigma), 4),
            axes=AXES[axis],
        )
        + (_(" The readings do not distinguish which of these it is.") if several else "")
        + _(
            " Or the accelerometers have an error outside the twelve parameters: these rests do "
            "not tell the two apart."
        ),
        consequence=(
            _(
                "With its attitude estimated, {affected}. The joint fit models it as "
                "scatter between positions.",
                affected="; ".join(affected),
            )
            if affected
            else _("No parameter moves by more than its sigma.")
        ),
        action=_("Set this position again and record it; or state position_sigma_arcsec as it is."),
    )


def _change(name: str, by: float) -> str:
    parts = PARTS[name]
    kind = parts.kind
    words = WORDS[kind].format(row=parts.sensor_axis, column=parts.input_axis)
    unit = quantity(name, "m/s²" if kind == "bias" else "1").laboratory
    return _(
        "the {words} moves by {significant} {name}",
        words=words,
        significant=significant(unit.of(by), 3),
        name=unit.name,
    )


STAGE = Stage(accelerometer, DECLARED, gathers=MOUNTS)


# ---- The accelerometers by the sources' own formulas, beside the joint fit.
#
# `six_position`: S0 (3-6), all rests alike. `up_and_down`: S1, two positions with tilt, where the
# plan has no more. `pooled_positions`: S3, stops at one attitude pooled. All have the sigmas that
# the sources leave out.


def add_six_positions(
    estimates: Estimates,
    planned: Sequence[tuple[StaticPosition, StaticForce]],
    reference: Reference,
    scatter: float,
    wanted: float,
) -> None:
    """S0's formula from the rests of the plan; where they do not span it, S1's from pairs.

    `scatter`: m/s², between rests; `wanted`: m/s², required sigma of a bias, from which the
    length of the rests follows.
    """
    rests = [rest for _, rest in planned]
    solved = six_position_formula(rests, *reference[:3], scatter) if rests else None
    if solved is None:
        _add_up_and_down(estimates, rests, reference, scatter)
        return
    unknowns, covariance = solved
    estimates.add("six_position", NAMES, errors_of(unknowns), covariance, {})
    ideal = six_position_formula(
        [replace(rest, sigma=np.zeros(3)) for rest in rests], *reference[:3]
    )
    assert ideal is not None  # it depends on the same attitudes
    seconds = float(np.mean([position.seconds.sum() for position, _ in planned]))
    for i, axis in enumerate(AXES, UNKNOWNS - 3):
        sigma, floor = (float(np.sqrt(of[i, i])) for of in (covariance, ideal[1]))
        estimates.add_wanted("six_position", axis, Wanted(sigma, floor, seconds), wanted)


def _add_up_and_down(
    estimates: Estimates,
    rests: Sequence[StaticForce],
    reference: Reference,
    scatter: float,
) -> None:
    for i, axis in enumerate(AXES):
        readings = [
            Upright(float(rest.up[i]), float(rest.mean[i]), float(np.hypot(rest.sigma[i], scatter)))
            for rest in rests
            if abs(rest.up[i]) > 1 - 1e-9 and np.isfinite(rest.mean[i] * rest.sigma[i])
        ]
        result = up_and_down(readings, *reference[:3])
        if result is not None:
            values = np.array([result.bias, result.scale])
            sigmas = np.array([result.bias_sigma, result.scale_sigma])
            names = (f"bias_{axis}", f"scale_{axis}")
            estimates.add("up_and_down", names, values, np.diag(sigmas**2), {})


def add_pooled_positions(
    estimates: Estimates,
    rests: Sequence[StaticForce],
    reference: Reference,
    scatter: float,
) -> None:
    """S3's formula, for plans with rotations both ways and stops at common positions."""
    pooled = pooled_positions(rests, *reference[:3], scatter)
    if pooled is not None:
        values = errors_of(pooled.values)
        estimates.add("pooled_positions", NAMES, values, pooled.covariance, {})
