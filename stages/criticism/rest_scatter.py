"""Rests by hand whose specific force scatters about gravity by far more than its noise.

The fit takes what rests differ by as a scatter of all of them, which the sigmas hold. |f| = g in
every attitude, so only an acceleration of the IMU adds to it, and that is small at rest. As far as
a hand that sways can make it, the rests were not quite still; beyond that it is of the
accelerometers, or of their record, and has no name.
"""

from collections.abc import Iterator

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.model_selection.cause import FOUND, UNKNOWN_STRUCTURE
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import STANDARD_GRAVITY
from stages.criticism.finding_rows import TableRow, finding_row

CAUSE = "rest_scatter"
MIN_RATIO = 3.0  # to the noise of a rest: nine tenths of the variance of the rests
SENTENCE = _(
    "The specific force of the rests scatters about gravity by {size} m/s² ({micro} µg), {ratio} "
    "times the noise of a rest, beside all that is named."
)
WITHIN = _(" An IMU that a hand holds still sways by as much: up to {motion} m/s² here.")
BEYOND = _(
    " That is no motion at rest: an IMU that a hand holds still makes it scatter by {motion} m/s² "
    "at the most."
)
CONSEQUENCE = _(
    "The sigmas of the accelerometers hold it as if it were another error in each rest. If it is a "
    "nonlinearity, an asymmetry, or a bias that changes, biases and scale factors are off by more."
)
ACTION = _(
    "Record it again with at least 30 rests, in inclined attitudes too, each on a firm support: an "
    "effect can then be told from a scatter. See whether the accelerometers warm up, are struck, "
    "or vibrate between the rests."
)


def rest_scatter_rows(campaign: Campaign, mount: str) -> Iterator[TableRow]:
    """The finding, of no known cause beyond motion at rest. `campaign`: given what is named."""
    by_hand = campaign.by_hand
    if by_hand is None or not by_hand.force_scatter:
        return
    size, beyond = by_hand.force_scatter, by_hand.beyond_motion
    noise = float(np.median([rest.sigma for _, rest, _ in campaign.static_forces]))
    if size < MIN_RATIO * noise:
        return
    sentence = SENTENCE + (BEYOND if beyond else WITHIN)
    yield finding_row(
        CAUSE,
        mount,
        sensor="accel",
        size=size,
        unit="m/s²",
        sentence=sentence.format(
            size=significant(size, 2),
            micro=significant(size / STANDARD_GRAVITY * 1e6, 2),
            ratio=significant(size / noise, 2),
            motion=significant(by_hand.of_motion, 2),
        ),
        consequence=CONSEQUENCE,
        action=ACTION,
        verdict=UNKNOWN_STRUCTURE if beyond else FOUND,
    )
