"""How large causes are, what their model gains, and by how much they move the result."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.effect_sentences import Estimated, effect_sentence
from inertial.campaign.hypotheses import MOUNTINGS, PLAN, Findings, Hypothesis
from inertial.campaign.records import Row, rows_of, sizes_of_result
from inertial.effects import KNOWN, TEMPERATURE_MODELS
from inertial.effects.restarts import Restarts
from inertial.sensors import PLURAL
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.parameters import AXES, sign_of
from inertial.text.units import STANDARD_GRAVITY, quantity
from stages.diagnosis.sensor_results import SensorResult

PLACES = ("frequency", "n", "phase")  # parameters of lines: where they are, not how large
MAX_HARMLESS_MOVE = 0.5  # sigma of a parameter: what a cause may move and be harmless
MIN_CLEAR_SIGMA = 4.0  # of a parameter: the effect is in its axis


SINE_AND_COSINE = ("a", "b")  # of what is periodic in an angle


@dataclass(frozen=True)
class Size:
    """How large an effect is by its clearest parameter, and its axis where it is one alone."""

    value: float | None
    sigma: float | None
    unit: str
    axis: str | None = None


def by_result(effects: Iterable[Row], results: Sequence[SensorResult]) -> list[Row]:
    """The rows of criticism's table of effects, with value and sigma of a result that has them."""
    of_result = sizes_of_result(row for result in results for row in result.chosen.rows)
    return [
        row | {key: own[key] for key in ("value", "sigma")}
        if (own := of_result.get((row["mount"], row["effect"], row["parameter"])))
        else row
        for row in effects
    ]


def sentences(
    explained: Sequence[ExplainedFindings],
    findings: Findings,
    before: Sequence[Row],
    now: Sequence[Row],
) -> Iterator[tuple[str, str]]:
    """By finding the sentence of an effect of the catalogue, with its sizes `now`.

    Of causes, and of effects that are consequences of these.

    before : the rows from which criticism made its sentence
    """
    positions = sorted(rows_of(findings.cause_positions), key=lambda row: int(row["rank"]))
    for cause in (one for each in explained for one in each.consequences):
        effect = KNOWN.get(cause.cause)
        if effect is None or not cause.named:
            continue
        at = [row["position"] for row in positions if row["finding"] == cause.id]
        old, new = (
            effect_sentence(
                effect.name,
                effect.cause,
                [_estimated(row) for row in rows if row["finding"] == cause.id],
                cause.verdict,
                cause.members,
                at,
            )
            for rows in (before, now)
        )
        # Criticism reports more of some effects, such as where a line is: that stays as it is.
        if cause.row["sentence"] == old:
            yield cause.id, new


def _estimated(row: Row) -> Estimated:
    return Estimated(row["parameter"], row["unit"], row["meaning"], row["value"], row["sigma"])


def sizes(effects: Iterable[Row]) -> dict[str, Size]:
    """By finding the parameter that is clearest in its sigma.

    What is scanned, a time, a frequency or an order, is where an effect is, not how large.
    """
    by_finding: dict[str, list[Row]] = {}
    for row in effects:
        effect = KNOWN.get(row["effect"])
        scanned = effect is not None and effect.scan is not None and effect.scan.name
        if isinstance(effect, Restarts):  # by how much runs differ, of which each is but one
            continue
        if row["finding"] and row["sigma"] and row["parameter"] not in (scanned, *PLACES):
            by_finding.setdefault(row["finding"], []).append(row)
    return {finding: _size(rows) for finding, rows in by_finding.items()}


def _size(rows: Sequence[Row]) -> Size:
    """Of an effect with a parameter for each axis the axis, where only one is clear.

    Of a sine and a cosine it is the amplitude of both together.
    """
    if tuple(row["parameter"].rpartition(".")[2] for row in rows) == SINE_AND_COSINE:
        both, sigmas = (np.array([row[key] for row in rows], float) for key in ("value", "sigma"))
        amplitude = float(np.linalg.norm(both))
        return Size(amplitude, float(np.linalg.norm(both * sigmas)) / amplitude, rows[0]["unit"])
    best = max(rows, key=_sigmas)
    clear = [i for i, row in enumerate(rows) if _sigmas(row) > MIN_CLEAR_SIGMA]
    each_axis = len(rows) == len(AXES) and rows[0]["effect"] not in TEMPERATURE_MODELS
    axis = AXES[clear[0]] if each_axis and len(clear) == 1 else None
    return Size(best["value"], best["sigma"], best["unit"], axis)


def _sigmas(row: Row) -> float:
    return abs(float(row["value"]) / float(row["sigma"]))


# ---- By how many of its sigma a cause moves a parameter, where no model of the readings says it.

CLOCK = "clock_scale"
OF_ENCODER = ("encoder_scale", "encoder_scale_or_eccentricity", "encoder_angles")
RATE_OFF, TABLE_RATE_OFF = "rate_off", "table_rate_off"


def moved_by(repair: Row, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma a stated value would have moved the scale factors."""
    if repair["value"] is None or repair["stated"] is None or not repair["value"]:
        return None
    relative = abs(repair["stated"] / repair["value"] - 1)
    sigmas = [sigma for result in own if (sigma := result.scale_sigma) is not None]
    return relative / min(sigmas) if sigmas else None


def moved_by_turning(
    showing: Sequence[SensorResult], others: Sequence[SensorResult]
) -> list[float]:
    """Upper bound, in sigma, of the change of cross-axis terms of the other sensor.

    All its rotations may be before or all after the shift: then its terms hold for one of the two
    mountings, and its residuals show nothing.
    """
    angles = (result.angle(effect) for result in showing for effect in MOUNTINGS)
    angle = max(angles, default=0.0)
    sigmas = [result.cross_sigma for result in others]
    return [angle / sigma for sigma in sigmas if sigma and angle]


def moved_by_runs(difference: float, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma the bias is that of no run, where that of two runs differs."""
    sigmas = [sigma for result in own if (sigma := result.bias_sigma) is not None]
    return difference / 2 / min(sigmas) if sigmas else None


def moved_by_measure(cause: Hypothesis, own: Sequence[SensorResult]) -> float | None:
    """By how many sigma a clock or an encoder that is off by a share moves the parameters.

    Angles move the scale factors of the gyros. Of a clock by which increments are specific forces,
    one of two opposite rests reads g (1 + error): half of that goes into the scale factor, half of
    g times it into the bias. This is the difference between the results for wrong stamps and
    for a wrong sampling interval.
    """
    size = abs(cause.row["size"] or 0.0)
    if cause.cause in (RATE_OFF, TABLE_RATE_OFF) and cause.stage == PLAN:
        shares = [(abs(size - 1), result.scale_sigma) for result in own]
    elif cause.cause in OF_ENCODER:
        shares = [(size, result.scale_sigma) for result in own]
    elif cause.cause == CLOCK and cause.sensor == "gyro":
        shares = [(1e-6 * size, result.scale_sigma) for result in own]
    elif cause.cause == CLOCK and cause.sensor == "accel":
        shares = [
            (1e-6 * size / 2 * unit, sigma)
            for result in own
            for unit, sigma in ((1.0, result.scale_sigma), (STANDARD_GRAVITY, result.bias_sigma))
        ]
    else:
        return None
    return max((share / sigma for share, sigma in shares if sigma), default=None)


def turns_of(cause: Hypothesis, own: Sequence[SensorResult]) -> dict[str, float]:
    """By how many sigma it turns the axes of a sensor that does not show it, if it is that shift.

    Where a shift is one of a class.
    """
    if (cause.causes - {cause.cause}).isdisjoint(MOUNTINGS):
        return {}
    others = [result for result in own if not result.shows(MOUNTINGS)]
    return {r.sensor: move for r in others for move in moved_by_turning(own, [r])}


def gain_of(cause: Hypothesis, drop: float | None, own: Sequence[SensorResult]) -> str | None:
    """What it gains, with the other effects of that result."""
    repair = cause.repair
    if repair is not None and repair["fitting_after"] != repair["fitting_before"]:
        return _(
            "With it {after} of {all} observations fit the plan, without it {before}.",
            after=repair["fitting_after"],
            before=repair["fitting_before"],
            all=repair["observations"],
        )
    having = [result for result in own if result.models(cause.causes) and result.drop == drop]
    if drop is None or not having:
        return None
    rows = having[0].chosen.rows
    others = dict.fromkeys(row["effect"] for row in rows if row["effect"])
    together = [in_words(name) for name in others if name not in cause.causes]
    return _(
        "χ² of the held-out manoeuvres of the {sensors} falls by {drop}{together}.",
        sensors=PLURAL[having[0].sensor],
        drop=significant(drop),
        together=_(", together with {others}", others=listed(together)) if together else "",
    )


def most_moved_by(cause: Hypothesis, moves: float | None, own: Sequence[SensorResult]) -> str:
    """Which parameter it shifts by `moves` of its sigma, as a sentence; "" where none is known."""
    each = ((result.most_moved(cause.causes), result) for result in own)
    for most, result in each:
        if most is not None and most.sigmas == moves and moves > MAX_HARMLESS_MOVE:
            shown = quantity(most.parameter, most.unit).shown
            return _(
                "Most of all {parameter} of the {sensors}, by {by} {unit}. ",
                parameter=sign_of(most.parameter),
                sensors=PLURAL[result.sensor],
                by=significant(shown.of(most.by), 2),
                unit=shown.name,
            )
    return ""
