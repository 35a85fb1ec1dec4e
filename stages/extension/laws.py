"""Laws that were found: in the form that the plan tells, and as a file of the catalogue."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.effects.law import SIZES, Law
from inertial.physics.effect import Effect
from inertial.physics.laws import functions
from inertial.physics.motion import Motion
from inertial.text.cause_names import in_words
from inertial.text.parameters import AXES
from stages.extension.candidates import Candidate
from stages.extension.estimates import Solved
from stages.extension.named_effects import NamedClass

# ---- A law as a file in the form of the catalogue, for whoever finds its physical cause.

TEMPLATE = '''"""{title}: a law that a calibration found, whose physical cause is not known.

Copy this file into inertial/effects/, add the class to the catalogue there, write its cause and its
source, and where readings are to be compensated its terms; the tests of the catalogue do the rest.
"""

from dataclasses import replace

import numpy as np

from inertial.arrays import Array
from inertial.physics.effect import Effect, Parameter, Reading, Truth, by_grade
from inertial.physics.laws import functions, unknown
from inertial.physics.motion import Motion
from inertial.text.messages import _


class {cls}(Effect):
    """Reading of an axis += Σ k_j u_j, u_j the {family} of {state}: shape {shape}."""

    name = "{name}"
    cause = _("{title}")
    source = "found in the residuals of a calibration"
    parameters = (
{parameters}
    )
    sizes = by_grade({size!r}, 0.1, 1, 10, 100)

    def blind(self, motion: Motion) -> str:
        return unknown("{state}", motion)

    def reads(self, reading: Reading, truth: Truth, motion: Motion, values: Array) -> Reading:
        added = np.zeros((len(motion.time), 3))
        for i, own in zip({axes}, np.split(values, {count}), strict=True):
            added[:, i] = functions("{family}", "{state}", {shape}, motion, i) @ own
        return replace(reading, {sensor}=reading.{sensor} + added)
'''


def proposed_rows(classes: Sequence[NamedClass], mount: str) -> Iterator[dict[str, Any]]:
    """The laws among the named effects, each with the text of its file."""
    for each in classes:
        law = each.members[0].effect
        if isinstance(law, Law):
            yield {
                "mount": mount,
                "effect": law.name,
                "file": f"{law.name}{f'-{mount}' if mount else ''}.py",
                "text": text_of(law),
            }


def text_of(law: Law) -> str:
    """The file of a law."""
    parameters = "\n".join(
        f'        Parameter("{p.name}", "{p.unit}", {p.typical!r}, '
        f'_("size in the {p.name[-1]} reading")),'
        for p in law.parameters
    )
    axes = tuple(AXES.index(axis) for axis in law.axes)
    return TEMPLATE.format(
        title=in_words(law.name),
        cls="".join(word.capitalize() for word in law.name.split("_")),
        name=law.name,
        family=law.family,
        state=law.state,
        shape=tuple(float(value) for value in law.shape),
        parameters=parameters,
        size=float(SIZES[law.sensor][1]),
        axes=axes,
        count=len(axes),
        sensor=law.sensor,
    )


# ---- A law of time or of the temperature is a drift that nothing takes out of readings.
#
# So the bias that holds for them is its mean over the recording, and how far the law goes about
# this is part of its sigma (GUM F.2.4.5: a correction that is known to vary and is not applied).


def with_drift_in_the_bias(
    solution: Solved, effects: Sequence[Effect], motion: Motion, stretches: slice
) -> Solved:
    """The fit with the mean of its drifts by a law in the biases, their scatter in the sigmas.

    `stretches`: those of `motion` that are of the sensor.
    """
    weights = motion.seconds[stretches] / motion.seconds[stretches].sum()
    place = {row["parameter"]: i for i, row in enumerate(solution.rows)}
    transform, scatter = np.eye(len(place)), np.zeros(len(place))
    for law in effects:
        if not (isinstance(law, Law) and law.is_drift and law.sensor == solution.sensor):
            continue
        for axis in law.axes:
            bias, i = place[f"bias_{axis}"], AXES.index(axis)
            own = [p.name for p in law.parameters if p.name[-1] == axis]
            terms = [place[name] for p in own if (name := f"{law.name}.{p}") in place]
            if len(terms) < len(own):
                continue
            responses = functions(law.family, law.state, law.shape, motion, i)[stretches]
            mean = weights @ responses
            transform[bias, terms] += mean
            drift = (responses - mean) @ solution.values[terms]
            scatter[bias] += weights @ drift**2
    covariance = transform @ solution.covariance @ transform.T + np.diag(scatter)
    return solution.with_values(transform @ solution.values, covariance)


# ---- Laws of the rate, or of the attitude, that have about as many terms as the plan has of these.
#
# They fit whatever the law is. Manoeuvres that are held out confirm nothing then: others at the
# same rate, or in the same attitude, stay in the training.

OF_RATE = ("gyro_scale_quadratic", "gyro_scale_cubic")
OF_ATTITUDE = (
    "accel_quadratic",
    "accel_cubic",
    "accel_cross_products",
    "accel_scale_asymmetry",
    "accel_hysteresis",
)
ONE_RATE = 0.02  # relative: rates that differ by less are one
ONE_ATTITUDE = 0.02  # of a component of the upward direction
PARAMETERS = 12


def form_is_open(sensor: str, candidate: Candidate, campaign: Campaign) -> bool:
    """Whether several laws of a sensor together have too many terms to be confirmed.

    Of the gyros: as many as there are rates but the one of the scale factor. Of the accelerometers:
    more than half of what the attitudes leave beside the twelve parameters.
    """
    if campaign.by_hand:
        return False
    own = OF_RATE if sensor == "gyro" else OF_ATTITUDE
    laws = [
        effect
        for effect in candidate.effects
        if effect.name in own or (isinstance(effect, Law) and sensor == "accel")
    ]
    if len(laws) < 2:
        return False
    motion, stretches = campaign.motion, campaign.stretches(sensor)
    if sensor == "gyro":
        rates = np.abs(motion.rate[stretches])
        changes = np.abs(motion.acceleration[stretches]) * motion.seconds[stretches]
        steady = rates[(rates > ONE_RATE * rates.max(initial=0.0)) & (changes < ONE_RATE * rates)]
        rates_held = 1 + np.count_nonzero(np.diff(np.sort(np.log(steady))) > ONE_RATE)
        return bool(rates_held <= len(laws) + 1)
    ups = np.unique(np.round(motion.up[stretches] / ONE_ATTITUDE), axis=0)
    terms = sum(column in candidate.columns for law in laws for column in law.columns)
    return 2 * terms > 3 * len(ups) - PARAMETERS
