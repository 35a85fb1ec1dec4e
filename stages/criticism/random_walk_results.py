"""Rows of random walks, and of effects that noise or quality show instead of block means."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.arrays import Array
from inertial.campaign.effect_sentences import Estimated
from inertial.effects import CATALOGUE
from inertial.estimation.random_walk import NO_DRIFT, MeasuredDrift
from inertial.model_selection.cause import ONE_OF_CLASS, UNKNOWN_STRUCTURE
from inertial.sensors import PLURAL, UNITS
from inertial.tables import AXES
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import plus_minus, significant
from inertial.text.units import quantity
from stages.criticism.bias_drift import Walk
from stages.criticism.drift_at_rest import Unsteady
from stages.criticism.finding_rows import Row, TableRow, finding_id, member_rows, parameter_row
from stages.criticism.laws import WithoutLaw

WALK = "gyro_random_walk"
WALK_UNITS = {"gyro": "rad/s/√s", "accel": "m/s²/√s"}
# Effects by the beginning of their names that change the readings of a sensor though not its own.
SHARED_EFFECTS = {"gyro": ("earth", "latitude", "heading"), "accel": ("lever", "size", "table")}
NOT_TESTED = _("Not detected; section “Noise” states what the static positions show (K).")
EXPLAINED = _("Section “Noise” states a K, which what is named explains better.")
BESIDE_NAMED = _("Section “Noise” states K, for which the sigmas allow beside what is named.")
NO_FLICKER = _("The noise at rest does not show it.")
FLICKER = _("The noise at rest shows {sizes} in the order of the axes, which the sigmas allow for.")
OF_QUALITY = _("Sought in the quality of the samples: findings “{finding}”.")
WALK_SCORE = _(
    "The biases of the gyros follow a random walk of {size}, which the sigmas allow for."
)
WALK_OR = _(
    "The biases of the {sensors} change as by a random walk of {size}. It may also "
    "be {others}: this campaign cannot distinguish them."
)
WALK_ALONE = _(
    "The biases of the {sensors} change as by a random walk of {size}. Any other "
    "change without a law would look much the same."
)
WALK_AT_REST = _(
    "The biases of the {sensors} change as by a random walk of {sizes} in the order of the axes: "
    "their noise within single static stretches shows it, and the differences between the "
    "stretches no more than that."
)
UNSTEADY = _(
    "At rest the readings of the {sensors} wander by {wander} in {seconds:.0f} s, while they "
    "scatter by {scatter} from one to the next. That is no drift of a sensor: something moves the "
    "IMU slowly, or it oscillates faster than the log follows, and the sampling folds that to a "
    "slow change."
)
UNSTEADY_CONSEQUENCE = _(
    "The sigmas of all parameters allow for it as a random walk, and are large by it."
)
STEADY = _(
    "Look at the readings of a rest. Sample faster than what oscillates, or filter before "
    "sampling; and see to what the IMU stands on."
)
WALK_CONSEQUENCE = _(
    "The sigmas of all parameters allow for it; the biases are those at the middle of the campaign."
)
REPEAT = _(
    "Record the positions once more, in another order, to distinguish a random walk from others."
)
SHORTEN = _("A shorter campaign, or rotations forth and back, reduce its influence.")


def other_scores(
    walk: Walk | None, at_rest: MeasuredDrift, kept: bool, named: bool, mount: str
) -> Iterator[TableRow]:
    """Effects sought in the noise, then in the quality of samples.

    `walk`, `at_rest`: of the gyros, between stretches, if any, and by the noise at rest;
    `kept`: whether the equations hold the second; `named`: whether another cause of them is named.
    """
    measured = NO_DRIFT if named else at_rest
    walks = {WALK: WALK_SCORE.format(size=_walk_size("gyro", walk))} if walk else {}
    if walk is None and measured.walk.any():
        walks = {WALK: WALK_SCORE.format(size=_sizes(measured.walk, WALK_UNITS["gyro"]))}
    unnamed = NOT_TESTED
    if at_rest.walk.any():
        unnamed = BESIDE_NAMED if kept else EXPLAINED
    shown = measured.instability.any()
    flicker = FLICKER.format(sizes=_sizes(measured.instability, "rad/s")) if shown else NO_FLICKER
    others = [effect for effect in CATALOGUE.values() if effect.sought_in in ("noise", "quality")]
    for effect in sorted(others, key=lambda effect: effect.sought_in):  # noise comes before quality
        named = effect.name in walks
        if effect.sought_in == "quality":
            sentence = OF_QUALITY.format(finding=in_words(effect.finding))
        else:
            sentence = {"gyro_flicker": flicker, **walks}.get(effect.name, unnamed)
        yield (
            "scores",
            {
                "mount": mount,
                "effect": effect.name,
                "cause": effect.cause,
                "sought_in": effect.sought_in,
                "finding": finding_id(effect.name, mount) if named else None,
                "named": named,
                "verdict": UNKNOWN_STRUCTURE if named else "",
                "sentence": sentence,
            },
        )


def random_walk_rows(
    sensor: str,
    walk: Walk,
    unsteady: Unsteady | None,
    alternatives: Sequence[str],
    lawless: WithoutLaw,
    mount: str,
) -> Iterator[TableRow]:
    """The random walk of a sensor, `gyro` or `accel`, and the effects that may be it as well.

    With these it is one of a class. Without them it is never certain: other changes without a law,
    such as telegraph noise, look much the same; nor where something else of the sensor follows
    no law.
    """
    cause = f"{sensor}_random_walk"
    identifier = finding_id(cause, mount)
    others = [name for name in alternatives if name.startswith((sensor, *SHARED_EFFECTS[sensor]))]
    certain = bool(others) and not (sensor in lawless.structured or lawless.members[sensor])
    if lawless.owner[sensor] == cause:
        others = list(dict.fromkeys([*others, *lawless.members[sensor]]))
    sentence = (WALK_OR if others else WALK_ALONE).format(
        sensors=PLURAL[sensor],
        size=_walk_size(sensor, walk),
        others=_(" or ").join(in_words(name) for name in others),
    )
    unit = WALK_UNITS[sensor]
    finding = _walk_finding(sensor, mount, walk.size, walk.p_value, sentence)
    finding["action"] = REPEAT if others else SHORTEN
    finding["verdict"] = ONE_OF_CLASS if certain else UNKNOWN_STRUCTURE
    if unsteady is not None and not others:
        finding |= _too_fast(sensor, unsteady)
    yield "findings", finding
    yield from member_rows(identifier, mount, [cause, *others])
    sigma = walk.sigma if np.isfinite(walk.sigma) else None
    size = Estimated("K", unit, _("random walk of the biases"), walk.size, sigma)
    yield parameter_row(mount, cause, size, identifier, identifier)
    row: Row = {"mount": mount, "sensor": sensor, "value": walk.size, "sigma": sigma, "unit": unit}
    yield "random_walks", {**row, "finding": identifier}


def walk_at_rest_rows(
    sensor: str, sizes: Array, unsteady: Unsteady | None, lawless: WithoutLaw, mount: str
) -> Iterator[TableRow]:
    """The random walk that the noise at rest shows, where the stretches differ by no more.

    `sizes`: K of the three axes. That of the equations is beyond it, and 0. Where it stands for a
    structure of the residuals, the p-value is that of the structure.
    """
    cause, unit = f"{sensor}_random_walk", WALK_UNITS[sensor]
    identifier = finding_id(cause, mount)
    size = float(np.max(sizes))  # of the worst axis
    sentence = WALK_AT_REST.format(sensors=PLURAL[sensor], sizes=_sizes(sizes, unit))
    finding = _walk_finding(sensor, mount, size, lawless.structured.get(sensor), sentence)
    yield "findings", finding | ({} if unsteady is None else _too_fast(sensor, unsteady))
    others = lawless.members[sensor] if lawless.owner[sensor] == cause else ()
    yield from member_rows(identifier, mount, list(dict.fromkeys([cause, *others])))
    for axis, value in zip(AXES, sizes.tolist(), strict=True):
        meaning = _("random walk of the bias of {axis}, at rest", axis=axis)
        yield parameter_row(
            mount, cause, Estimated(f"K_{axis}", unit, meaning, value), identifier, identifier
        )
    row: Row = {"mount": mount, "sensor": sensor, "value": 0.0, "sigma": None, "unit": unit}
    yield "random_walks", {**row, "finding": identifier}


def _too_fast(sensor: str, found: Unsteady) -> dict[str, Any]:
    """What differs in the finding of a random walk that is none of a sensor."""
    unit = quantity("bias", UNITS[sensor]).laboratory
    wander, scatter = (
        f"{significant(size / unit.size, 2)} {unit.name}" for size in (found.wander, found.scatter)
    )
    words = {"wander": wander, "seconds": found.seconds, "scatter": scatter}
    return {
        "severity": 2,
        "sentence": UNSTEADY.format(sensors=PLURAL[sensor], **words),
        "consequence": UNSTEADY_CONSEQUENCE,
        "action": STEADY,
    }


def _walk_finding(
    sensor: str, mount: str, size: float, p_value: float | None, sentence: str
) -> dict[str, Any]:
    """The finding of a random walk, of which no more is certain; `size`: K."""
    cause = f"{sensor}_random_walk"
    return {
        "id": finding_id(cause, mount),
        "mount": mount,
        "cause": cause,
        "sensor": sensor,
        "count": 1,
        "size": size,
        "unit": WALK_UNITS[sensor],
        "p_value": p_value,
        "severity": 1,
        "sentence": sentence,
        "consequence": WALK_CONSEQUENCE,
        "action": SHORTEN,
        "verdict": UNKNOWN_STRUCTURE,
    }


def _sizes(sizes: Array, si: str) -> str:
    """The sizes of three axes with their unit."""
    unit = quantity("", si).laboratory
    return f"{', '.join(significant(size / unit.size, 2) for size in sizes.tolist())} {unit.name}"


def _walk_size(sensor: str, walk: Walk) -> str:
    unit = quantity("", WALK_UNITS[sensor]).laboratory
    value, sigma = walk.size / unit.size, walk.sigma / unit.size
    if not np.isfinite(sigma):
        return f"{significant(value, 2)} {unit.name}"
    return f"{plus_minus(value, sigma)} {unit.name}"
