"""A stated heading that the gyros contradict by far: then they tell the azimuth of the table.

The equations of criticism find a heading that is off by some degrees. With one that is off by tens
the joint fit they rest on is none: the earth's rate, wrong within every turn, moves all of M.
"""

import numpy as np

from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.findings import Finding
from inertial.campaign.records import with_mount
from inertial.estimation import gyroscopes
from inertial.estimation.gyroscope_observations import TABLE
from inertial.estimation.least_squares import Estimate
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant, with_own_sigma
from inertial.text.units import DEGREE

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
