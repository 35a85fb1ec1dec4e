"""One asymmetry of all gyros, which a table has that turns less far in one sense than planned."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.hypotheses import SENSE_OF_TURNS
from inertial.estimation.probability import chi2_sf
from inertial.model_selection.cause import FOUND
from inertial.text.messages import _
from inertial.text.numbers import significant
from stages.criticism.finding_rows import TableRow, finding_row

ASYMMETRY = "gyro_scale_asymmetry"
MIN_SIGMAS = 5.0  # of each gyro's asymmetry
MIN_P = 0.01  # that the three differ as they do if they are one

SENTENCE = _(
    "The scale asymmetries of all three gyros are one within their sigmas, {size} ± {sigma} ppm. "
    "Three gyros hardly agree so; a table that turns by {share} ppm farther in one sense than in "
    "the other, as by backlash, reads the same."
)
CONSEQUENCE = _(
    "If it is the table, compensating the asymmetry is wrong, and the scale factors are off by "
    "{size} ppm at most, for it is not known which sense is right."
)
ACTION = _(
    "Measure the angle of a turn in each sense by an encoder, a mark or an autocollimator; state "
    "the angles in the plan as they are."
)


def shared_asymmetry(estimates: Sequence[Estimated], mount: str) -> Iterator[TableRow]:
    """The finding, by the asymmetries of the gyros that were named."""
    if len(estimates) != 3 or any(one.value is None or not one.sigma for one in estimates):
        return
    values = np.array([one.value for one in estimates], np.float64)
    weights = np.array([one.sigma for one in estimates], np.float64) ** -2
    mean, sigma = float(values @ weights / weights.sum()), float(weights.sum() ** -0.5)
    spread = float((values - mean) ** 2 @ weights)
    if (values**2 * weights < MIN_SIGMAS**2).any() or chi2_sf(spread, 2) < MIN_P:
        return
    size = significant(1e6 * abs(mean), 3)
    yield finding_row(
        SENSE_OF_TURNS,
        mount,
        sensor="gyro",
        size=mean,
        unit="1",
        sentence=SENTENCE.format(
            size=significant(1e6 * mean, 3),
            sigma=significant(1e6 * sigma, 2),
            share=significant(2e6 * abs(mean), 3),
        ),
        consequence=CONSEQUENCE.format(size=size),
        action=ACTION,
        verdict=FOUND,
    )
