"""The gyros from the motions between rests of unknown attitude, as rows of the tables.

The method is `free_positions`, as that of the accelerometers, in whose axes its result is.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import NAMES, Estimates, reasons
from inertial.campaign.findings import Finding
from inertial.campaign.passages import RecordedPassage, passages_of
from inertial.campaign.records import Part, omissions, with_mount
from inertial.campaign.unknown_attitude import (
    MOVED,
    FreeStaticPosition,
    first_of,
    fitted_to,
    free_static_positions,
)
from inertial.estimation.between_positions import Prior, Stop, fit
from inertial.estimation.gyroscopes import BIAS, PRIOR_SIGMA
from inertial.estimation.least_squares import MIN_SIGMA_REDUCTION, Estimate
from inertial.signal.scale_factor import MAX_SCALE_ERROR
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.tables import AXES, GYRO
from inertial.text.messages import _, plural
from inertial.text.numbers import significant
from inertial.text.parameters import FREE, PARTS
from inertial.text.units import DEGREE

NOT_AT_REST = _("its gyros read otherwise than in all other rests: it moved, or it was shaken")
SLIPPED = _(
    "it ends elsewhere than by the gyros, farther off than all others: it slipped, or was struck"
)
CURES = {
    "bias": _("no rest shows it: add a rest"),
    "matrix": _(
        "between the rests the IMU hardly turned about {axis} while {axis} was horizontal: "
        "add turns of 90° or more about {axis}, there and back"
    ),
}
CAUSE = "gyro_count_size"
OWN_SCALE = "gyro_scale_of_axes"
UNIT = "wrong_scale_factor"
MAX_BY_HAND, FASTEST = 40.0, 0.99  # rad/s, of the block at this quantile: more no hand turns
MAX_LEVEL = 0.5  # of gravity along an axis that is level
MIN_TURN = np.radians(45.0)  # about it, that would determine its parameters
MAX_MOVED = 0.25  # of the rests: where more are left out, it is not that single ones were moved
MIN_MOVED_SIGMA = 10.0  # of the others, by which one is off: as of the accelerometers
MIN_SIGMAS = 5.0  # by which a scale factor is further off than that of any gyro


def add_free_gyros(estimates: Estimates, data: CampaignData) -> list[Finding]:
    """The rows of the method, none where the plan states every attitude; findings about them."""
    positions, left_out = free_static_positions(data)
    stops = [position.stop for position in positions]
    recorded = np.isfinite(np.array([stop.mean for stop in stops]).reshape(-1, 3)).any(axis=0)
    if not recorded.any():
        if left_out or positions:
            none = (
                _("in no position has a gyro readings that can be used")
                if data.blocks[list(GYRO)].notna().any(axis=None)
                else _("no gyro is recorded")
            )
            estimates.add_nothing(FREE, omissions(left_out) or none)
        return []
    moving, broken = passages_of(positions, data.blocks, data.noise, data.clocks)
    between = fitted_to(data, positions).scatter
    prior = Prior(data.gravity.number, data.gravity.scatter, between, data.earth)
    passages = [recorded.passage for recorded in moving]
    fitted, off = fit(stops, passages, prior, data.noise.degrees)
    why = reasons(fitted.estimate.determined, recorded, "gyro", _cures(moving, broken))
    why |= _imprecise(fitted.estimate, _turned(positions, moving, fitted.estimate), recorded)
    estimates.add_triad(FREE, fitted.estimate, why)
    parts = [*(position.force.part for position in positions), *(each.part for each in moving)]
    reason = [NOT_AT_REST] * len(stops) + [SLIPPED] * len(moving)
    broken += [replace(parts[i], reason=reason[i]) for i in off]
    used = [part for i, part in enumerate(parts) if i not in off]
    estimates.add_fit(FREE, fitted, used, left_out + broken)
    moved = [i for i in off if i < len(stops)]
    raised = list(_moved(stops, moved, data.mount))
    turning = np.nanquantile(np.abs(data.blocks[GYRO].to_numpy(np.float64)), FASTEST)
    if turning > MAX_BY_HAND:
        return [*raised, _unit(float(turning), data.mount)]
    return [*raised, *_count_size(fitted.estimate, data.mount)]


def _moved(stops: Sequence[Stop], moved: Sequence[int], mount: str) -> Iterator[Finding]:
    """A finding about the rests, by number, in which the gyros read otherwise than in all others.

    None where that is so of many, or by little more than the others scatter by.
    """
    if not 0 < len(moved) <= MAX_MOVED * len(stops):
        return
    means, sigmas = np.array([[stop.mean, stop.sigma] for stop in stops]).swapaxes(0, 1)
    others = np.delete(means, moved, axis=0)
    recorded = np.isfinite(others).any(axis=0)
    usual = np.nanmedian(others[:, recorded], axis=0)
    scatter = MAD_TO_SIGMA * np.nanmedian(np.abs(others[:, recorded] - usual), axis=0)
    off = np.abs(means[:, recorded] - usual)[moved]
    clear = off > MIN_MOVED_SIGMA * np.maximum(scatter, sigmas[:, recorded][moved])
    moved = [moved[i] for i in np.flatnonzero(clear.any(axis=1)).tolist()]
    if not moved:
        return
    sizes = np.nanmax(off[clear.any(axis=1)], axis=1)
    names = [stop.forces.name for stop in stops]
    largest, size = moved[int(np.argmax(sizes))], float(sizes.max())
    yield Finding(
        id="/".join(("gyroscope", with_mount(MOVED, mount), "all")),
        cause=MOVED,
        mount=mount,
        sensor="gyro",
        manoeuvre=names[largest],
        count=len(moved),
        size=size,
        unit="rad/s",
        severity=1,
        sentence=plural(
            "In the position {names} the gyros read {size}°/s otherwise than in all others: the "
            "IMU was not at rest there.",
            "In {count} positions ({names}) the gyros read up to {size}°/s otherwise than in all "
            "others: the IMU was not at rest there.",
            len(moved),
            names=first_of([names[i] for i in moved]),
            size=significant(size / DEGREE, 2),
        ),
        consequence=_(
            "Used, they would move the biases of the gyros, and the angles of the motions before "
            "and after them."
        ),
        action=_(
            "They are left out of the gyros. The IMU was shaken while it was read, or it slipped "
            "or crept on what it lay on: record them again, on something hard."
        ),
    )


def _cures(moving: Sequence[RecordedPassage], broken: Sequence[Part]) -> dict[str, str]:
    """What determines the parameters that are not; some motions may be recorded in part only."""
    if not broken:
        return CURES
    of_motions = _(
        "of {all} motions between rests {broken} carry no attitude; of {first}: {reason}. If a "
        "gyro reached the end of its range there, turn more slowly",
        all=len(broken) + len(moving),
        broken=len(broken),
        first=broken[0].manoeuvre,
        reason=broken[0].reason,
    )
    # Names are free text, and a remedy is a format of the axis.
    of_motions = of_motions.replace("{", "{{").replace("}", "}}")
    if len(broken) <= len(moving):
        of_motions = _("{of_one}; {of_all}", of_one=CURES["matrix"], of_all=of_motions)
    return CURES | {"matrix": of_motions}


def _turned(
    positions: Sequence[FreeStaticPosition], moving: Sequence[RecordedPassage], fitted: Estimate
) -> Array:
    """The largest angle of a motion about each axis while that was level before and after, (3,)."""
    most = np.zeros(3)
    for each in moving:
        passage = each.passage
        ends = [positions[passage.first + k].rest.mean for k in (0, 1)]
        level = np.all([np.abs(f) < MAX_LEVEL * np.linalg.norm(f) for f in ends], axis=0)
        turned = passage.seconds @ (passage.rates - fitted.values[9:12])
        most = np.fmax(most, np.where(level, np.abs(turned), 0.0))
    return most


def _imprecise(fitted: Estimate, turned: Array, recorded: Booleans) -> dict[str, str]:
    """Why parameters of axes about which the IMU was turned are not determined all the same."""
    return {
        name: _(
            "the IMU was turned about {axis} while {axis} was horizontal, by up to {angle}°, but "
            "the motions agree with the rests only so far that it is known to ± {sigma}, and it "
            "must be known to ± {least}: add more turns about {axis}, and let the IMU stand "
            "still before and after each",
            axis=PARTS[name].input_axis,
            angle=significant(float(np.degrees(turned[column])), 2),
            sigma=significant(float(fitted.sigma[i]), 2),
            least=significant(float(PRIOR_SIGMA[i]) / MIN_SIGMA_REDUCTION, 2),
        )
        for i, name in enumerate(NAMES)
        for column in [i % 3]
        if i < BIAS and recorded[i // 3] and not fitted.determined[i] and turned[column] > MIN_TURN
    }


def _unit(turning: float, mount: str) -> Finding:
    """Gyros that read faster than any hand turns, of which the motions by hand show no scale."""
    return Finding(
        id="/".join(("gyroscope", with_mount(UNIT, mount), "all")),
        cause=UNIT,
        mount=mount,
        sensor="gyro",
        size=1 / DEGREE,
        severity=3,
        sentence=_(
            "The gyros read up to {rate}°/s, and no hand turns an IMU so fast: °/s that are stated "
            "as rad/s read 57.3 times what they should.",
            rate=significant(turning / DEGREE, 2),
        ),
        consequence=_("The scale factors of the gyros, and where they turned to, are unknown."),
        action=_("State the unit of the gyros, deg/s, or their counts_per_unit."),
    )


def _count_size(estimate: Estimate, mount: str) -> Iterator[Finding]:
    """The gyros whose counts are of another size than stated, as the motions by hand show it.

    One finding for all axes; M holds it, so the result stays right for readings as they are. One
    count size is stated of a sensor: where it is wrong all axes read wrong alike, but for the scale
    errors of each. A single axis that is off has another scale factor.
    """
    places = [0, 4, 8]
    ratios, sigmas = estimate.values[places], estimate.sigma[places]
    known = estimate.determined[places]
    beyond = np.abs(ratios - 1) - MAX_SCALE_ERROR["gyro"] > MIN_SIGMAS * sigmas
    off = [i for i in range(3) if beyond[i] and known[i]]
    if not off:
        return
    listed = ", ".join(f"{AXES[i]} {significant(ratios[i], 4)}" for i in off)
    mean = float(np.mean(ratios[off]))
    alike = np.ptp(ratios[known]) <= 2 * MAX_SCALE_ERROR["gyro"] * abs(mean)
    if len(off) < known.sum() or not alike:
        yield _own_scales(listed, [AXES[i] for i in off], mean, mount)
        return
    yield Finding(
        id="/".join(("gyroscope", with_mount(CAUSE, mount), "all")),
        cause=CAUSE,
        mount=mount,
        sensor="gyro",
        axis=AXES[off[0]] if len(off) == 1 else None,
        count=len(off),
        size=mean,
        severity=2,
        sentence=_(
            "Between the positions the gyros turned by other angles than they read: they read "
            "{listed} times what they should. The stated count size is not that of the log.",
            listed=listed,
        ),
        consequence=_(
            "The scale factors of the result hold it, so the result is right for these readings."
        ),
        action=_(
            "Multiply the counts_per_unit of the gyros by {factor}, or state the right unit.",
            factor=significant(mean, 4),
        ),
    )


def _own_scales(listed: str, axes: Sequence[str], mean: float, mount: str) -> Finding:
    """Of single gyros whose scale factors are further off than those of any data sheet."""
    return Finding(
        id="/".join(("gyroscope", with_mount(OWN_SCALE, mount), "all")),
        cause=OWN_SCALE,
        mount=mount,
        sensor="gyro",
        axis=axes[0] if len(axes) == 1 else None,
        count=len(axes),
        size=mean,
        severity=1,
        sentence=_(
            "Between the positions the gyros turned by other angles than they read: they read "
            "{listed} times what they should, and the other axes do not read wrong alike. It is no "
            "count size, which is one of all axes, but the scale factor of these.",
            listed=listed,
        ),
        consequence=_(
            "The scale factors of the result hold it, so the result is right for these readings."
        ),
        action=_("None. Where each axis has a counts_per_unit of its own, see that of these."),
    )
