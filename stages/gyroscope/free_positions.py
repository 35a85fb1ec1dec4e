"""The gyros from the motions between rests of unknown attitude, as rows of the tables.

The method is `free_positions`, as that of the accelerometers, in whose axes its result is.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Booleans
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import Estimates, reasons
from inertial.campaign.findings import Finding
from inertial.campaign.passages import RecordedPassage, passages_of
from inertial.campaign.records import Part, omissions, with_mount
from inertial.campaign.unknown_attitude import fitted_to, free_static_positions
from inertial.estimation.attitude import Passage
from inertial.estimation.between_positions import Prior, Stop, fit
from inertial.estimation.least_squares import Estimate
from inertial.signal.scale_factor import MAX_SCALE_ERROR
from inertial.tables import AXES, GYRO
from inertial.text.messages import _
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
NOT_FOR_WANT_OF_TURNS = {
    "bias": CURES["bias"],
    "matrix": _(
        "the turns about {axis} between the rests are too few, or the directions of gravity in the "
        "rests not known well enough, to determine it: add rests in further attitudes, with turns "
        "of 90° or more about {axis} between them"
    ),
}
MIN_SHOWN, LEVEL = (
    60 * DEGREE,
    0.5,
)  # of a turn, to show its axis; |f| along it, at most, where level
CAUSE = "gyro_count_size"
UNIT = "wrong_scale_factor"
MAX_BY_HAND, FASTEST = 40.0, 0.99  # rad/s, of the block at this quantile: more no hand turns
MIN_SIGMAS = 5.0  # by which a scale factor is further off than that of any gyro


def add_free_gyros(estimates: Estimates, data: CampaignData) -> list[Finding]:
    """The rows of the method, none where the plan states every attitude; findings about them."""
    positions, left_out = free_static_positions(data)
    stops = [position.stop for position in positions]
    recorded = np.isfinite(np.array([stop.mean for stop in stops]).reshape(-1, 3)).any(axis=0)
    if not recorded.any():
        if left_out or positions:
            estimates.add_nothing(FREE, omissions(left_out) or _("no gyro is recorded"))
        return []
    moving, broken = passages_of(positions, data.blocks, data.noise, data.clocks)
    between = fitted_to(data, positions).scatter
    prior = Prior(data.gravity.number, data.gravity.scatter, between, data.earth)
    passages = [recorded.passage for recorded in moving]
    fitted, off = fit(stops, passages, prior, data.noise.degrees)
    why = _why(fitted.estimate.determined, recorded, stops, moving, broken)
    estimates.add_triad(FREE, fitted.estimate, why)
    parts = [*(position.force.part for position in positions), *(each.part for each in moving)]
    reason = [NOT_AT_REST] * len(stops) + [SLIPPED] * len(moving)
    broken += [replace(parts[i], reason=reason[i]) for i in off]
    used = [part for i, part in enumerate(parts) if i not in off]
    estimates.add_fit(FREE, fitted, used, left_out + broken)
    turning = np.nanquantile(np.abs(data.blocks[GYRO].to_numpy(np.float64)), FASTEST)
    if turning > MAX_BY_HAND:
        return [_unit(float(turning), data.mount)]
    return list(_count_size(fitted.estimate, data.mount))


def _why(
    determined: Booleans,
    recorded: Booleans,
    stops: Sequence[Stop],
    moving: Sequence[RecordedPassage],
    broken: Sequence[Part],
) -> dict[str, str]:
    """Why a parameter is not determined: for want of turns about its axis only where none is."""
    cures = _cures(moving, broken)
    why = reasons(determined, recorded, "gyro", cures)
    if cures is not CURES:
        return why
    other = reasons(determined, recorded, "gyro", NOT_FOR_WANT_OF_TURNS)
    turned = {axis for each in moving for axis in _turned_level(stops, each.passage)}
    return {
        name: other[name] if PARTS[name].input_axis in turned else text
        for name, text in why.items()
    }


def _turned_level(stops: Sequence[Stop], passage: Passage) -> Iterator[str]:
    """The axes about which a motion turned, as the gyros read, and which were horizontal."""
    angles = np.abs((passage.rates - stops[passage.first].mean).T @ passage.seconds)
    up = stops[passage.first].forces.mean
    level = np.abs(up) < LEVEL * np.linalg.norm(up)
    yield from (
        axis for axis, shown in zip(AXES, (angles > MIN_SHOWN) & level, strict=True) if shown
    )


def _cures(moving: Sequence[RecordedPassage], broken: Sequence[Part]) -> dict[str, str]:
    """What determines the parameters that are not; most motions may be recorded in part only."""
    if len(broken) <= len(moving):
        return CURES
    of_motions = _(
        "of {all} motions between rests {broken} carry no attitude; of {first}: {reason}",
        all=len(broken) + len(moving),
        broken=len(broken),
        first=broken[0].manoeuvre,
        reason=broken[0].reason,
    )
    # Names are free text, and a remedy is a format of the axis.
    return CURES | {"matrix": of_motions.replace("{", "{{").replace("}", "}}")}


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

    One finding for all axes; M holds it, so the result stays right for readings as they are.
    """
    places = [0, 4, 8]
    ratios, sigmas = estimate.values[places], estimate.sigma[places]
    beyond = np.abs(ratios - 1) - MAX_SCALE_ERROR["gyro"] > MIN_SIGMAS * sigmas
    off = [i for i in range(3) if beyond[i] and estimate.determined[places[i]]]
    if not off:
        return
    listed = ", ".join(f"{AXES[i]} {significant(ratios[i], 4)}" for i in off)
    mean = float(np.mean(ratios[off]))
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
