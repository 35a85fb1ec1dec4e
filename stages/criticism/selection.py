"""The named effects of one mount, and the evidence on every effect of its block means."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from inertial.arrays import Array
from inertial.campaign.effect_evidence import deviance
from inertial.campaign.equations import Campaign
from inertial.effects import CATALOGUE
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE as MIN_SHARE
from inertial.model_selection import walk_odds
from inertial.model_selection.cause import UNKNOWN_STRUCTURE, Cause, NamedCauses
from inertial.model_selection.detection_limits import Visible
from inertial.model_selection.evidence import Evidence, SearchedEffect
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from stages.criticism.bias_drift import biases_of_runs, drift_name, per_log_name
from stages.criticism.finding_rows import TableRow


@dataclass(frozen=True)
class OffManoeuvre:
    """A manoeuvre that alone carries several effects, `members`.

    `drops`: of χ² by them and their degrees of freedom, by sensor that shows them.
    """

    manoeuvre: str
    drops: Mapping[str, tuple[float, int]]
    members: tuple[str, ...]


@dataclass(frozen=True)
class Selection:
    """The named effects of one mount, and the evidence on every effect.

    `campaign`: with the random walks of its equations; `alternatives`: causes that would explain
    about as well what the random walk explains; `searched`: the columns of each effect in
    `evidence`; `families`: its candidates by its name, in the order of
    `SearchedEffect.candidates`; `limits`: the detection limits;
    `rivals`: by effect the random walk that is as likely, and the log odds of the effect;
    `of_structure`: by effect that is not significant without the readings of a sensor whose
    residuals have a structure, that sensor; `off`: the manoeuvre without which it is selected.
    """

    campaign: Campaign
    alternatives: tuple[str, ...]
    evidence: Evidence
    searched: Sequence[SearchedEffect]
    families: Mapping[str, Sequence[Effect]]
    named: NamedCauses
    limits: Sequence[Visible]
    rivals: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    of_structure: Mapping[str, str] = field(default_factory=dict)
    off: OffManoeuvre | None = None

    def prior(self, effect: SearchedEffect) -> Array:
        """The share of each value of a scan: that of its range which is nearest to it."""
        count = len(effect.candidates)
        if count == 1 or effect.free or not effect.between:
            return np.ones(count)
        return np.gradient(np.array([one.at for one in self.families[effect.name]], np.float64))

    def equations_without(self, effects: Collection[str]) -> walk_odds.Equations:
        """The evidence given all named effects but some."""
        total = self.evidence.observable().total
        given = [c.columns for c in self.named.causes if c.effect not in effects]
        equations = walk_odds.Equations(total.information, total.right)
        return equations.given(list(dict.fromkeys(i for columns in given for i in columns)))

    def half_waves(self, sensor: str) -> Sequence[Sequence[int]]:
        """The columns of the half waves of each axis."""
        return self.search_of(drift_name(sensor)).candidates[: walk_odds.AXES]

    @property
    def log_evidence(self) -> float:
        """Log evidence of the named effects beside the random walks."""
        total = self.evidence.observable().total
        equations = walk_odds.Equations(total.information, total.right)
        effects = {cause.effect for cause in self.named.causes}
        return (
            self.explained(effects, walk_odds.WeighedExplanation(0.0, equations))
            - deviance(self.campaign) / 2
            - sum(map(bool, self.random_walks)) * float(np.log(walk_odds.LOG_RANGE))
        )

    def explained(self, effects: Collection[str], first: walk_odds.WeighedExplanation) -> float:
        """The log evidence of some effects after something else is explained, and of that."""
        own = [searched for searched in self.searched if searched.name in effects]
        scanned = [(searched.candidates, self.prior(searched)) for searched in own]
        return first.log_evidence + walk_odds.laws(first.rest, scanned)

    def search_of(self, name: str) -> SearchedEffect:
        """The columns that an effect was searched with."""
        return next(one for one in self.searched if one.name == name)

    def effect(self, name: str, value: int) -> Effect:
        """A candidate."""
        return self.families[name][value]

    @property
    def effects(self) -> list[Effect]:
        """The named effects of the catalogue."""
        causes = self.named.causes
        return [self.effect(c.effect, c.value) for c in causes if c.effect in self.families]

    @property
    def fitted(self) -> list[Effect]:
        """These, and the biases of each run where they are named."""
        named = {cause.effect for cause in self.named.causes}
        own = [sensor for sensor in SENSORS if per_log_name(sensor) in named]
        runs = [run for sensor in own for run in biases_of_runs(sensor, self.campaign.motion)]
        return [*self.effects, *runs]

    @property
    def random_walks(self) -> tuple[float, float]:
        """Random walks of the biases of gyros and accelerometers, rad/s/√s and m/s²/√s."""
        return self.campaign.solution.random_walks

    def without_certain_names(self, sensors: Sequence[str]) -> "Selection":
        """The same with structure in the residuals of these sensors, so no certain name there.

        Nor of an effect of both sensors, or of the other one by the tilts of positions, that would
        not be named without their readings. That biases differ from run to run is no law, and
        stays.
        """
        if not sensors:
            return self
        of_structure = dict(self.of_structure)
        for cause in self.named.causes:
            drops = self._drops(cause)
            own = {sensor: drops.pop(sensor) for sensor in sensors}
            if self.sensor(cause) not in own and sum(drops.values()) < cause.threshold:
                of_structure[cause.effect] = max(own, key=own.__getitem__)
        moved = replace(self, of_structure=of_structure)
        causes = tuple(
            replace(cause, verdict=UNKNOWN_STRUCTURE)
            if (sensor := moved.sensor(cause)) in sensors and cause.effect != per_log_name(sensor)
            else cause
            for cause in self.named.causes
        )
        return replace(moved, named=replace(self.named, causes=causes))

    def consistent_with_rounding(self, means: Mapping[str, int]) -> "Selection":
        """The same; what coarse counts alone may bring forth is no certain name.

        means : by sensor how many of its means are off by the rounding of their readings, each by
            up to √2 of its sigma, for the error is a sine of the input and not drawn by chance
        """

        def weighed(cause: Cause) -> Cause:
            rounded = cause.snr**2 < 2 * means.get(self.sensor(cause), 0)
            return replace(cause, verdict=UNKNOWN_STRUCTURE) if rounded else cause

        causes = tuple(map(weighed, self.named.causes))
        return replace(self, named=replace(self.named, causes=causes))

    def scan_sigma(self, cause: Cause) -> float:
        """What the scanned value of a cause is uncertain by, about the one that is best.

        A time at which nothing is excited is as likely as its neighbours, so all values of the scan
        count, with their likelihood and the share of the range that each stands for.
        """
        searched = self.search_of(cause.effect)
        total = self.beside_others(cause).total
        drops = np.array([total.drop(columns)[0] for columns in searched.candidates])
        at = np.array([one.at for one in self.families[cause.effect]], np.float64)
        step = self.prior(searched) if len(at) > 1 else np.zeros(1)
        squares = (at - at[cause.value]) ** 2 + step**2 / 12  # uniform within a step
        likely = step * np.exp((drops - drops.max()) / 2)
        return float(np.sqrt(likely @ squares / likely.sum())) if likely.any() else 0.0

    def beside_others(self, cause: Cause) -> Evidence:
        """The evidence given the other causes, in units of the noise that the search found."""
        others = [i for c in self.named.causes if c is not cause for i in c.columns]
        evidence = self.evidence.given(list(dict.fromkeys(others)))
        return evidence.scaled(self.named.excesses) if self.named.excesses else evidence

    def _drops(self, cause: Cause) -> dict[str, float]:
        """The reduction of χ² by a cause in each sensor whose readings it changes, else 0."""
        evidence = self.beside_others(cause)
        raw = evidence.raw
        acts = [
            raw is None or bool((raw[number, list(cause.columns)] > 0).any())
            for number in range(len(evidence.sensors))
        ]
        drops = [sensor.drop(cause.columns)[0] for sensor in evidence.sensors]
        return dict(zip(evidence.labels, np.where(acts, drops, 0.0).tolist(), strict=True))

    def sensor(self, cause: Cause) -> str:
        """The sensor that determines a cause best, or whose structure it resembles."""
        best = self.evidence.labels[self.evidence.sensor_of(cause.columns)]
        return self.of_structure.get(cause.effect, best)

    def consistent(self) -> dict[str, list[str]]:
        """Of each sensor the causes with which the data are no more than consistent."""
        members: dict[str, list[str]] = {sensor: [] for sensor in SENSORS}
        for cause in self.named.causes:
            if cause.verdict == UNKNOWN_STRUCTURE and cause.effect in self.families:
                members[self.sensor(cause)] += cause.members
        return members


def walk_name(number: int) -> str:
    """The name of the random walk of a sensor, gyros 0, accelerometers 1."""
    return f"{SENSORS[number]}_random_walk"


# ---- Information of the campaign on effects too small to detect in it alone, for fleets.

# Those without a scan mean the same in every campaign; one that has a single size, or is absent,
# is a mistake in a statement.
POOLED = tuple(
    effect
    for effect in CATALOGUE.values()
    if effect.sought_in == "blocks" and effect.scan is None and effect.only is None
)


def pooled_evidence_rows(selection: Selection, mount: str) -> Iterator[TableRow]:
    """Score and information of the pooled effects; named effects of other kinds are fitted.

    Where the residuals exceed the noise also with the named effects, their size is what counts.
    """
    evidence = selection.evidence.observable()
    if not evidence.sensors:
        return
    if selection.named.excesses:
        evidence = evidence.scaled(selection.named.excesses)
    place = {name: i for i, name in enumerate(evidence.names)}
    own = {
        name: (effect, parameter)
        for effect in POOLED
        for name, parameter in zip(effect.columns, effect.parameters, strict=True)
        if name in place
    }
    pooled = [place[name] for name in own]
    others = {i for cause in selection.named.causes for i in cause.columns} - set(pooled)
    total = evidence.total.given(sorted(others)) if others else evidence.total
    left, whole = np.diag(total.information), np.diag(evidence.total.information)
    shown = {
        i: of for i, of in zip(pooled, own.values(), strict=True) if left[i] > MIN_SHARE * whole[i]
    }
    for i, (effect, parameter) in shown.items():
        row = {"mount": mount, "effect": effect.name, "parameter": parameter.name}
        yield "score_vector", row | {"unit": parameter.unit, "score": float(total.right[i])}
        for j, (with_effect, with_parameter) in shown.items():
            information = float(total.information[i, j])
            if j >= i and information:
                column = {"with_effect": with_effect.name, "with_parameter": with_parameter.name}
                yield "information_matrix", row | column | {"information": information}
