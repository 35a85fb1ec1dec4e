"""Rows of the effects that are selected from block means."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from inertial.campaign.equations import Campaign
from inertial.effects import CATALOGUE
from inertial.estimation.variance_components import MIN_CONSISTENT_P_VALUE
from inertial.model_selection.cause import FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE, Asked
from inertial.model_selection.detection_limits import NOT_EXCITED, VISIBLE
from inertial.physics.effect import Effect
from inertial.text.cause_names import in_words
from inertial.text.numbers import decimals_of, with_sigma
from inertial.text.units import DEGREE_PER_HOUR, MICRO_G
from stages.criticism import block_sentences
from stages.criticism.bias_drift import Walk
from stages.criticism.class_splitting import TURNED_OVER, Foreseen
from stages.criticism.selection import Judged

# ---- The rows that criticism writes of causes: scores, parameters, blind spots and findings.

Row = dict[str, Any]

BOTH_SENSORS = ("gyro", "accel")
NAMED = (FOUND, ONE_OF_CLASS)
ALIKE = 6.0  # drop of chi-squared by which a position must exceed another: 95 % of 2 degrees
OF_FINDINGS = {"severity": 2, "count": 1, "unit": "sigma"}


class Rows:
    """What is said of one mount, row by row."""

    def __init__(self, campaign: Campaign, judged: Judged, foreseen: Foreseen, suffix: str) -> None:
        self.campaign, self.judged, self.suffix = campaign, judged, suffix
        self.foreseen = foreseen
        self.causes = {cause.effect: cause for cause in judged.named.causes}

    def scores(self) -> Iterator[Row]:
        """How every effect that is sought in blocks was judged."""
        reasons = {one.effect: one.reason for one in reversed(self.judged.visible)}
        for asked in self._asked():
            effect = self.judged.effect(asked.effect, asked.value)
            cause = self.causes.get(asked.effect)
            if cause is None:
                reason = reasons.get(asked.effect, NOT_EXCITED)
                told = block_sentences.of_silence(
                    effect, asked, reason, self.campaign.blind(effect)
                )
            else:
                rows = self._parameters(effect, cause.value)
                told = block_sentences.of_cause(cause, effect, rows, self._position(effect))
            named = cause is not None and cause.verdict in NAMED
            yield {
                "effect": effect.name,
                "cause": effect.cause,
                "sought_in": "blocks",
                "statistic": cause.statistic if cause else asked.statistic,
                "degrees": cause.degrees if cause else asked.degrees,
                "p_value": cause.p_value if cause else asked.after_search,
                "named": named,
                "verdict": cause.verdict if cause else "",
                "members": ", ".join(cause.members) if cause else "",
                "snr": cause.snr if cause else None,
                "at": effect.at,
                "sentence": told,
            }

    def effects(self) -> Iterator[Row]:
        """The parameters of every effect beside all that are named, and what could be seen."""
        for asked in self._asked():
            cause = self.causes.get(asked.effect)
            value = cause.value if cause else asked.value
            yield from self._parameters(self.judged.effect(asked.effect, value), value)

    def blind_spots(self) -> Iterator[Row]:
        """What this campaign could have seen of each parameter, or why nothing."""
        for one in self.judged.visible:
            effect = CATALOGUE[one.effect]
            parameter = effect.parameters[one.parameter]
            yield {
                "effect": f"{effect.name}{self.suffix}",
                "parameter": parameter.name,
                "visible": one.size if one.reason == VISIBLE else None,
                "best": one.best if one.reason == VISIBLE else None,
                "worst": one.worst if one.reason == VISIBLE else None,
                "unit": parameter.unit,
                "reason": one.reason,
                "sentence": block_sentences.of_blindness(effect, one, self.campaign.blind(effect))
                + self._advice(effect, parameter.name),
            }

    def findings(self) -> Iterator[Row]:
        """One finding for each cause, the columns of every finding and those of a cause."""
        for number, cause in enumerate(self.judged.named.causes):
            split = self.foreseen.splitting(number)
            free = cause.effect not in self.judged.families
            effect = None if free else self.judged.effect(cause.effect, cause.value)
            rows = [] if effect is None else self._parameters(effect, cause.value)
            place = self._position(effect)
            told = block_sentences.of_cause(cause, effect, rows, place)
            clear = cause.verdict in NAMED
            yield OF_FINDINGS | {
                "id": f"criticism/{cause.effect}{self.suffix}",
                "cause": cause.effect,
                "sensor": self.judged.sensor(cause),
                "manoeuvre": place or None,
                "size": cause.snr,
                "p_value": cause.p_value,
                "sentence": told,
                "consequence": "Without it bias, scale factors and cross terms take up a part of it"
                " and do not hold in other motions; the extension tells how much that is."
                if clear
                else "The joint estimate holds it as a random walk or as a scatter.",
                "action": block_sentences.ACTION + block_sentences.of_split(split)
                if clear
                else "Look at the residuals against time; record again, the IMU switched on long"
                " before.",
                "verdict": cause.verdict,
                "members": ", ".join(cause.members),
                "statistic": cause.statistic,
                "degrees": cause.degrees,
                "snr": cause.snr,
                "split_manoeuvre": split.manoeuvre if split else None,
                "split_snr": split.separation if split else None,
                "parameters": "; ".join(_in_si(row) for row in rows if row["sigma"]),
            }

    def _position(self, effect: Effect | None) -> str:
        """The positions that it may be, where positions are scanned; else empty."""
        if effect is None or effect.at is None or effect.scan is None or effect.scan.between:
            return ""
        said, family = self.judged.said, self.judged.families[effect.name]
        others = [i for n, c in self.causes.items() if n != effect.name for i in c.columns]
        asked = next(one for one in self.judged.asked if one.name == effect.name)
        drops = [said.total.drop([*columns, *others])[0] for columns in asked.candidates]
        near = [i for i in np.argsort(drops)[::-1] if drops[i] > max(drops) - ALIKE]
        return " or ".join(self.campaign.positions[int(family[i].at or 0)] for i in near)

    def _advice(self, effect: Effect, parameter: str) -> str:
        """S3 turns up at one rate and down at another: what the same rate would bring."""
        if effect.name != "gyro_scale_g_dependence" or parameter != effect.parameters[0].name:
            return ""
        shares = self.foreseen.mimicry(effect.name, "gyro_scale_quadratic", TURNED_OVER)
        if shares is None:
            return ""
        return block_sentences.of_same_rate(*shares)

    def _asked(self) -> Sequence[Asked]:
        return [one for one in self.judged.named.asked if one.effect in self.judged.families]

    def _parameters(self, effect: Effect, value: int) -> list[Row]:
        """An effect's parameters, estimated with those of the causes."""
        said = self.judged.said
        if not said.sensors:
            nothing = {"value": None, "sigma": None, "visible": None}
            told = ((one.name, one.unit, one.meaning) for one in effect.parameters)
            return [self._row(effect, *one) | nothing for one in told]
        place = {name: i for i, name in enumerate(said.names)}
        own = [place[f"{effect.label}.{parameter.name}"] for parameter in effect.parameters]
        others = [c.columns for c in self.judged.named.causes if c.effect != effect.name]
        chosen = list(dict.fromkeys([*own, *(i for columns in others for i in columns)]))
        values, covariance = said.total.estimate(chosen)
        sizes = {
            effect.parameters[one.parameter].name: one.size
            for one in self.judged.visible
            if one.effect == effect.name and one.reason == VISIBLE
        }
        rows = [
            self._row(effect, parameter.name, parameter.unit, parameter.meaning)
            | _estimate(float(values[i]), float(covariance[i, i]))
            | {"visible": sizes.get(parameter.name)}
            for i, parameter in enumerate(effect.parameters)
        ]
        if effect.scan is not None and effect.name in self.causes:
            at = effect.at or 0.0
            apart = [abs((one.at or 0.0) - at) for one in self.judged.families[effect.name]]
            step = min((one for one in apart if one), default=0.0)
            rows.append(
                self._row(effect, effect.scan.name, effect.scan.unit, effect.scan.meaning)
                | {"value": at, "visible": None}
                | {"sigma": step / 12**0.5 if effect.scan.between else None}
            )
        return rows

    def _row(self, effect: Effect, name: str, unit: str, meaning: str) -> Row:
        return {
            "id": f"criticism/{effect.name}{self.suffix}/{name}",
            "effect": effect.name,
            "parameter": name,
            "unit": unit,
            "meaning": meaning,
        }


def _estimate(value: float, variance: float) -> Row:
    seen = np.isfinite(variance) and variance > 0
    return {
        "value": value if seen else None,
        "sigma": float(np.sqrt(variance)) if seen else None,
    }


def _in_si(row: Row) -> str:
    return f"{row['parameter']} = {row['value']:.6g} ± {row['sigma']:.2g} {row['unit']}"


# ---- Effects that are not sought in means of blocks: in the noise, and in the quality of samples.

WALK = "gyro_random_walk"
SENSOR_WORDS = {"gyro": "gyros", "accel": "accelerometers"}
UNITS = {"gyro": "rad/s/√s", "accel": "m/s²/√s"}
TABLE_AND_SITE = {"gyro": ("earth", "latitude", "heading"), "accel": ("lever", "size", "table")}
ELSEWHERE = {
    "gyro_flicker": "In one campaign it is not told from a random walk, which is estimated.",
}


def noise_scores(effects: Sequence[Effect], walk: Walk | None) -> Iterator[Row]:
    """One row for each; `walk`: of the gyros, if there is one."""
    for effect in effects:
        found = effect.name == WALK and walk is not None
        if effect.name == WALK and walk is not None:
            size = _walk("gyro", walk)
            told = f"The biases of the gyros walk by {size}, which the sigmas allow for."
        elif effect.sought_in == "quality":
            told = f"The quality of the samples tells it: findings “{in_words(effect.finding)}”."
        else:
            told = ELSEWHERE.get(effect.name, "The data ask for none.")
        yield {
            "effect": effect.name,
            "cause": effect.cause,
            "sought_in": effect.sought_in,
            "statistic": 0.0,
            "degrees": 1 if found else 0,
            "p_value": 0.0 if found else 1.0,
            "named": found,
            "verdict": UNKNOWN_STRUCTURE if found else "",
            "members": effect.name if found else "",
            "snr": None,
            "at": None,
            "sentence": told,
        }


def walk_findings(
    sensor: str, walk: Walk, instead: Sequence[str], suffix: str, *, structured: bool
) -> Iterator[Row]:
    """The random walk of a sensor, `gyro` or `accel`, with the effects that may be it instead.

    With these it is one of a class. Without them it is never certain: what changes by no law, such
    as telegraph noise, looks much the same; nor where what is left of the sensor is `structured`.
    """
    cause = f"{sensor}_random_walk"
    others = [name for name in instead if name.startswith((sensor, *TABLE_AND_SITE[sensor]))]
    told = f"The biases of the {SENSOR_WORDS[sensor]} change as by a random walk of"
    told += f" {_walk(sensor, walk)}."
    if others:
        names = " or ".join(in_words(name) for name in others)
        told += f" Instead it may be {names}: this campaign cannot tell them apart."
    else:
        told += " Any other change without a law would look much the same."
    yield {
        "id": f"criticism/{cause}{suffix}",
        "cause": cause,
        "sensor": sensor,
        "count": 1,
        "size": walk.size,
        "unit": UNITS[sensor],
        "severity": 1,
        "sentence": told,
        "consequence": "The sigmas of all parameters allow for it.",
        "action": "Record the positions once more, in another order, to tell a walk from others."
        if others
        else "A shorter campaign, or turns there and back, lessen what it does.",
        "verdict": ONE_OF_CLASS if others and not structured else UNKNOWN_STRUCTURE,
        "members": ", ".join([cause, *others]),
        "parameters": f"K = {walk.size:.3g} ± {walk.sigma:.2g} {UNITS[sensor]}",
    }


def walk_row(method: str, sensor: str, walk: Walk) -> Row:
    """The random walk as the extension takes it."""
    sigma = walk.sigma if np.isfinite(walk.sigma) else None
    return {"method": method, "sensor": sensor, "walk": walk.size, "sigma": sigma}


def _walk(sensor: str, walk: Walk) -> str:
    # By K per √s a bias walks by 60 K in the root of an hour.
    size, unit = (DEGREE_PER_HOUR, "°/h") if sensor == "gyro" else (MICRO_G.size, "µg")
    value, sigma = (np.array([walk.size, walk.sigma]) / size * 60).tolist()
    return f"{' ± '.join(with_sigma(value, sigma, decimals_of(sigma)))} {unit}/√h"


# ---- What is left of the residuals when everything that was named is taken out.

EXCESS = 1.2  # chi-squared per degree that the uncertainty of the noise level does not explain


def unexplained(judged: Judged, suffix: str) -> Iterator[Row]:
    """A finding for each sensor that the named effects do not explain."""
    chosen = list(dict.fromkeys(i for cause in judged.named.causes for i in cause.columns))
    for sensor, reduced in zip(judged.said.labels, judged.said.sensors, strict=True):
        rest, degrees, p_value = judged.said.left_over(reduced, chosen)
        if p_value >= MIN_CONSISTENT_P_VALUE or rest <= EXCESS * degrees:
            continue
        times = float(np.sqrt(rest / degrees))
        yield {
            "id": f"criticism/unexplained/{sensor}{suffix}",
            "cause": "unexplained",
            "sensor": sensor,
            "count": 1,
            "size": times,
            "unit": "sigma",
            "p_value": p_value,
            "severity": 2,
            "sentence": f"The residuals of the {SENSOR_WORDS[sensor]} are {times:.1f} times what"
            " noise would leave, and no effect of the catalogue explains it.",
            "consequence": "The joint estimate holds it as a scatter between manoeuvres.",
            "action": "Look at the residuals of each manoeuvre, and how the positions were set.",
        }
