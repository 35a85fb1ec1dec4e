"""What counts of each sensor: the chosen result, its rivals, and what each effect moves."""

from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.hypotheses import MODEL, SLIP
from inertial.campaign.records import Row, rows_of
from inertial.estimation.probability import chi2_sf
from inertial.estimation.triad import linear_names
from inertial.text.messages import _
from inertial.text.parameters import BIAS, CROSS, FREE, JOINT, MIXTURE, SCALE, WITHOUT_ONE
from stages.diagnosis.decision import Decision, alarms_of, decided
from stages.diagnosis.result import Result, covariance_by_ids, covariance_of, ordered, result_of

CLEAR = 3.0  # sigma of an angle
MAX_CHANCE = 0.05  # p-value of an effect's size, with a larger one it moves nothing for certain
TWELVE = frozenset(linear_names())
BY_FREE_POSITIONS = _(
    "No attitude is known, so the result is that of static positions of unknown attitude."
)


class Moved(NamedTuple):
    """A parameter that an effect shifts: by how many of its sigma, its name, by how much."""

    sigmas: float
    parameter: str
    by: float
    unit: str


@dataclass(frozen=True, eq=False)
class SensorResult:
    """What counts of one sensor on one mount.

    `chosen`: the result; `candidates`: by method; `effects`: by an effect of a candidate the
    method of the likeliest candidate that has it; `decision`: which method, and why; `fits`: rows
    of the fits by method; `held_out`: rows of the candidates by method.
    """

    sensor: str
    mount: str
    chosen: Result
    candidates: Mapping[str, Result]
    effects: Mapping[str, str]
    decision: Decision
    fits: Mapping[str, Row]
    held_out: Mapping[str, Row]

    @property
    def undetermined(self) -> list[str]:
        """Those of the twelve parameters that have no value."""
        values = {r["parameter"]: r["value"] for r in self.chosen.rows if r["effect"] is None}
        return [name for name in linear_names() if values.get(name) is None]

    @property
    def drop(self) -> float | None:
        """Of chi-squared of held-out manoeuvres by the result against the joint one."""
        drop: float | None = self.held_out[self.decision.method]["drop"]
        return drop

    @property
    def covers_misfit(self) -> bool:
        """Whether the sigmas of the result include what manoeuvres differ by beyond the noise."""
        fit = self.fits.get(FREE if self.chosen.method == FREE else self.decision.method)
        scatters = fit is not None and bool(fit["scatter"] or fit["random_walk"])
        return scatters or self.decision.widened > 1

    @property
    def scale_sigma(self) -> float | None:
        """The smallest sigma of a scale factor of the result."""
        return self._smallest(SCALE)

    @property
    def matrix_sigmas(self) -> dict[str, float]:
        """The sigma of each scale factor and cross term that is determined, by its name."""
        names = {*SCALE, *CROSS}
        rows = (row for row in self.chosen.rows if row["parameter"] in names and row["sigma"])
        return {row["parameter"]: float(row["sigma"]) for row in rows}

    @property
    def bias_sigma(self) -> float | None:
        """The smallest sigma of a bias of the result."""
        return self._smallest(BIAS)

    @property
    def cross_sigma(self) -> float | None:
        """The smallest sigma of a cross-axis term of the result."""
        return self._smallest(CROSS)

    def angle(self, effect: str) -> float:
        """The largest angle of an effect by the likeliest candidate that has it, rad; 0: none."""
        method = self.effects.get(effect)
        rows = [] if method is None else self.candidates[method].rows
        own = [r for r in rows if r["effect"] == effect and r["unit"] == "rad"]
        return max((abs(row["value"]) for row in own), default=0.0)

    def slip(self, method: str) -> tuple[Array, bool]:
        """The rotation of a slip by a candidate, (3,), rad, and whether it is clear of noise."""
        rows = [row for row in self.candidates[method].rows if row["effect"] == SLIP]
        own = [row for row in rows if row["unit"] == "rad"]
        clear = any(abs(row["value"]) > CLEAR * row["sigma"] for row in own if row["sigma"])
        return np.array([row["value"] for row in own]), clear

    def _smallest(self, names: Collection[str]) -> float | None:
        rows = [row for row in self.chosen.rows if row["parameter"] in names and row["sigma"]]
        return min((row["sigma"] for row in rows), default=None)

    def models(self, effects: Collection[str]) -> bool:
        """Whether one of these effects is in the model of the result."""
        return any(row["effect"] in effects for row in self.chosen.rows)

    def shows(self, effects: Collection[str]) -> bool:
        """Whether a candidate of this sensor has one of these effects."""
        return not self.effects.keys().isdisjoint(effects)

    def moves(self, effects: Collection[str]) -> float | None:
        """The largest shift of one of the twelve parameters by one of these effects, in sigma."""
        most = self.most_moved(effects)
        return most and most.sigmas

    def most_moved(self, effects: Collection[str]) -> Moved | None:
        """The parameter of the twelve that one of these effects shifts by most of its sigma.

        In the sigma of the result; None where no candidate has such an effect, or only one whose
        size is chance: gyros know a shift in the fixture to a degree that is one of arc seconds.
        """
        rows = {row["parameter"]: row for row in self.chosen.rows if row["sigma"]}
        shifts = (
            Moved(abs(by) / rows[name]["sigma"], name, abs(by), rows[name]["unit"])
            for effect, method in self.effects.items()
            if effect in effects
            for name, by in shift(self.candidates[method], effect).items()
            if name in rows
        )
        return max(shifts, default=None)


def shift(result: Result, effect: str) -> dict[str, float]:
    """By how much each of the twelve parameters would move without an effect, by name.

    With the effect's parameters β held at zero the others move by −C_θβ C_ββ⁻¹ β, the conditional
    mean of a Gaussian. Empty where β may be zero by chance.
    """
    rows = list(result.rows)
    own = [i for i, row in enumerate(rows) if row["effect"] == effect and row["sigma"]]
    twelve = [i for i, row in enumerate(rows) if row["effect"] is None and row["sigma"]]
    if not own:
        return {}
    beta = np.array([rows[i]["value"] for i in own])
    block = result.covariance[np.ix_(own, own)]
    size = np.sqrt(np.diag(block))
    weights = np.linalg.pinv(block / np.outer(size, size), hermitian=True) @ (beta / size) / size
    if chi2_sf(beta @ weights, len(own)) > MAX_CHANCE:
        return {}
    moved = -result.covariance[np.ix_(twelve, own)] @ weights
    return {rows[i]["parameter"]: float(by) for i, by in zip(twelve, moved, strict=True)}


@dataclass(frozen=True, eq=False)
class Estimated:
    """The tables of the estimation and the extension from which the results are chosen."""

    accelerometer_parameters: pd.DataFrame
    gyroscope_parameters: pd.DataFrame
    accelerometer_covariance: pd.DataFrame
    gyroscope_covariance: pd.DataFrame
    accelerometer_fit: pd.DataFrame
    gyroscope_fit: pd.DataFrame
    extension_parameters: pd.DataFrame
    extension_covariance: pd.DataFrame
    extension_fit: pd.DataFrame
    candidates: pd.DataFrame
    candidate_effects: pd.DataFrame
    drift_means: pd.DataFrame

    @cached_property
    def _joint(self) -> list[Row]:
        """The twelve parameters of both sensors by the joint fit and free static positions."""
        return [
            row
            for table in (self.accelerometer_parameters, self.gyroscope_parameters)
            for row in rows_of(table)
            if row["method"] in (JOINT, FREE) and row["parameter"] in TWELVE
        ]

    @cached_property
    def free(self) -> frozenset[tuple[str, str]]:
        """Mounts and sensors of which no attitude is known.

        Static positions of unknown attitude take the place of the joint fit.
        """
        determined = Counter(
            (row["method"], _place(row)) for row in self._joint if row["value"] is not None
        )
        places = {place for _method, place in determined}
        return frozenset(p for p in places if determined[FREE, p] > determined[JOINT, p])

    @cached_property
    def _parameters(self) -> list[Row]:
        """By candidate, what counts as the joint fit among them.

        That of extension has the random walk of a campaign by hand.
        """
        extended = rows_of(self.extension_parameters)
        walking = {_place(row) for row in extended if row["method"] == JOINT}
        kept = [
            row | {"method": JOINT}
            for row in self._joint
            if _place(row) not in walking
            and row["method"] == (FREE if _place(row) in self.free else JOINT)
        ]
        return [*kept, *extended]

    @cached_property
    def _fits(self) -> list[Row]:
        tables = (self.accelerometer_fit, self.gyroscope_fit, self.extension_fit)
        return [row for table in tables for row in rows_of(table)]

    @cached_property
    def _covariance(self) -> dict[tuple[str, str], float]:
        return covariance_by_ids(
            self.accelerometer_covariance, self.gyroscope_covariance, self.extension_covariance
        )

    def results(self, explained: Sequence[ExplainedFindings]) -> Iterator[SensorResult]:
        """Of every sensor and mount; `explained`: the causes, of which some are alarms."""
        own = list(self._results_by_themselves(explained))
        return (_with_slip(result, own) for result in own)

    def _results_by_themselves(
        self, explained: Sequence[ExplainedFindings]
    ) -> Iterator[SensorResult]:
        roots = [each.cause.row for each in explained if each.cause.stage == MODEL]
        of_all = rows_of(self.candidates), rows_of(self.candidate_effects)
        keys = dict.fromkeys(_place(row) for row in of_all[0])
        for mount, sensor in keys:
            candidates, effects, parameters, fits = (
                [row for row in rows if _place(row) == (mount, sensor)]
                for rows in (*of_all, self._parameters, self._fits)
            )
            by_method = {
                one["method"]: [row for row in parameters if row["method"] == one["method"]]
                for one in candidates
            }
            alarms = alarms_of(roots, mount, sensor)
            determined = any(row["value"] is not None for row in by_method.get(JOINT, ()))
            decision = decided(candidates, effects, alarms, determined=determined)
            means: dict[str, dict[tuple[str, str], float]] = {}
            for row in rows_of(self.drift_means):
                if _place(row) == (mount, sensor):
                    means.setdefault(row["method"], {})[row["parameter"], row["of"]] = row["mean"]
            chosen = result_of(
                decision.method,
                by_method,
                self._covariance,
                competing(candidates, decision),
                means,
            ).widened(decision.widened)
            if decision.joint_share and chosen.method != MIXTURE:
                decision = replace(decision, reason=decision.alone, joint_share=0.0)
            if (mount, sensor) in self.free and decision.method == JOINT:
                chosen = replace(
                    chosen, method=FREE, rows=[row | {"method": FREE} for row in chosen.rows]
                )
                reason = BY_FREE_POSITIONS
                if len(candidates) > 1:
                    reason = f"{reason} {decision.reason}"
                decision = Decision(JOINT, reason)
            yield SensorResult(
                sensor,
                mount,
                chosen,
                {
                    method: Result(
                        method, rows := ordered(own), covariance_of(rows, self._covariance)
                    )
                    for method, own in by_method.items()
                },
                {
                    row["effect"]: row["method"]
                    for one in sorted(candidates, key=lambda one: float(one["probability"]))
                    for row in effects
                    if row["method"] == one["method"]
                },
                decision,
                {row["method"]: row for row in fits},
                {row["method"]: row for row in candidates},
            )


def _with_slip(result: SensorResult, every: Sequence[SensorResult]) -> SensorResult:
    """With what the other sensor may show: that the case slipped in a turn.

    Where the attitudes before and after do not show it to this sensor, its axes absorb it.
    """
    for other in every:
        method = other.effects.get(SLIP)
        if other is result or other.mount != result.mount or method is None:
            continue
        probability = float(other.held_out[method]["probability"])
        rotation, known = other.slip(method)
        if known and not result.models({SLIP}) and not other.models({SLIP}):
            return replace(result, chosen=result.chosen.turned(rotation, probability))
    return result


def competing(candidates: Sequence[Row], decision: Decision) -> dict[str, float]:
    """The probabilities of the members of a class that say something else, by method.

    Of the joint result nothing does. Those that say the same as the one that counts are one with
    it. Beside effects the joint result has the share of the decision.
    """
    if decision.method in (JOINT, WITHOUT_ONE):
        return {}
    share, odds = decision.joint_share, dict[str, float]()
    for row in candidates:
        method = decision.method if row["method"] in decision.alike else row["method"]
        odds[method] = odds.get(method, 0.0) + row["probability"] * (1 - share)
    if share:
        odds[JOINT] = odds[JOINT] + share
    return {method: probability for method, probability in odds.items() if probability > 0}


def _place(row: Row) -> tuple[str, str]:
    return row["mount"], row["sensor"]
