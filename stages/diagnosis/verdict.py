"""The verdict of a sensor, no better than its worst cause allows."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial
from math import degrees

from inertial.campaign.hypotheses import MODEL, TABLE_MOVING
from inertial.effects import KNOWN
from inertial.text.messages import _, plural
from inertial.text.numbers import fixed, significant
from inertial.text.parameters import CROSS, FREE, MIXTURE, SCALE, sign_of
from inertial.text.units import ARC_SECOND, ICE_POINT, STANDARD_GRAVITY, quantity
from stages.diagnosis.causes import (
    CURVE,
    INTERPOLATED,
    LEFT_OUT,
    MASKED,
    MODELLED,
    NONE,
    REPAIRED,
    Cause,
)
from stages.diagnosis.sensor_results import TWELVE, SensorResult
from stages.diagnosis.sizes_of_causes import MAX_HARMLESS_MOVE

USABLE, WITHIN_LIMITS, ON_CONDITION, NOT_USABLE = (
    "usable",
    "usable_within_limits",
    "on_condition",
    "not_usable",
)
HEADINGS = {"gyro": _("Gyros"), "accel": _("Accelerometers")}
LIMITS = {
    REPAIRED: _("set right"),
    MODELLED: _("in the model"),
    CURVE: _("corrected by a curve of the temperature: use it"),
    MASKED: _("masked: its data were not used"),
    INTERPOLATED: _("interpolated"),
    LEFT_OUT: _("left out: its manoeuvres were not used"),
}
FURTHER_TERM = _("corrected by a further term: use it")  # of an effect that readings contain
OF_SEVERAL = _("in the model, by the mean over what it may be")  # not all of it in readings
IF_SET_RIGHT = _("{sensors}: {causes}. Set right; the result is valid on condition: {conditions}.")
IF_ASSUMED = _("{sensors}: {causes}. The result is valid on condition: {conditions}.")
# What is known to no better is said of a usable result.
MAX_SCALE_SIGMA = 5e-3  # of a scale factor
MAX_CROSS_SIGMA = 5e-3  # rad, of a cross term
MOST_NAMES = 4  # of causes, or parameters, in a sentence


@dataclass(frozen=True)
class Verdict:
    """Verdict, sentence, and the condition on which the result is valid."""

    verdict: str
    sentence: str
    condition: str | None = None

    @property
    def spoilt(self) -> bool:
        """Whether a cause spoils the result, so that none of its numbers may be used."""
        return self.verdict == NOT_USABLE and self._by_cause

    _by_cause: bool = False


def verdict(
    result: SensorResult,
    causes: Sequence[Cause],
    swept: tuple[float, float] | None = None,
    *,
    only_noise: bool = False,
) -> Verdict:
    """Of one sensor: the worst that its causes, and the parameters it lacks, leave.

    `swept`: the range of temperatures, K, over which its changes in one attitude are known;
    `only_noise`: whether the campaign is a recording of the noise in one attitude.
    """
    own = [
        _bounded_tilt(cause.of(result.sensor), result)
        for cause in causes
        if result.sensor in cause.sensors
    ]
    sensors = HEADINGS[result.sensor]
    spoiling = [cause for cause in own if cause.spoils]
    if spoiling:
        sentence = _(
            "{sensors}: {causes}. Not usable: {why}.",
            sensors=sensors,
            causes=_names(spoiling),
            why=_why(spoiling),
        )
        return Verdict(NOT_USABLE, sentence, None, True)
    if swept is not None and len(result.undetermined) == len(TWELVE):
        return Verdict(WITHIN_LIMITS, _swept(sensors, swept, own))
    if only_noise and result.undetermined:
        return Verdict(WITHIN_LIMITS, _noise(sensors, own))
    if lacking := result.undetermined:
        return Verdict(NOT_USABLE, _lacking(sensors, lacking, own))
    conditions = list(dict.fromkeys(cause.condition for cause in own if cause.condition))
    if conditions:
        unconfirmed = [cause for cause in own if cause.condition]
        applied = any(cause.cure == REPAIRED for cause in unconfirmed)
        sentence = (IF_SET_RIGHT if applied else IF_ASSUMED).format(
            sensors=sensors,
            causes=_names(unconfirmed),
            conditions="; ".join(text.rstrip(".") for text in conditions),
        )
        return Verdict(ON_CONDITION, sentence + _others(own, unconfirmed), " ".join(conditions))
    if own:
        sentence = _(
            "{sensors}: usable, with these departures from the ideal: {causes}.",
            sensors=sensors,
            causes=_names(own, partial(_limit, result=result)),
        )
        return Verdict(WITHIN_LIMITS, sentence + _coarse(result))
    if coarse := _coarse(result):
        return Verdict(WITHIN_LIMITS, _("{sensors}: usable.", sensors=sensors) + coarse)
    return Verdict(
        USABLE,
        _(
            "{sensors}: usable. No fault was detected; the report states the detection limits.",
            sensors=sensors,
        ),
    )


def _bounded_tilt(cause: Cause, result: SensorResult) -> Cause:
    """The cause with what it moves of the accelerometers at most, where that is hardly anything.

    By |f| = g a rest counts by the length of its mean force alone, which a tilt by θ shortens by no
    more than g θ²/2; as if all of it went into the least uncertain bias.
    """
    if cause.main.cause != TABLE_MOVING or cause.cure != NONE or cause.moves is not None:
        return cause
    if result.sensor != "accel" or result.chosen.method != FREE or not result.bias_sigma:
        return cause
    tilts = [abs(each.cause.row["size"] or 0.0) * ARC_SECOND for each in cause.members]
    moves = sum(STANDARD_GRAVITY * tilt**2 / 2 for tilt in tilts) / result.bias_sigma
    return replace(cause, moves=moves) if moves < MAX_HARMLESS_MOVE else cause


def _coarse(result: SensorResult) -> str:
    """What of M the recording hardly tells, as a sentence that follows another one."""
    said = ""
    for names, least, percent in ((SCALE, MAX_SCALE_SIGMA, True), (CROSS, MAX_CROSS_SIGMA, False)):
        coarse = {n: s for n, s in result.matrix_sigmas.items() if n in names and s > least}
        if coarse:
            largest = max(coarse.values())
            size = (100 * largest, " %") if percent else (degrees(largest), "°")
            said += _(
                " Known to {known} (σ) only: {names}.",
                known=f"{significant(size[0], 2)}{size[1]}",
                names=", ".join(map(sign_of, sorted(coarse))),
            )
    return said


def not_recorded(sensor: str) -> Verdict:
    """Of a sensor that the campaign does not have: there is nothing to be judged."""
    return Verdict(NOT_USABLE, _("{sensors}: none is recorded.", sensors=HEADINGS[sensor]))


def _names(causes: Sequence[Cause], remark: Callable[[Cause], str] | None = None) -> str:
    """The causes in words, each with a remark; of many the first, what is harmless last."""
    causes = sorted(causes, key=_harmless)
    names = [cause.name + (f" ({remark(cause)})" if remark else "") for cause in causes]
    names = list(dict.fromkeys(names))
    rest = len(names) - MOST_NAMES
    more = plural(" and {count} further cause", " and {count} further causes", rest)
    return "; ".join(names[:MOST_NAMES]) + (more if rest > 0 else "")


def _harmless(cause: Cause) -> bool:
    """Whether nothing need be done about it."""
    return cause.cure == NONE and cause.moves is not None and cause.moves < MAX_HARMLESS_MOVE


def _limit(cause: Cause, result: SensorResult | None = None) -> str:
    """What became of a cause, in a few words; `result`: the one that it is in, where there is one.

    Of a fault of the recording that is not removed it says how large it is, and whether the sigmas
    hold it: they do where they are as large as the manoeuvres differ.
    """
    if cause.cure != NONE:
        limit = LIMITS[cause.cure]
        if cause.cure != MODELLED or result is None or not result.models(cause.main.causes):
            return limit
        terms = [bool(KNOWN[name].terms) for name in cause.main.causes & KNOWN.keys()]
        if any(terms):
            limit = FURTHER_TERM
            if not all(terms) and result.chosen.method == MIXTURE:
                limit = OF_SEVERAL
        if result.decision.joint_share:
            return _("{limit}; the sigmas include the result without it", limit=limit)
        return limit
    if cause.moves is None:  # of an effect, its scatter is; a fault of the recording is in nothing
        if cause.main.stage == MODEL:
            return _("included in the sigmas")
        if result is not None and result.covers_misfit:
            covered = _("not removed; the sigmas include by how much the manoeuvres differ")
            return f"{size}, {covered}" if (size := _size(cause)) else covered
        unknown = _("not removed, its influence not known")
        return f"{size}, {unknown}" if (size := _size(cause)) else unknown
    if _harmless(cause):
        return _("harmless")
    return _("shifts a parameter by up to {moves:.1f} σ", moves=cause.moves)


def _size(cause: Cause) -> str:
    """How large the largest of equal faults is, where it is an angle or in the unit of a sensor."""
    size, unit = cause.main.row["size"], cause.main.row["unit"] or ""
    if size is None or unit not in ("″", "rad", "rad/s", "m/s²"):
        return ""
    if unit == "″":
        return f"{significant(size, 3)}″"
    shown = quantity(cause.main.cause, unit).shown
    return f"{significant(shown.of(abs(size)), 2)} {shown.name}"


def _why(causes: Sequence[Cause]) -> str:
    moves = [cause.moves for cause in causes if cause.moves is not None]
    if moves:
        return _("it is not removed and shifts a parameter by {moves:.1f} σ", moves=max(moves))
    return _("it is not removed, and how far it moves the parameters is not known")


def _lacking(sensors: str, names: Sequence[str], own: Sequence[Cause]) -> str:
    """First the causes by which readings are not used, which may have determined them."""
    lost = [cause for cause in own if cause.cure in (LEFT_OUT, MASKED)]
    causes = _names(lost) + ". " if lost else ""
    if len(names) == len(TWELVE):
        sentence = _(
            "{sensors}: {causes}Not usable: no parameter is determined.",
            sensors=sensors,
            causes=causes,
        )
        return sentence + _others(own, lost)
    shown = ", ".join(map(sign_of, names[:MOST_NAMES]))
    sentence = _(
        "{sensors}: {causes}Not usable as a whole: {count} of 12 parameters are not determined "
        "({names}{more}).",
        sensors=sensors,
        causes=causes,
        count=len(names),
        names=shown,
        more=" …" if len(names) > MOST_NAMES else "",
    )
    return sentence + _others(own, lost)


def _swept(sensors: str, swept: tuple[float, float], own: Sequence[Cause]) -> str:
    low, high = (fixed(each - ICE_POINT, 1) for each in swept)
    return _(
        "{sensors}: {causes}. Usable to correct changes with temperature from {low} to {high} °C "
        "in the attitude that was recorded; not usable beyond that: no parameter is determined.",
        sensors=sensors,
        causes=_names(own, _limit),
        low=low,
        high=high,
    )


def _noise(sensors: str, own: Sequence[Cause]) -> str:
    causes = _names(own, _limit) + ". " if own else ""
    return _(
        "{sensors}: {causes}No calibration, noise only: one rest in one attitude was recorded, of "
        "which the terms of the noise hold.",
        sensors=sensors,
        causes=causes,
    )


def _others(own: Sequence[Cause], said: Sequence[Cause]) -> str:
    others = [cause for cause in own if cause not in said]
    if not others:
        return ""
    return plural(
        " Besides, {count} cause: {names}.",
        " Besides, {count} causes: {names}.",
        len(others),
        names=_names(others),
    )
