"""Whether set positions, or rests by hand, scatter by more than is stated of them.

Set positions
-------------
The tilts of the positions are errors of the equations, with the sigma that the campaign states.
Where that is too small, what is left goes with the attitude, and would be named as effects of the
sensors or of single positions. So the effects that are named with the stated sigma are weighed
against those with the sigma of largest likelihood, by evidence. A single position that is off costs
less as an effect of its own: in a larger sigma of all it would be the only one. What few
manoeuvres carry is no scatter: that is in all positions.

Rests by hand
-------------
The fit takes what rests differ by as a scatter of all of them, which the sigmas hold. |f| = g in
every attitude, so only an acceleration of the IMU adds to it, and that is small at rest. As far as
a hand that sways can make it, the rests were not quite still; beyond that it is of the
accelerometers, or of their record, and has no name.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from inertial.campaign.effect_evidence import deviance, deviances
from inertial.campaign.equations import Campaign
from inertial.model_selection.cause import FOUND, UNKNOWN_STRUCTURE
from inertial.sensors import PLURAL
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND, STANDARD_GRAVITY
from stages.criticism.finding_rows import TableRow, finding_id, finding_row, member_rows
from stages.criticism.residual_structure import Tested, carrying
from stages.criticism.rivals import MAX_LOG_ODDS, members_of
from stages.criticism.selection import Selection

CAUSE = "position_scatter"
TRIED = 1.5  # of the stated sigma: where this is not likelier, none is sought
MIN_DROP = 4.0  # of −2 log likelihood, by the sigma that is tried
MAX_FACTOR = 1000.0  # of the stated sigma
LOG_TOLERANCE = 0.01  # of the sigma
LOG_STEP = 0.1  # of the sigma, over which the curvature of the likelihood is taken
SCATTER = _(
    "The set positions scatter by {found} ± {sigma} arcsec, {ratio} times the {stated} arcsec that "
    "are stated of the table: the {sensors} show it in what goes with the attitude."
)
INSTEAD = _(" As likely is instead: {rivals}.")
CONSEQUENCE = _(
    "The sigmas of the joint result rest on the stated one and are too small; what depends on the "
    "positions may be off by several of them. With the larger one no effect need be named for it."
)
ACTION = _(
    "State position_sigma_arcsec: {found} in the campaign file and run it again; see how the "
    "positions were set, and whether the table keeps what is stated of it."
)
ACTION_OF_ANOTHER_CAUSE = _(
    "Look for its cause first: whether the IMU was mounted anew or shifted, or is another one in "
    "some logs. A larger position_sigma_arcsec would only hide it."
)
MAX_PLAUSIBLE = 100.0  # of the stated sigma: no table scatters by so much more than is stated

Selected = tuple[Selection, Tested, Campaign]


@dataclass(frozen=True)
class PositionScatter:
    """The sigma of the tilts that is likelier than the stated one, rad, and its own.

    `campaign`: with it; `drops`: of −2 log likelihood, by sensor; `rivals`: effects that explain it
    as well.
    """

    campaign: Campaign
    value: float
    sigma: float
    stated: float
    drops: Mapping[str, float]
    rivals: tuple[str, ...] = ()

    @property
    def _action(self) -> str:
        plausible = self.value < MAX_PLAUSIBLE * self.stated and not self.rivals
        return ACTION if plausible else ACTION_OF_ANOTHER_CAUSE

    def rows(self, mount: str) -> Iterator[TableRow]:
        """The finding, of the sensor that shows it, or of both."""
        found = significant(self.value / ARC_SECOND, 2)
        sensors = [sensor for sensor, drop in self.drops.items() if drop > MIN_DROP]
        sentence = SCATTER.format(
            found=found,
            sigma=significant(self.sigma / ARC_SECOND, 2),
            ratio=significant(self.value / self.stated, 2),
            stated=significant(self.stated / ARC_SECOND, 2),
            sensors=listed([PLURAL[sensor] for sensor in sensors]),
        )
        if self.rivals:
            names = listed([in_words(rival) for rival in self.rivals], "or")
            sentence += INSTEAD.format(rivals=names)
        yield finding_row(
            CAUSE,
            mount,
            sensor=sensors[0] if len(sensors) == 1 else None,
            size=self.value,
            unit="rad",
            severity=3,
            sentence=sentence,
            consequence=CONSEQUENCE,
            action=self._action.format(found=found),
            verdict="one_of_class" if self.rivals else "found",
        )
        yield from member_rows(finding_id(CAUSE, mount), mount, [CAUSE, *self.rivals])


def select_beside_scatter(
    measured: Campaign, select: Callable[[Campaign], Selected], level: float
) -> tuple[Selected, PositionScatter | None]:
    """The likeliest selection; that with a scatter of the positions where both are as likely.

    Parameters
    ----------
    select : of a campaign the effects, the tests of its residuals, and the campaign they are of
    level : accepted probability of a cause that is not there, which the evidence of each pays for
    """
    stated = select(measured)
    scatter = likely_scatter(stated[2], measured)
    if scatter is None or any(carrying(stated[1], sensor) for sensor in PLURAL):
        return stated, None
    wider = select(scatter.campaign)
    causes = len(wider[0].named.causes) + 1 - len(stated[0].named.causes)
    odds = wider[0].log_evidence - stated[0].log_evidence + causes * float(np.log(level))
    named = members_of(wider[0])
    rivals = tuple(one for one in members_of(stated[0]) if one not in named)
    if odds < (-MAX_LOG_ODDS if rivals else 0.0):
        return stated, None
    return wider, replace(scatter, rivals=rivals if odds < MAX_LOG_ODDS else ())


def likely_scatter(campaign: Campaign, measured: Campaign) -> PositionScatter | None:
    """The sigma of the positions of largest likelihood without effects; None where none is larger.

    What tilts with the axis of the table may scatter as much, or as is stated. By hand nothing is
    set, and nothing is stated of it. The accelerometers show every tilt at rest: what gyros show
    alone is none. `measured`: the campaign in which it is to be set.
    """
    stated = campaign.position_sigma
    if campaign.by_hand or not stated:
        return None

    def scattering(one: Campaign, log_factor: float, *, with_axis: bool) -> Campaign:
        sigma = stated * float(np.exp(log_factor))
        return replace(one, position_sigma=sigma, axis_sigma=None if with_axis else stated)

    before, tried = deviance(campaign), float(np.log(TRIED))
    found: list[tuple[float, PositionScatter]] = []
    for with_axis in (True, False):

        def with_sigma(log_factor: float, with_axis: bool = with_axis) -> float:
            return deviance(scattering(campaign, log_factor, with_axis=with_axis))

        if before - with_sigma(tried) < MIN_DROP:
            continue
        best = minimize_scalar(
            with_sigma,
            bounds=(0.0, float(np.log(MAX_FACTOR))),
            method="bounded",
            options={"xatol": LOG_TOLERANCE},
        )
        factor, least = float(best.x), float(best.fun)
        beside = with_sigma(factor - LOG_STEP) + with_sigma(factor + LOG_STEP) - 2 * least
        relative = float(np.sqrt(2 * LOG_STEP**2 / max(beside, LOG_STEP**2)))
        wider = scattering(campaign, factor, with_axis=with_axis)
        of_wider = deviances(wider)
        drops = {s: alone - of_wider[s] for s, alone in deviances(campaign).items()}
        value, own = wider.position_sigma, scattering(measured, factor, with_axis=with_axis)
        if drops.get("accel", 0.0) > MIN_DROP:
            found.append((least, PositionScatter(own, value, relative * value, stated, drops)))
    return min(found, key=lambda pair: pair[0])[1] if found else None


# ---- Rests by hand whose specific force scatters about gravity by far more than its noise.


REST_SCATTER = "rest_scatter"
MIN_RATIO = 3.0  # to the noise of a rest: nine tenths of the variance of the rests
OF_RESTS = _(
    "The specific force of the rests scatters about gravity by {size} m/s² ({micro} µg), {ratio} "
    "times the noise of a rest, beside all that is named."
)
WITHIN = _(" An IMU that a hand holds still sways by as much: up to {motion} m/s² here.")
BEYOND = _(
    " That is no motion at rest: an IMU that a hand holds still makes it scatter by {motion} m/s² "
    "at the most."
)
CONSEQUENCE_OF_RESTS = _(
    "The sigmas of the accelerometers hold it as if it were another error in each rest. If it is a "
    "nonlinearity, an asymmetry, or a bias that changes, biases and scale factors are off by more."
)
ACTION_ON_RESTS = _(
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
    sentence = OF_RESTS + (BEYOND if beyond else WITHIN)
    yield finding_row(
        REST_SCATTER,
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
        consequence=CONSEQUENCE_OF_RESTS,
        action=ACTION_ON_RESTS,
        verdict=UNKNOWN_STRUCTURE if beyond else FOUND,
    )
