"""Gyros whose counts are of another size than stated, as the motions by hand show it."""

from collections.abc import Iterator

import numpy as np

from inertial.campaign.findings import Finding
from inertial.campaign.records import with_mount
from inertial.estimation.least_squares import Estimate
from inertial.signal.scale_factor import MAX_SCALE_ERROR
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import significant

CAUSE = "gyro_count_size"
MIN_SIGMAS = 5.0  # by which a scale factor is further off than that of any gyro


def findings(estimate: Estimate, mount: str) -> Iterator[Finding]:
    """One finding for all axes; M holds it, so the result stays right for readings as they are."""
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
