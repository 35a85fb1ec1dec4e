"""Which result of a sensor counts: the joint one, or one with effects in the model.

One with effects does where it predicts the manoeuvres not used in its fit better than the joint
one, no finding shows that the model is still incomplete, no effect rests on a single manoeuvre, and
no parameter is lost. Where these manoeuvres hold little of the effects, the joint one remains
beside it, with the weight that they give it. What a single manoeuvre alone shows may be that
manoeuvre's own error as well: with an unknown of its own it moves nothing, whatever it is; where it
is more likely something that others show too, the result is the mean over both. A manoeuvre that
alone carries a structure without a name, and moves the joint one by it, is left out.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import exp

from inertial.campaign.hypotheses import SLIP
from inertial.campaign.records import Row
from inertial.effects import KNOWN
from inertial.physics.drift import SettingIn
from inertial.sensors import PLURAL
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import significant
from inertial.text.parameters import JOINT, WITHOUT_ONE

UNKNOWN = "unknown_structure"
UNEXPLAINED = "unexplained"
RANDOM_WALKS = ("gyro_random_walk", "accel_random_walk")  # in the covariance of the joint result
OF_ONE_MANOEUVRE = frozenset(
    name
    for name, effect in KNOWN.items()
    if effect.scan and effect.scan.name in ("position", "turn")
)
# What sets in at the first or the last manoeuvre is that manoeuvre's error, for all others; but a
# slip turns the axes of all that follows.
LIKE_ONE_MANOEUVRE = OF_ONE_MANOEUVRE.union(
    name for name, effect in KNOWN.items() if isinstance(effect, SettingIn) and name != SLIP
)
TWO_LEVELS = "_telegraph_of_time"  # a law that changes nothing else where one manoeuvre has both
MAX_MOVE = 1.0  # sigma of a parameter: with more a cause that is not removed spoils the result
MIN_SNR_SQUARED = 9.0  # of the effects in held-out manoeuvres: 3 sigma
MIN_MIXED_SNR_SQUARED = 4.0  # 2 sigma: with less they tell little of whether an effect is there
MAX_WIDENED = 1.5  # times noise: smaller residuals without a name widen the sigmas, no more
MIN_SHARE = 0.1  # of the SNR², of what held-out manoeuvres bear out
MIN_BORNE_OUT = 0.5  # of the SNR²: what effects bring on held-out manoeuvres that bear them out

NO_JOINT = _("There is no joint result of the {sensors}.")
DOUBTFUL = _(
    "The joint result of the {sensors} counts, and its sigmas are doubtful: some "
    "findings are not explained ({causes})."
)
NO_EFFECT = _("The joint result of the {sensors} counts: they show no effect that was named.")
KEPT = _("The joint result of the {sensors} counts, without {effects} in its model: {reason}.")
NOT_EXPLAINED = _("beside it some findings are not explained ({causes})")
CARRIED = _("{manoeuvre} alone carries {effect}, for without it the others do not show it")
NOT_VALIDATED = _(
    "it is not cross-validatable, for the manoeuvres that can be predicted from the "
    "others hold too little of it (SNR² {snr_squared:.1f}, less than {least:.0f})"
)
NO_BETTER = _(
    "manoeuvres that the fit has not seen are predicted no better with it (χ² grows "
    "by {growth:.1f})"
)
OPEN_FORM = _(
    "they have about as many terms as the plan has rates, or attitudes, so they would fit any law, "
    "and what lies between is not confirmed"
)
SATURATED = _(
    "they have a term for nearly every manoeuvre, so they would fit anything, and none of these "
    "predicts another"
)
ONE_NOT_DETERMINED = _("beside it one parameter would not be determined")
NOT_DETERMINED = _("beside it {count} parameters would not be determined")
REPLACED = _(
    "The result of the {sensors} includes {effects}: χ² of held-out manoeuvres falls by {drop}, "
    "where exactly known effects would bring {expected}{left}."
)
REPLACED_WALK = _(
    "The result of the {sensors} includes {effects}: χ² of held-out manoeuvres falls by {drop} "
    "against the joint fit, with its random walk if it has one{left}."
)
BESIDE_WALK = _(
    "The result of the {sensors} includes {effects}: χ² of held-out manoeuvres falls by {whole} "
    "against the joint fit without its random walk, of {expected} to be expected; a random walk of "
    "the biases alone would explain all but {drop} of it{left}."
)
LITTLE = _(
    " That is {share} % of what it should be: the held-out manoeuvres hardly bear it out. Compare "
    "the sigmas with those of the joint fit."
)
NOTHING_LEFT = _(", and no finding remains unexplained")
WIDENED = _(
    "; the residuals remain {ratio} times as large as noise, and the sigmas are widened by that"
)
MIXED = _(
    " The held-out manoeuvres hold little of it (SNR² {snr_squared:.1f}, less than {least:.0f}): "
    "the result is the mean of that with it and that without it, which has the weight {share} % by "
    "how well each predicts them, and the sigmas include the difference of the two."
)
ALIKE = _(
    " The held-out manoeuvres hold little of it (SNR² {snr_squared:.1f}, less than {least:.0f}), "
    "but no parameter differs without it by more than its sigma: the result is that with it alone."
)
FREED = _(
    "The result of the {sensors} includes {effects}: that is the own error of "
    "{manoeuvres}, which no other manoeuvre shows, and no finding remains unexplained."
)
OF_CLASS = _(
    "The result of the {sensors} is the mean over {effects}, by their probability: the data show "
    "that it is one of these, and not which. No finding remains unexplained."
)
ONE_LEFT_OUT = _(
    "The result of the {sensors} is the joint one without {manoeuvre}: that alone carries a "
    "structure of the residuals without a name, and moves a parameter by {moves} σ."
)
OTHER_MEMBERS = _(
    " Instead of {effect} it may be {others}: that would do the same to these data, "
    "within their noise."
)


@dataclass(frozen=True)
class Decision:
    """Which candidate counts for a sensor, and why.

    `method`: joint, with one manoeuvre left out or not, or that of the most probable candidate with
    effects; `reason`: a sentence; `left_out`: by finding the manoeuvre that is;
    `freed`: by finding the manoeuvre whose own error it is in this candidate; `alike`: methods of
    candidates whose effects the same manoeuvres carry, which for all others say the same;
    `widened`: by how much its sigmas are, for residuals that nothing explains (Birge 1932);
    `joint_share`: the weight of the joint result beside it, in a mixture of both; `alone`: the
    reason where the two say the same, so that there is no mixture; `saturated`: the findings whose
    effects have a term for nearly every manoeuvre.
    """

    method: str
    reason: str
    freed: Mapping[str, str] = field(default_factory=dict)
    alike: frozenset[str] = frozenset()
    widened: float = 1.0
    joint_share: float = 0.0
    alone: str = ""
    left_out: Mapping[str, str] = field(default_factory=dict)
    saturated: frozenset[str] = frozenset()


def alarms_of(findings: Iterable[Row], mount: str, sensor: str) -> list[Row]:
    """The findings of criticism that no named effect explains.

    A random walk of the biases is none: it is in the covariance of the joint result.
    """
    return [
        row
        for row in findings
        if (row["mount"], row["sensor"]) == (mount, sensor)
        and row["cause"] not in RANDOM_WALKS
        and (row["verdict"] == UNKNOWN or row["cause"] == UNEXPLAINED)
    ]


def decided(
    candidates: Sequence[Row],
    effects: Sequence[Row],
    alarms: Sequence[Row] = (),
    *,
    determined: bool = True,
) -> Decision:
    """Which candidate of one sensor and mount counts.

    Parameters
    ----------
    candidates, effects : rows of extension for this sensor and mount
    alarms : findings that no named effect explains
    determined : whether the joint fit determines any parameter
    """
    sensors = PLURAL[candidates[0]["sensor"]]
    causes = _listed([alarm["cause"] for alarm in alarms])
    if not determined:
        return Decision(JOINT, NO_JOINT.format(sensors=sensors))

    def effects_of(candidate: Row) -> list[Row]:
        return [row for row in effects if row["method"] == candidate["method"]]

    best = likeliest(candidates)
    if best is None:
        if without := _without_one(candidates, alarms):
            return without
        reason = DOUBTFUL if alarms else NO_EFFECT
        return Decision(JOINT, reason.format(sensors=sensors, causes=causes))
    likely, best = best, _own_error_instead(best, candidates, effects_of)
    own = effects_of(best)
    names = _listed([row["effect"] for row in own])
    others = _other_members(own, effects)
    widened = 1.0 if _freed(own) else _widening(best, alarms)
    if against := _against(best, own, "" if widened > 1 else causes):
        kept = KEPT.format(sensors=sensors, effects=names, reason=against)
        saturated = frozenset(row["finding"] for row in own if best["saturated"])
        return Decision(JOINT, kept + others, saturated=saturated)
    if freed := _freed(own):
        if _reaches_others(effects_of(likely)):
            members = [*dict.fromkeys(row["effect"] for row in effects if row["finding"] in freed)]
            reason = OF_CLASS.format(sensors=sensors, effects=_listed(members, "or"))
            return Decision(likely["method"], reason)
        manoeuvres = ", ".join(dict.fromkeys(freed.values()))
        reason = FREED.format(sensors=sensors, effects=names, manoeuvres=manoeuvres)
        alike = [
            one["method"]
            for one in candidates
            if _carriers(effects_of(one)) == freed and not _reaches_others(effects_of(one))
        ]
        return Decision(best["method"], reason + others, freed, frozenset(alike))
    whole = best["drop_without_walk"]
    beside_walk = whole is not None and best["drop"] < whole
    replaced = REPLACED if best["drop"] <= best["snr_squared"] else REPLACED_WALK
    reason = (BESIDE_WALK if beside_walk else replaced).format(
        sensors=sensors,
        effects=names,
        whole=significant(whole, 5),
        drop=significant(best["drop"]),
        expected=significant(best["snr_squared"], 5 if beside_walk else 4),
        left=WIDENED.format(ratio=significant(widened, 2)) if widened > 1 else NOTHING_LEFT,
    )
    if not beside_walk and best["drop"] < MIN_SHARE * best["snr_squared"]:
        reason += LITTLE.format(share=significant(100 * best["drop"] / best["snr_squared"], 2))
    share, alone = _joint_share(best), ""
    if share:
        little = {"snr_squared": best["snr_squared"], "least": MIN_SNR_SQUARED}
        alone = reason + ALIKE.format(**little) + others
        reason += MIXED.format(**little, share=significant(100 * share, 2))
    return Decision(
        best["method"], reason + others, widened=widened, joint_share=share, alone=alone
    )


def _own_error_instead(
    best: Row, candidates: Sequence[Row], effects_of: Callable[[Row], list[Row]]
) -> Row:
    """The likeliest candidate by which the same findings are own errors of single manoeuvres.

    The best itself where there is none, or where other manoeuvres may bear it out.
    """
    own = effects_of(best)
    little = (best["snr_squared"] or 0.0) < MIN_SNR_SQUARED and not _joint_share(best)
    if not little and not any(row["carried_by"] for row in own):
        return best
    findings = {row["finding"] for row in own}
    errors = (one for one in candidates if _freed(effects_of(one)).keys() == findings)
    return likeliest(errors) or best


def _without_one(candidates: Sequence[Row], alarms: Sequence[Row]) -> Decision | None:
    """The joint result without the manoeuvre that alone carries all that is not explained.

    None where there is none, or where its structure moves the joint result by less than its sigma.
    """
    own = next((row for row in candidates if row["method"] == WITHOUT_ONE), None)
    if own is None or [row["cause"] for row in alarms] != [UNKNOWN]:
        return None
    (alarm,) = alarms
    if (moves := alarm["moves"]) is None or moves <= MAX_MOVE:
        return None
    sensors, manoeuvre = PLURAL[own["sensor"]], own["carried_by"]
    reason = ONE_LEFT_OUT.format(sensors=sensors, manoeuvre=manoeuvre, moves=significant(moves, 2))
    return Decision(WITHOUT_ONE, reason, left_out={alarm["id"]: manoeuvre})


def likeliest(candidates: Iterable[Row]) -> Row | None:
    """The most probable candidate with effects; None where there is none."""
    extended = [row for row in candidates if row["method"] not in (JOINT, WITHOUT_ONE)]
    return max(extended, key=lambda row: float(row["probability"]), default=None)


def _widening(best: Row, alarms: Sequence[Row]) -> float:
    """By how much the sigmas of a candidate are widened, where that is all its misfit asks for.

    What is left beside effects that predict other manoeuvres as well as they should, and is little
    more than noise, casts no doubt on them. 1 where nothing is left, or too much.
    """
    sizes = [float(row["size"]) for row in alarms if row["cause"] == UNEXPLAINED]
    few = bool(sizes) and len(sizes) == len(alarms) and max(sizes) <= MAX_WIDENED
    snr_squared, drop = best["snr_squared"] or 0.0, best["drop"] or 0.0
    proven = snr_squared >= MIN_SNR_SQUARED and drop >= MIN_BORNE_OUT * snr_squared
    return max(sizes) if few and proven else 1.0


def _joint_share(best: Row) -> float:
    """The weight of the joint result beside a candidate that held-out manoeuvres bear out.

    They hold too little of its effects to tell surely whether these are there, so that neither
    result is left out. Its odds are exp(Δχ²/2), the ratio of the densities by which the two predict
    the held-out manoeuvres (Geisser & Eddy 1979, J. Am. Stat. Assoc. 74, 153). 0 where they hold
    enough of them, or do not bear them out.
    """
    snr_squared, drop = best["snr_squared"] or 0.0, best["drop"] or 0.0
    little = MIN_MIXED_SNR_SQUARED <= snr_squared < MIN_SNR_SQUARED
    if not little or drop < MIN_BORNE_OUT * snr_squared:
        return 0.0
    return 1 / (1 + exp(drop / 2))


def _against(best: Row, effects: Sequence[Row], causes: str) -> str:
    """The objections to a candidate; empty where there are none."""
    if causes:
        return NOT_EXPLAINED.format(causes=causes)
    for row in effects:
        if row["carried_by"] and not _of_one_manoeuvre(row["effect"]):
            return CARRIED.format(manoeuvre=row["carried_by"], effect=in_words(row["effect"]))
    if best["open_form"]:
        return OPEN_FORM
    if best["saturated"]:
        return SATURATED
    if not _freed(effects):
        enough = (best["snr_squared"] or 0.0) >= MIN_SNR_SQUARED
        if not enough and not _joint_share(best):
            size = max(best["snr_squared"] or 0.0, 0.0)
            return NOT_VALIDATED.format(snr_squared=size, least=MIN_SNR_SQUARED)
        if best["drop"] <= 0:
            return NO_BETTER.format(growth=-best["drop"])
    if lost := best["undetermined"]:
        return ONE_NOT_DETERMINED if lost == 1 else NOT_DETERMINED.format(count=lost)
    return ""


def _freed(effects: Sequence[Row]) -> Mapping[str, str]:
    """By finding the manoeuvre whose own error it is; none where any is something else.

    Such an effect cannot be predicted from other manoeuvres, and need not be: in the model it only
    gives its manoeuvre an unknown of its own, so that it no longer moves the parameters.
    """
    if not all(_of_one_manoeuvre(row["effect"]) for row in effects):
        return {}
    return _carriers(effects)


def _reaches_others(effects: Sequence[Row]) -> bool:
    """Whether any changes what others say as well, though one manoeuvre alone shows it."""
    names = (row["effect"] for row in effects)
    return not all(name in LIKE_ONE_MANOEUVRE or name.endswith(TWO_LEVELS) for name in names)


def _of_one_manoeuvre(effect: str) -> bool:
    """Whether an effect that one manoeuvre alone shows is an unknown of that manoeuvre alone."""
    return effect in OF_ONE_MANOEUVRE or effect.endswith(TWO_LEVELS)


def _carriers(effects: Sequence[Row]) -> Mapping[str, str]:
    """By finding the manoeuvre that alone carries it; none where any is carried by several."""
    carriers = {row["finding"]: row["carried_by"] for row in effects}
    return carriers if all(carriers.values()) else {}


def _other_members(own: Sequence[Row], effects: Sequence[Row]) -> str:
    """What the effects may be instead."""
    return "".join(
        OTHER_MEMBERS.format(effect=in_words(row["effect"]), others=_listed(others, "or"))
        for row in own
        if (
            others := list(
                dict.fromkeys(
                    other["effect"]
                    for other in effects
                    if other["finding"] == row["finding"] and other["effect"] != row["effect"]
                )
            )
        )
    )


def _listed(causes: Sequence[str], last: str = "and") -> str:
    return listed([in_words(cause) for cause in causes], last)
