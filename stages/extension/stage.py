"""The models with the named effects, refitted: candidates for the result, and their gain."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.estimates import switch_on_columns
from inertial.campaign.linearisation import about_effects
from inertial.campaign.observations import campaign_of
from inertial.campaign.records import rows_of
from inertial.campaign.scatter_given_effects import scattered
from inertial.campaign.solution import joint_rows
from inertial.campaign.steady_residuals import steady_turns
from inertial.estimation.least_squares import System, with_columns
from inertial.estimation.scatter_and_random_walk import SwitchOns
from inertial.estimation.triad import linear_names
from inertial.physics.effect import Effect
from inertial.sensors import SENSORS
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.parameters import EXTENDED, FREE, JOINT
from stages.extension.after_switch_on import warm_up_rows, with_spreads
from stages.extension.candidates import (
    Candidate,
    candidates_of,
    carriers_of,
    normalised,
    sentence_of,
)
from stages.extension.cross_validation import CrossValidation, Trainings, cross_validate
from stages.extension.declared import DECLARED
from stages.extension.estimates import Solved, drift_means, moved, solved, unseen_components
from stages.extension.gain import gain, gain_of_line, gain_of_ripple
from stages.extension.laws import form_is_open, proposed_rows, with_drift_in_the_bias
from stages.extension.models import (
    PRIOR_SIGMA,
    Models,
    SelectedSizes,
    given,
    models_of,
    selected_sizes,
)
from stages.extension.named_effects import NamedEffects, combinations_of, compared, named_of
from stages.extension.navigation_error import change_of, worth
from stages.extension.scanned_values import of_effect, over_moments, with_scanned_values
from stages.extension.temperature_shapes import with_shapes
from stages.extension.without_one import LEFT_OUT, carried_alone, fit_without, joint_fit

Row = Mapping[str, Any]
TableRow = tuple[str, Row]

TWELVE = linear_names()


def extension(
    mounts: Sequence[CampaignData],
    simulated: Stream,
    causes: tuple[Sequence[Row], Sequence[Row], Sequence[Row], Sequence[Row]],
    structure_manoeuvres: pd.DataFrame,
    random_walks: pd.DataFrame,
    drifts_at_rest: pd.DataFrame,
    joint: Mapping[str, tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]],
    *,
    settled_accel: float,
    settled_gyro: float,
) -> Tables:
    """Candidates for the result, with parameters and covariance of each.

    Where nothing was named there is nothing to extend: the joint result is the only candidate, and
    all tables but that of the candidates are empty. Beside it is the one without a manoeuvre, where
    that alone carries a structure without a name.

    Parameters
    ----------
    causes : rows of the findings, effects, members and positions of criticism
    structure_manoeuvres : of criticism: which manoeuvres alone carry a structure without a name
    joint : by sensor, parameters, fit and manoeuvres of the joint result
    settled_accel, settled_gyro : bands about the last value of a bias, m/s² and rad/s
    """
    walk_of: dict[tuple[str, str], float] = defaultdict(float)
    walk_of |= {(row["mount"], row["sensor"]): row["value"] for row in rows_of(random_walks)}
    replaced = drifts_at_rest[~drifts_at_rest["kept"].astype(bool)]
    rows: dict[str, list[Any]] = {name: [] for name in DECLARED.writes}
    for data in mounts:
        extended = Extension(
            data,
            named_of(*causes, data.mount),
            {
                sensor: Joint(*(joint_rows(table, data.mount, method) for table in of))
                for sensor, of in joint.items()
                for method in [FREE if sensor in data.result.free else JOINT]
            },
            (walk_of[data.mount, "gyro"], walk_of[data.mount, "accel"]),
            replaced.loc[replaced["mount"] == data.mount, "sensor"].tolist(),
            {"gyro": settled_gyro, "accel": settled_accel},
            carried_alone(causes[0], rows_of(structure_manoeuvres), data.mount),
        )
        for table, row in extended.rows(simulated):
            rows[table].append(row)
    covariances = rows.pop("covariance")
    return rows | {"covariance": pd.concat(covariances) if covariances else []}


def causes_of(
    criticism_findings: pd.DataFrame,
    effects: pd.DataFrame,
    members: pd.DataFrame,
    cause_positions: pd.DataFrame,
) -> tuple[Sequence[Row], Sequence[Row], Sequence[Row], Sequence[Row]]:
    """The causes that criticism found, as rows."""
    return (
        rows_of(criticism_findings),
        rows_of(effects),
        rows_of(members),
        rows_of(cause_positions),
    )


def joint_of(
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    accelerometer_fit_manoeuvres: pd.DataFrame,
    gyroscope_fit_manoeuvres: pd.DataFrame,
) -> dict[str, tuple[pd.DataFrame, pd.DataFrame, pd.DataFrame]]:
    """The tables of the joint result by sensor."""
    return {
        "gyro": (gyroscope_parameters, gyroscope_fit, gyroscope_fit_manoeuvres),
        "accel": (accelerometer_parameters, accelerometer_fit, accelerometer_fit_manoeuvres),
    }


@dataclass(frozen=True)
class Joint:
    """Rows of the joint result of one sensor and mount; of its fit there is at most one."""

    parameters: Sequence[Row]
    fit: Sequence[Row]
    manoeuvres: Sequence[Row]


class Extension:
    """The candidates of one mount.

    `joint`: rows of the joint result, by sensor; `random_walks`: of the biases of gyros and
    accelerometers given the named effects; `replaced`: the sensors whose drift at rest is not in
    the equations; `bands`: in which a bias counts as settled, by sensor; `disturbed`: by sensor the
    fit without the one manoeuvre that carries a structure.
    """

    def __init__(
        self,
        data: CampaignData,
        named: NamedEffects,
        joint: Mapping[str, Joint],
        random_walks: tuple[float, float],
        replaced: Sequence[str],
        bands: Mapping[str, float],
        disturbed: Mapping[str, Candidate],
    ) -> None:
        self.data, self.named, self.joint, self.bands = data, named, joint, bands
        self.random_walks, self.replaced, self.disturbed = random_walks, replaced, disturbed
        self.scatters: dict[str, tuple[float, float | None]] = {}
        self.switch_ons: dict[str, SwitchOns] = {}

    def rows(self, simulated: Stream) -> Iterator[tuple[str, Any]]:
        """The rows of all tables; of `covariance` tables."""
        for row in proposed_rows(self.named.classes, self.data.mount):
            yield "proposed", row
        if self.named.classes:
            yield from self._of_blocks()
        else:
            for sensor in SENSORS:
                yield from self._candidates(sensor, [Candidate(JOINT, probability=1.0)], {}, {})
        yield from self._walking_by_hand()
        yield from self._without_one()
        if self.named.in_spectrum and self.data.result.gyro is not None:
            yield from self._of_spectrum(simulated)

    def _walking_by_hand(self) -> Iterator[tuple[str, Any]]:
        """The fits of positions of unknown attitude with the random walks that criticism found.

        Those of the accelerometers and gyros themselves have none, unlike those on a table.
        """
        for sensor, walk in zip(SENSORS, self.random_walks, strict=True):
            if walk and sensor in self.data.result.free:
                campaign = self._campaign().with_random_walks(self.random_walks)
                fit = joint_fit(campaign, sensor, Candidate(JOINT), self.data)
                yield from self._solution(fit)

    def _without_one(self) -> Iterator[tuple[str, Any]]:
        """The joint fits without a disturbed manoeuvre; no probability weighs them with others."""
        for sensor, candidate in self.disturbed.items():
            campaign = self._campaign().with_random_walks(self.random_walks)
            if solution := fit_without(campaign, sensor, candidate, self.data):
                yield from self._candidates(sensor, [candidate], {candidate.method: solution}, {})
                yield from self._solution(solution, candidate.left_out)

    def _of_blocks(self) -> Iterator[tuple[str, Any]]:
        campaign = self._campaign()
        walking = campaign.with_random_walks(self.random_walks)
        classes = compared(walking, with_spreads(walking, self.named.classes))
        combinations = combinations_of(classes)
        every = {e.label: e for c in combinations for e in c.effects if e.sought_in == "blocks"}
        models = models_of(campaign, list(every.values()), self.random_walks)
        trainings = Trainings(models)
        sizes = selected_sizes(trainings.whole, classes)
        likeliest: dict[str, Solved] = {}
        validated: dict[str, CrossValidation] = {}
        solutions: dict[str, Solved] = {}
        tested: dict[str, CrossValidation] = {}
        systems = models.complete()
        # A sensor that absorbs an effect comes after the one that shows how large it is.
        for number in sorted(range(len(SENSORS)), key=lambda n: len(models.absorbed[n])):
            sensor, system = SENSORS[number], systems[number]
            candidates = candidates_of(combinations, models.shown[number], models.absorbed[number])
            shown, of_shown = solutions, tested
            pairs = {
                candidate.method: pair
                for candidate in candidates
                if system is not None
                and candidate.effects
                and (pair := self._solved(sensor, system, candidate, models, sizes, shown))
            }
            solutions = {method: solution for method, (solution, _mean) in pairs.items()}
            tested = {
                candidate.method: validation
                for candidate in candidates
                if candidate.method in solutions
                and (
                    validation := cross_validate(trainings, sensor, candidate.columns)
                    if candidate.columns
                    else of_shown.get(candidate.method)
                )
            }
            there = [c for c in candidates if c.method in (JOINT, *solutions)]
            yield from self._candidates(sensor, normalised(there), solutions, tested, trainings)
            for _solution, mean in pairs.values():
                yield from self._solution(mean)
                drifting = drift_means(mean, campaign.motion, campaign.stretches(sensor))
                yield from (("drift_means", row) for row in drifting)
            if EXTENDED in solutions:
                likeliest[sensor] = solutions[EXTENDED]
                if tested[EXTENDED].sensor == sensor:
                    validated[sensor] = tested[EXTENDED]
                (own,) = (each.effects for each in candidates if each.method == EXTENDED)
                for row in warm_up_rows(
                    solutions[EXTENDED], own, campaign.motion, self.bands[sensor]
                ):
                    yield "warm_up", row
        of_likeliest = replace(models, effects=combinations[0].effects)
        yield from gain(of_likeliest, validated, self.data.mount)
        yield from self._worth(of_likeliest, likeliest)

    def _campaign(self) -> Campaign:
        """The equations, with what biases differ by between switch-ons, and positions by hand."""
        campaign = campaign_of(self.data).without_drift_at_rest(self.replaced)
        named = [c.members[0].effect for c in self.named.classes]
        known = [effect for effect in named if effect.scan is None or effect.at is not None]
        self.switch_ons = campaign.switch_ons(known)
        campaign = campaign.with_switch_ons(self.switch_ons)
        campaign = about_effects(campaign, known, PRIOR_SIGMA)
        if campaign.by_hand:
            campaign = scattered(campaign, known, self.data.noise.degrees)
        if by_hand := campaign.by_hand:
            self.scatters = {
                "gyro": (by_hand.scatter.rate, by_hand.scatter_seconds),
                "accel": (by_hand.force_scatter, None),
            }
        return campaign

    def _solved(
        self,
        sensor: str,
        system: System,
        candidate: Candidate,
        models: Models,
        sizes: SelectedSizes,
        shown: Mapping[str, Solved],
    ) -> tuple[Solved, Solved] | None:
        """The fit, and its mean over shapes of functions of temperature; None without an effect.

        `shown`: by method the fits of the sensor that shows what this one absorbs.
        """
        told = shown[candidate.method].of_effects if candidate.method in shown else []
        by_name = {row["parameter"]: (row["value"], row["sigma"]) for row in told if row["sigma"]}
        sized = {
            column: by_name[name]
            for effect in candidate.effects
            for name, column in zip(of_effect(effect), effect.columns, strict=True)
            if column in candidate.absorbed and name in by_name
        }
        # The moment of what the other sensor tells is told by it, too.
        own_moments = [e for e in candidate.effects if sized.keys().isdisjoint(e.columns)]
        walk = self.random_walks[SENSORS.index(sensor)]
        motion = models.extended.motion

        def system_of(further: Sequence[Effect] = ()) -> System:
            every = models.extended.system(sensor, [*candidate.effects, *further], PRIOR_SIGMA)
            assert every is not None  # there is one without them
            names = {name for effect in further for name in effect.columns}
            columns = frozenset({*candidate.columns, *sized, *names})
            alike = told_of_equals(candidate.effects, further, sized)
            return given(with_columns(every, columns), sized | alike)

        own = given(with_columns(system, frozenset({*candidate.columns, *sized})), sized)
        solution = solved(sensor, own, candidate, motion, walk, sizes, self.data)
        if unseen := unseen_components(candidate.effects, solution):
            sized |= {name: (0.0, sigma) for name, sigma in unseen.items()}
            candidate = replace(candidate, absorbed=(*candidate.absorbed, *unseen))
            solution = solved(sensor, system_of(), candidate, motion, walk, sizes, self.data)

        if not solution.effects:
            return None
        solution = with_scanned_values(solution, candidate.effects, system_of)
        solution = over_moments(
            solution, own_moments, candidate.effects, models.effects, motion, system_of
        )
        mean = with_shapes(solution, candidate.effects, motion, system_of)
        stretches = models.extended.stretches(sensor)
        return solution, with_drift_in_the_bias(mean, candidate.effects, motion, stretches)

    def _solution(self, solution: Solved, without: str | None = None) -> Iterator[tuple[str, Any]]:
        """The rows of a fit, and of the likeliest how far its parameters move.

        `without`: a manoeuvre that is not used.
        """
        sensor, mount = solution.sensor, self.data.mount
        yield "covariance", solution.covariance_rows()
        lacking = {row["parameter"]: row for row in self._joint_of(sensor) if row["value"] is None}
        for row in (*solution.rows, *solution.constants):
            of_plan = row["value"] is None and row["parameter"] in lacking
            reason = lacking[row["parameter"]]["reason"] if of_plan else row["reason"]
            yield "parameters", {**row, "reason": reason}
        between = switch_on_columns(self.switch_ons.get(sensor))
        scatter, seconds = self.scatters.get(sensor, (0.0, None))
        yield "fit", solution.fit_row(self.data.noise.degrees, scatter, seconds) | between
        for row in self.joint[sensor].manoeuvres:
            left_out = row["manoeuvre"] == without and row["used"]
            omitted = {"used": False, "reason": LEFT_OUT} if left_out else {}
            yield "fit_manoeuvres", {**row, "method": solution.method, **omitted}
        if solution.method == EXTENDED:
            own = self._joint_of(sensor)
            scatter = any(row["scatter"] for row in self.joint[sensor].fit)
            yield from (("moved", row) for row in moved(solution, own, scatter, mount))

    def _worth(self, models: Models, likeliest: Mapping[str, Solved]) -> Iterator[TableRow]:
        """The errors of navigation by the effects, of the likeliest members."""
        triads = {"gyro": self.data.result.gyro, "accel": self.data.result.accelerometer}
        changes = {
            sensor: change
            for sensor, solution in likeliest.items()
            if (triad := triads[sensor]) is not None
            and (change := change_of(solution, triad)) is not None
        }
        for row in worth(models.extended, models.effects, changes, self.data.mount):
            yield "worth", row

    def _joint_of(self, sensor: str) -> list[Row]:
        """The rows of the twelve parameters of the joint result."""
        return [row for row in self.joint[sensor].parameters if row["parameter"] in TWELVE]

    def _candidates(
        self,
        sensor: str,
        candidates: Sequence[Candidate],
        solutions: Mapping[str, Solved],
        tested: Mapping[str, CrossValidation],
        trainings: Trainings | None = None,
    ) -> Iterator[TableRow]:
        """The rows of the candidates of a sensor and of their effects."""
        before = [row["parameter"] for row in self._joint_of(sensor) if row["value"] is not None]
        for candidate in candidates:
            method = candidate.method
            own = {"mount": self.data.mount, "sensor": sensor, "method": method}
            carriers = {} if trainings is None else carriers_of(trainings, sensor, candidate)
            for effect in candidate.effects:
                yield (
                    "candidate_effects",
                    {
                        **own,
                        "effect": effect.name,
                        "finding": candidate.findings[effect.name],
                        "carried_by": carriers[effect.name],
                    },
                )
            validated, solution = tested.get(method), solutions.get(method)
            after = solution.determined if solution else before
            carried = list(dict.fromkeys(name for name in carriers.values() if name))
            yield (
                "candidates",
                {
                    **own,
                    "probability": candidate.probability,
                    "drop": validated.drop_against_walk if validated else None,
                    "drop_without_walk": validated.drop
                    if validated and validated.walk_drop
                    else None,
                    "snr_squared": validated.expected_drop if validated else None,
                    "folds": len(validated.folds) if validated else None,
                    "counted": len(validated.counted) if validated else None,
                    "carried_by": carried[0] if carried else candidate.left_out,
                    "undetermined": len(set(before) - set(after)),
                    "open_form": trainings is not None
                    and form_is_open(sensor, candidate, trainings.models.extended),
                    "saturated": len(candidate.effects) > 1
                    and validated is not None
                    and validated.saturated
                    and not carried,
                    "sentence": sentence_of(candidate, validated, carriers),
                },
            )

    def _of_spectrum(self, simulated: Stream) -> Iterator[TableRow]:
        """The gain of an oscillation, and of what depends on the table's angle."""
        turns, mount = steady_turns(self.data, simulated), self.data.mount
        for effect, values in self.named.in_spectrum.items():
            if effect != "oscillation":
                yield from gain_of_ripple(turns, effect, values, mount)
            elif "frequency" in values:
                yield from gain_of_line(turns, values["frequency"], mount)


def told_of_equals(
    effects: Sequence[Effect], others: Sequence[Effect], told: Mapping[str, tuple[float, float]]
) -> dict[str, tuple[float, float]]:
    """What is told of the parameters of effects, by the columns of equal ones in other forms.

    Another form, as of a function of temperature, may lack some of them and have more.
    """
    return {
        f"{other.label}.{parameter.name}": told[name]
        for effect in effects
        for other in others
        if other.name == effect.name
        for parameter in other.parameters
        if (name := f"{effect.label}.{parameter.name}") in told
    }


STAGE = Stage(
    extension,
    DECLARED,
    gathers={**MOUNTS, "causes": causes_of, "joint": joint_of},
)
