"""Rows of the effects that are selected from block means, and of what they leave."""

from collections.abc import Iterator, Sequence

import numpy as np

from inertial.campaign.effect_evidence import Moved, most_moved
from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.equations import NO_GYROS, Campaign
from inertial.effects import AT_GAPS, KNOWN, LAWS, TEMPERATURE_MODELS
from inertial.effects.law import Law
from inertial.effects.restarts import Restarts
from inertial.effects.warm_up import WarmUp
from inertial.estimation.effect_information import whitening
from inertial.model_selection.cause import (
    FOUND,
    LAW,
    ONE_OF_CLASS,
    Cause,
    EffectTest,
)
from inertial.model_selection.detection_limits import NOT_EXCITED, VISIBLE
from inertial.model_selection.size_after_selection import corrected
from inertial.physics.drift import SettingIn, without_clock
from inertial.physics.effect import Effect
from inertial.physics.site import EARTH_RATE
from inertial.sensors import PLURAL, UNITS
from inertial.text.messages import _
from stages.criticism import block_sentences as sentences
from stages.criticism.another_imu import another_imu
from stages.criticism.bias_drift import drift_name, per_log_name
from stages.criticism.class_splitting import TURNED_OVER, ExtendedCampaigns
from stages.criticism.confounded_causes import ASYMMETRY, jumps_not_testable, shared_asymmetry
from stages.criticism.finding_rows import (
    TableRow,
    finding_id,
    finding_row,
    member_rows,
    parameter_row,
)
from stages.criticism.laws import WithoutLaw, law_action
from stages.criticism.residual_structure import ACTION_IF_CARRIED, moved_by
from stages.criticism.restarts import first_after
from stages.criticism.rivals import carrier_of_excess
from stages.criticism.selection import Selection

NAMED = (FOUND, ONE_OF_CLASS, LAW)
MAX_RIVAL_DROP = 6.0  # of chi-squared between two positions that are both possible: 95 % of 2
MIN_KNOWN_SHARE = 1e-3  # of its information that a combination keeps beside all else, to be known
CLEAR = 3.0  # sigma of a difference of two biases, to be stated for itself
MAX_SCATTERED = 2  # manoeuvres of a run, each with a bias of its own by their scatter
MIN_EXCESS = 1.2  # of chi-squared per degree; the uncertainty of the noise level explains less

UNEXPLAINED = _(
    "The residuals of the {sensors} are {ratio:.1f} times as large as noise, and no "
    "effect of the catalogue explains it."
)
WITHOUT = _(" Without {manoeuvre} they are not.")
SCATTER = _("The joint fit allows for it as a scatter between manoeuvres.")
MAX_LISTED = 2  # manoeuvres at which a jump may be
LATER = _("{first}, or later up to {last}")
INSPECT = _("Look at the residuals of each manoeuvre, and how the positions were set.")


class BlockResults:
    """The rows of one mount."""

    def __init__(
        self,
        campaign: Campaign,
        selection: Selection,
        extended: ExtendedCampaigns,
        lawless: WithoutLaw,
        mount: str,
    ) -> None:
        self.campaign, self.selection, self.mount = campaign, selection, mount
        self.lawless = lawless
        self.extended = extended
        self.causes = {cause.effect: cause for cause in selection.named.causes}

    def rows(self) -> Iterator[TableRow]:
        """Scores and parameters of every effect, detection limits, and findings."""
        for test in self.selection.named.tests:
            if test.effect in self.selection.families:
                yield from self._of_effect(test)
        yield from self._limits()
        for number, cause in enumerate(self.selection.named.causes):
            if self._reported_in(cause) == finding_id(cause.effect, self.mount):
                yield from self._finding(number, cause)
        yield from another_imu(self.campaign, self.selection, self.mount)
        yield from jumps_not_testable(self.selection, self.mount)

    def _reported_in(self, cause: Cause) -> str:
        return self.lawless.finding(cause, self.selection.sensor(cause), self.mount)

    def _of_effect(self, test: EffectTest) -> Iterator[TableRow]:
        cause = self.causes.get(test.effect)
        value = cause.value if cause else test.value
        effect = self.selection.effect(test.effect, value)
        identifier = finding_id(effect.name, self.mount)
        parameters = self._parameters(effect)
        if cause is None:
            reasons = [
                limit.reason for limit in self.selection.limits if limit.effect == test.effect
            ]
            sentence = sentences.not_named_sentence(
                effect, test, next(iter(reasons), NOT_EXCITED), self.campaign.blind(effect)
            )
        else:
            sentence = sentences.cause_sentence(cause, effect, parameters, self._places(effect))
        yield (
            "scores",
            {
                "mount": self.mount,
                "effect": effect.name,
                "cause": effect.cause,
                "sought_in": "blocks",
                "finding": self._reported_in(cause) if cause else None,
                "statistic": _tested(test, cause.statistic if cause else test.statistic),
                "degrees": cause.degrees if cause else test.degrees or None,
                "p_value": _tested(test, cause.p_value if cause else test.after_search),
                "named": cause is not None and cause.verdict in NAMED,
                "verdict": cause.verdict if cause else "",
                "snr": cause.snr if cause else None,
                "scan_value": effect.at if effect.scan else None,
                "scan_unit": effect.scan.unit if effect.scan and effect.at is not None else None,
                "sentence": sentence,
            },
        )
        if cause is not None and effect.name == ASYMMETRY and cause.verdict in NAMED:
            yield from shared_asymmetry(parameters, self.mount)
        for parameter in parameters:
            finding = self._reported_in(cause) if cause else None
            yield parameter_row(self.mount, effect.name, parameter, finding, identifier)

    def _limits(self) -> Iterator[TableRow]:
        """The detection limit of each parameter, or why there is none."""
        moved = self._moved()
        for limit in self.selection.limits:
            effect = KNOWN[limit.effect]
            parameter = effect.parameters[limit.parameter]
            visible = limit.reason == VISIBLE
            blind = self.campaign.blind(effect)
            if limit.reason == NOT_EXCITED and not self.campaign.gyro_motions:
                blind = blind or NO_GYROS
            why = sentences.explanation(effect, limit.reason, blind)
            remark = self._same_rate(effect, parameter.name)
            sentence = sentences.limit_sentence(effect, limit, why)
            most = moved[effect.name][limit.parameter] if visible and effect.name in moved else None
            yield (
                "detection_limits",
                {
                    "mount": self.mount,
                    "effect": effect.name,
                    "parameter": parameter.name,
                    "limit": limit.size if visible else None,
                    "smallest": limit.best if visible else None,
                    "largest": limit.worst if visible else None,
                    "unit": parameter.unit,
                    "moves": most.sigmas * limit.size if most else None,
                    "moved_sensor": most.sensor if most else None,
                    "moved_parameter": most.parameter if most else None,
                    "reason": limit.reason,
                    "explanation": why,
                    "remark": remark,
                    "sentence": f"{sentence} {remark}" if remark else sentence,
                },
            )

    def _moved(self) -> dict[str, list[Moved]]:
        """By effect that is not named, what each of its parameters moves most, per SI unit."""
        families = self.selection.families
        limited = dict.fromkeys(limit.effect for limit in self.selection.limits)
        names = [name for name in limited if name in families and name not in self.causes]
        tested = [families[name][len(families[name]) // 2] for name in names]
        named = self.selection.fitted
        return dict(zip(names, most_moved(self.campaign, named, tested), strict=True))

    def _action(self, cause: Cause, parameters: Sequence[Estimated]) -> str:
        if cause.verdict not in NAMED:
            return sentences.ACTION_WITHOUT_LAW
        if cause.effect in LAWS:
            return law_action(LAWS[cause.effect], self.mount)
        free = bool(self.campaign.solution.free)
        if isinstance(effect := self.selection.families.get(cause.effect, (None,))[0], Restarts):
            if free:
                return sentences.ACTION_OF_FREE_CHANGE
            manoeuvres = first_after(self.campaign, effect.times)
            return sentences.action_against_restarts(manoeuvres)
        if cause.effect == "latitude_error":
            known = np.arcsin(self.campaign.solution.site.earth_up / EARTH_RATE)
            latitude = known + (parameters[0].value or 0.0)
            surveyed = bool(self.campaign.motion.surveyed.any())
            return sentences.action_against_latitude(latitude, surveyed=surveyed)
        if cause.effect == "heading_error":
            return sentences.action_against_heading(parameters[0].value or 0.0)
        timed = not without_clock(self.campaign.motion)
        chosen = cause.effect in self.selection.families
        effect = self.selection.effect(cause.effect, cause.value) if chosen else None
        effect = effect or KNOWN.get(cause.effect)
        return sentences.action_against(effect, timed=timed, free=free)

    def _finding(self, number: int, cause: Cause) -> Iterator[TableRow]:
        split = None if cause.effect in LAWS else self.extended.splitting(number)
        free = cause.effect not in self.selection.families
        effect = None if free else self.selection.effect(cause.effect, cause.value)
        parameters = [] if effect is None else self._parameters(effect)
        positions = self._positions(effect)
        identifier = finding_id(cause.effect, self.mount)
        clear = cause.verdict in NAMED
        sensor = self.selection.sensor(cause)
        if cause.effect == per_log_name(sensor):
            difference, sigma = self._between_runs(cause)
            sentence = sentences.per_log_sentence(cause, difference, sigma, UNITS[sensor])
            covered = self.campaign.by_hand is not None and not self._long_runs()
            size = (cause.snr, "sigma") if covered else (difference, UNITS[sensor])
        elif isinstance(effect, Restarts):
            numbers = (*self._between_runs(cause), UNITS[sensor])
            sentence = sentences.restarts_sentence(cause, sensor, effect.times, *numbers)
            size = numbers[0], UNITS[sensor]
        else:
            sentence = sentences.cause_sentence(cause, effect, parameters, self._places(effect))
            size = cause.snr, "sigma"
        yield finding_row(
            cause.effect,
            self.mount,
            sensor=sensor,
            axis=effect.one_axis if isinstance(effect, Law) else None,
            count=len(effect.times) if isinstance(effect, Restarts) else 1,
            size=size[0],
            unit=size[1],
            p_value=cause.p_value,
            sentence=sentence,
            consequence=sentences.CONSEQUENCE if clear else sentences.CONSEQUENCE_WITHOUT_LAW,
            action=self._action(cause, parameters)
            + sentences.split_sentence(split if clear else None),
            verdict=cause.verdict,
            statistic=cause.statistic,
            degrees=cause.degrees,
            threshold=cause.threshold or None,
            snr=cause.snr,
            split_manoeuvre=split.manoeuvre if split else None,
            split_snr=split.separation if split else None,
            split_stated=clear if split else None,
        )
        if cause.effect == drift_name(sensor):
            others = self.lawless.members[sensor]
            yield from member_rows(identifier, self.mount, (*cause.members, *others))
        else:
            shares = cause.weights, cause.captured
            yield from member_rows(identifier, self.mount, cause.members, *shares)
        if isinstance(effect, SettingIn):
            return  # it concerns all that follow
        for rank, (position, statistic) in enumerate(positions, 1):
            row = {"finding": identifier, "mount": self.mount, "rank": rank}
            yield "cause_positions", row | {"position": position, "statistic": statistic}

    def _between_runs(self, cause: Cause) -> tuple[float, float]:
        """The largest difference between the biases of two runs that is clear, with its sigma.

        Where none is clear by itself, the clearest. Where only combinations of the biases are
        determined, it is that of the smallest biases which have these: so large it is at least, or
        nearly.
        """
        others = [i for c in self.selection.named.causes if c is not cause for i in c.columns]
        chosen = list(dict.fromkeys([*cause.columns, *others]))
        evidence = self.selection.evidence
        known = whitening(evidence.total.information[np.ix_(chosen, chosen)], MIN_KNOWN_SHARE)
        values = known @ (known.T @ evidence.total.right[chosen])
        axes = np.array([evidence.names[i][-1] for i in cause.columns])
        pairs: list[tuple[float, float]] = []
        for axis in set(axes):
            own = np.flatnonzero(axes == axis)
            bias = np.append(values[own], 0.0)  # the last is that of the first run
            rows = np.vstack([known[own], np.zeros(known.shape[1])])
            one, other = np.triu_indices(len(bias), 1)
            sigma = np.linalg.norm(rows[one] - rows[other], axis=1)
            pairs += zip(np.abs(bias[one] - bias[other]).tolist(), sigma.tolist(), strict=True)
        determined = [(size, sigma) for size, sigma in pairs if sigma]
        clear = [pair for pair in determined if pair[0] > CLEAR * pair[1]]
        if clear:
            return max(clear)
        return max(determined, key=lambda pair: pair[0] / pair[1], default=(0.0, 0.0))

    def _long_runs(self) -> bool:
        """Whether a run holds so many manoeuvres that their scatter by hand is none of runs."""
        motion = self.campaign.motion
        return len(np.unique(motion.visit)) > MAX_SCATTERED * len(np.unique(motion.run))

    def _positions(self, effect: Effect | None) -> list[tuple[str, float]]:
        """The positions, or turns, that an effect of a single one may be at, and its χ² drop."""
        if effect is None or effect.at is None or effect.scan is None or effect.scan.between:
            return []
        total, family = self.selection.evidence.total, self.selection.families[effect.name]
        others = [i for n, c in self.causes.items() if n != effect.name for i in c.columns]
        candidates = self.selection.search_of(effect.name).candidates
        drops = [total.drop([*columns, *others])[0] for columns in candidates]
        near = [i for i in np.argsort(drops)[::-1] if drops[i] > max(drops) - MAX_RIVAL_DROP]
        if isinstance(effect, SettingIn):
            near.sort(key=lambda i: family[i].at or 0)
        names = self.campaign.places(effect)
        return [(names[int(family[i].at or 0)], float(drops[i])) for i in near]

    def _places(self, effect: Effect | None) -> list[str]:
        """The same in words; of what sets in at one of many, and stays, the first and the last."""
        names = [name for name, _ in self._positions(effect)]
        if isinstance(effect, SettingIn) and len(names) > MAX_LISTED:
            return [LATER.format(first=names[0], last=names[-1])]
        return names

    def _same_rate(self, effect: Effect, parameter: str) -> str | None:
        """The gain from turns with the axis up and down at the same rate, unlike those of S3."""
        if effect.name != "gyro_scale_g_dependence" or parameter != effect.parameters[0].name:
            return None
        shares = self.extended.mimicry(effect.name, "gyro_scale_quadratic", TURNED_OVER)
        return None if shares is None else sentences.same_rate_sentence(*shares)

    def _parameters(self, effect: Effect) -> list[Estimated]:
        """An effect's parameters, estimated with those of the causes."""
        evidence = self.selection.evidence
        if not evidence.sensors:
            return [Estimated(p.name, p.unit, p.meaning) for p in effect.parameters]
        place = {name: i for i, name in enumerate(evidence.names)}
        own = [place[name] for name in effect.columns]
        others = [c.columns for c in self.selection.named.causes if c.effect != effect.name]
        chosen = list(dict.fromkeys([*own, *(i for columns in others for i in columns)]))
        plain, of_plain = evidence.total.estimate(chosen)
        among = {column: i for i, column in enumerate(chosen)}
        named = {
            tuple(among[column] for column in cause.columns): cause.selected
            for cause in self.selection.named.causes
        }
        values, covariance = corrected(plain, of_plain, named)
        limits = {
            effect.parameters[limit.parameter].name: limit.size
            for limit in self.selection.limits
            if limit.effect == effect.name and limit.reason == VISIBLE
        }
        parameters = []
        for i, parameter in enumerate(effect.parameters):
            variance = float(covariance[i, i])
            known = np.isfinite(variance) and variance > 0
            estimate = float(values[i]) if known else None
            sigma = float(np.sqrt(variance)) if known else None
            described = (parameter.name, parameter.unit, parameter.meaning)
            limit, fitted = limits.get(parameter.name), float(plain[i]) if known else None
            parameters.append(Estimated(*described, estimate, sigma, limit, fitted))
        if effect.scan is not None and effect.name in self.causes:
            scan = effect.scan
            sigma = self.selection.scan_sigma(self.causes[effect.name]) if scan.between else None
            parameters.append(Estimated(scan.name, scan.unit, scan.meaning, effect.at, sigma))
        own_times = isinstance(effect, WarmUp) and effect.switched_on
        if own_times or effect.name in {**TEMPERATURE_MODELS, **AT_GAPS, **LAWS}:
            parameters += [
                Estimated(one.name, one.unit, one.meaning, one.value)
                for one in effect.constants(self.campaign.motion)
                if effect.scan is None or one.name != effect.scan.name
            ]
        return parameters


def _tested(test: EffectTest, number: float) -> float | None:
    """A number of a test; None where the effect was not tested, for no reading depends on it."""
    return number if test.degrees else None


def unexplained_rows(
    selection: Selection, lawless: WithoutLaw, level: float, mount: str
) -> Iterator[TableRow]:
    """A finding for each sensor whose residuals nothing explains, with a law or without.

    `level`: accepted probability of any where there is none.
    """
    chosen = list(dict.fromkeys(i for cause in selection.named.causes for i in cause.columns))
    for sensor, reduced in zip(selection.evidence.labels, selection.evidence.sensors, strict=True):
        if sensor in lawless.owner:
            continue
        rest, degrees, p_value = selection.evidence.residual(reduced, chosen)
        if p_value * len(PLURAL) >= level or rest <= MIN_EXCESS * degrees:
            continue
        ratio = float(np.sqrt(rest / degrees))
        campaign, effects = selection.campaign, selection.fitted
        carrier = carrier_of_excess(campaign, sensor, effects)
        sentence, action = UNEXPLAINED.format(sensors=PLURAL[sensor], ratio=ratio), INSPECT
        if carrier is not None:
            sentence += WITHOUT.format(manoeuvre=carrier)
            action = ACTION_IF_CARRIED.format(manoeuvres=carrier)
        yield finding_row(
            "unexplained",
            mount,
            id=finding_id(f"unexplained/{sensor}", mount),
            sensor=sensor,
            size=ratio,
            unit="sigma",
            p_value=p_value,
            sentence=sentence,
            consequence=SCATTER,
            action=action,
            moves=carrier and moved_by(campaign, sensor, [carrier], effects),
        )
