"""The accelerometers from static positions of unknown attitude, as rows of the tables.

The method `free_positions` also uses positions of known attitude, but not their attitude, so its
result does not depend on the table.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.estimates import NAMES as LINEAR
from inertial.campaign.estimates import Estimates
from inertial.campaign.findings import Finding
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.records import Manoeuvre, Part, omissions, with_mount
from inertial.campaign.static_positions import NO_NOISE, StaticPosition
from inertial.estimation.between_positions import Stop
from inertial.estimation.least_squares import Estimate
from inertial.estimation.multi_position import FREE as UNKNOWNS
from inertial.estimation.multi_position import (
    NAMES,
    PRIOR,
    SCATTER_RANGE,
    FreeRest,
    OffLength,
    Unobservable,
    free_positions,
    off_lengths,
    unobservable,
)
from inertial.estimation.scatter_and_random_walk import ScatterFit, with_scatter
from inertial.tables import ACCEL, AXES, GYRO, STATIC_PHASES
from inertial.text.messages import _, listed, plural
from inertial.text.numbers import significant
from inertial.text.parameters import CROSS, FREE, MOUNTING, PARTS, SYMMETRIC

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData


UNKNOWN = np.full(3, np.nan)  # an attitude
MOVED = "moved_while_read"
MAX_NAMED = 6  # positions in a sentence
MOUNTING_UNDETERMINED = _(
    "a rotation of the triad against the case changes no length, so |f| = g cannot "
    "tell it; the axes here are those square to each other that lie nearest to the "
    "sensors': add rests whose upward direction is known"
)


@dataclass(frozen=True)
class FreeStaticPosition:
    """A static position of any attitude: both sensors, and its records [first, after)."""

    force: StaticPosition
    rate: StaticPosition
    log: str
    first: int
    after: int

    @property
    def label(self) -> str:
        """Its manoeuvre, with the phase where it is one of a turn."""
        return self.force.label

    @property
    def rest(self) -> FreeRest:
        """The input of `free_positions`."""
        return FreeRest(self.label, *self.force.over())

    @property
    def stop(self) -> Stop:
        """The input of the gyros' equations."""
        return Stop(self.rest, *self.rate.over(), float(self.rate.seconds.sum()))


def free_static_positions(data: "CampaignData") -> tuple[list[FreeStaticPosition], list[Part]]:
    """All static positions of one mount in the order of the logs; those left out, with reasons.

    None where the plan states every attitude: there the other methods apply.
    """
    positions, left_out, off = _with_those_off(data)
    return positions, left_out + [part for part, _ in off]


def _with_those_off(
    data: "CampaignData",
) -> tuple[list[FreeStaticPosition], list[Part], list[tuple[Part, OffLength]]]:
    """The same, with those apart whose specific force is not gravity by the others."""
    positions, left_out = _recorded_positions(data)
    rests = [position.rest for position in positions]
    means, sigma = (
        np.reshape([getattr(r, of) for r in rests], (-1, 3)) for of in ("mean", "sigma")
    )
    found = {each.number: each for each in off_lengths(means, sigma, data.gravity.number)}
    off = [
        (replace(positions[i].force.part, reason=_reason_of(each)), each)
        for i, each in found.items()
    ]
    return [each for i, each in enumerate(positions) if i not in found], left_out, off


def _reason_of(off: OffLength) -> str:
    return _(
        "|f| misses gravity by {size} m/s², {times} times what the others scatter by",
        size=significant(off.size, 2),
        times=significant(abs(off.size) / off.scatter, 2),
    )


def _recorded_positions(data: "CampaignData") -> tuple[list[FreeStaticPosition], list[Part]]:
    """All that are recorded whole; those left out, with reasons."""
    blocks, plan = data.blocks, data.plan
    if all(m.up is not None for m in plan if m.do != "turn"):
        return [], []
    positions: list[FreeStaticPosition] = []
    left_out: list[Part] = []
    at_rest = blocks[blocks["phase"].isin(STATIC_PHASES) & (blocks["count"] > 0)]
    at_rest = at_rest.sort_values(["log", "from_record"])
    most = blocks["manoeuvre"].nunique()
    by_name = {m.detected_rest(number): m for m in plan for number in range(1, most + 1)}
    by_name |= {m.name: m for m in plan}
    for (key, phase), rows in at_rest.groupby(["manoeuvre", "phase"], sort=False):
        name = str(key)
        m = by_name.get(name)
        if m is None:
            continue
        part = Part(name, str(phase))
        force, rate = (_static_position(part, m, rows, data.noise, each) for each in (ACCEL, GYRO))
        recorded = np.isfinite(force.means).any(axis=0)
        first, after = int(rows["from_record"].min()), int(rows["to_record"].max())
        if not recorded.all():
            missing = _(" and ").join(np.array(AXES)[~recorded])
            left_out.append(replace(part, reason=_("|f| = g needs {missing} too", missing=missing)))
        elif not np.isfinite(force.over()).all():
            left_out.append(replace(part, reason=NO_NOISE))
        else:
            positions.append(
                FreeStaticPosition(force, rate, str(rows["log"].iloc[0]), first, after)
            )
    return positions, left_out


def _static_position(
    part: Part,
    m: Manoeuvre,
    rows: pd.DataFrame,
    noise: NoiseLevels,
    channels: list[str],
) -> StaticPosition:
    return StaticPosition(
        part,
        m,
        UNKNOWN,
        UNKNOWN,
        0.0,
        rows[channels].to_numpy(np.float64),
        rows["count"].to_numpy(np.float64),
        rows["seconds"].to_numpy(np.float64),
        rows["time"].to_numpy(np.float64),
        rows["temperature"].to_numpy(np.float64),
        noise.of(part.manoeuvre, "rest", channels),
    )


def fitted_to(data: "CampaignData", positions: Sequence[FreeStaticPosition]) -> ScatterFit:
    """P and bias of the accelerometers, with a scatter between positions beyond the white noise.

    Within a position by hand it is the support that drifts, not only the bias: so what drifts there
    does not determine the differences between positions, which show their scatter themselves.
    """
    gravity, rests = data.gravity, [position.rest for position in positions]
    fit = partial(free_positions, rests, gravity.number, gravity.scatter)
    return with_scatter(fit, between=SCATTER_RANGE, noise_degrees=data.noise.degrees, tested=False)


def add_free_accelerometers(estimates: Estimates, data: "CampaignData") -> list[Finding]:
    """The rows of the method, none where the plan states every attitude; findings about them."""
    positions, left_out, off = _with_those_off(data)
    left_out += [part for part, _ in off]
    if positions:
        fitted = fitted_to(data, positions)
        add_symmetric(estimates, fitted.estimate)
        estimates.add_fit(FREE, fitted, [position.force.part for position in positions], left_out)
    elif left_out:
        estimates.add_nothing(FREE, omissions(left_out))
    return [_moved(off, data.mount)] if off else []


def first_of(names: Sequence[str]) -> str:
    """The first positions of a finding, and how many more there are."""
    more = len(names) - MAX_NAMED
    return listed([*names[:MAX_NAMED], *([_("{count} more", count=more)] if more > 0 else [])])


def _moved(off: Sequence[tuple[Part, OffLength]], mount: str) -> Finding:
    """The positions whose specific force is not gravity, as one finding."""
    part, largest = max(off, key=lambda each: abs(each[1].size))
    names = first_of([each.manoeuvre for each, _size in off])
    return Finding(
        id="/".join(("accelerometer", with_mount(MOVED, mount), "all")),
        cause=MOVED,
        mount=mount,
        sensor="accel",
        manoeuvre=part.manoeuvre,
        count=len(off),
        size=largest.size,
        unit="m/s²",
        severity=1,
        sentence=plural(
            "In the position {names} the specific force misses gravity by {size} m/s², {times} "
            "times what the others scatter by.",
            "In {count} positions ({names}) the specific force misses gravity by up to {size} "
            "m/s², {times} times what the others scatter by.",
            len(off),
            names=names,
            size=significant(largest.size, 2),
            times=significant(abs(largest.size) / largest.scatter, 2),
        ),
        consequence=_(
            "Used, they would move biases and scale factors of the accelerometers, and enlarge the "
            "scatter that is given to all positions."
        ),
        action=_(
            "They are left out. The IMU was moved or struck while it was read, or its readings are "
            "of another position: record them again."
        ),
    )


def add_symmetric(estimates: Estimates, estimate: Estimate) -> None:
    """P and bias, also as the twelve unknowns with M = P, and why some are not determined."""
    parameters = {name: name for name in NAMES}
    parameters |= {f"scale_{axis}": f"symmetric_{axis}{axis}" for axis in AXES}
    parameters |= {name: "symmetric_" + "".join(sorted(name[-2:])) for name in CROSS}
    names = (*LINEAR, *MOUNTING, *SYMMETRIC)
    unit = dict(zip(NAMES, np.eye(UNKNOWNS), strict=True))
    jacobian = np.array(
        [unit[parameters[n]] if n in parameters else np.zeros(UNKNOWNS) for n in names]
    )
    values = jacobian @ (estimate.values[:UNKNOWNS] - PRIOR)  # P − I
    reasons = dict.fromkeys(MOUNTING, MOUNTING_UNDETERMINED)
    unobservable_directions = unobservable(estimate)
    for name, parameter in parameters.items():
        i = NAMES.index(parameter)
        if not estimate.determined[i]:
            reasons[name] = in_words(max(unobservable_directions, key=partial(_share, i)))
    estimates.add(
        FREE,
        names,
        values,
        jacobian @ estimate.covariance[:UNKNOWNS, :UNKNOWNS] @ jacobian.T,
        reasons,
    )


def _share(i: int, direction: Unobservable) -> float:
    return abs(float(direction.along[i]))


def in_words(direction: Unobservable) -> str:
    """The parameters that the rests do not determine, and the rest that would."""
    cure = _("add one with {up}", up=_attitude_name(direction.up))
    if len(direction.names) > 1:
        *most, last = map(_parameter_name, direction.names)
        return _(
            "the rests do not tell {most} from {last}: {cure}",
            most=", ".join(most),
            last=last,
            cure=cure,
        )
    axes = PARTS[direction.names[0]].axes
    if len(set(axes)) == 2:
        both = _("both {axes} and {axes_2}", axes=axes[0], axes_2=axes[1])
        return _(
            "no rest has {both} far from level, which would show their angle: {cure}",
            both=both,
            cure=cure,
        )
    both = _("one with +{axes} up and one with -{axes} up", axes=axes[0])
    return _("too few rests have {axes} up or down: add {both}", axes=axes[0], both=both)


def _parameter_name(name: str) -> str:
    kind, axes = PARTS[name]
    if kind == "bias":
        return _("the bias of {axes}", axes=axes)
    if axes[0] == axes[1]:
        return _("the scale factor of {axes}", axes=axes[0])
    return _("the angle between {axes} and {axes_2}", axes=axes[0], axes_2=axes[1])


def _attitude_name(up: Array) -> str:
    """An attitude by the axes that point up: +1, or −1 for the one that points down."""
    signs = dict(zip(AXES, up.tolist(), strict=True))
    axes = [f"{'+' if sign > 0 else '-'}{axis}" for axis, sign in signs.items() if sign]
    if len(axes) == 1:
        return _("{axes} up", axes=axes[0])
    if len(axes) == 2:
        level = next(axis for axis, sign in signs.items() if not sign)
        return _(
            "{axes} and {axes_2} both 45° above level, and {level} level",
            axes=axes[0],
            axes_2=axes[1],
            level=level,
        )
    return _(
        "{axes}, {axes_2} and {axes_3} all 35° above level",
        axes=axes[0],
        axes_2=axes[1],
        axes_3=axes[2],
    )
