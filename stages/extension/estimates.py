"""The refitted model as rows, and the changes of its parameters."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import UNIT, described
from inertial.campaign.records import with_mount
from inertial.effects.temperature_model import TemperatureModel
from inertial.estimation.least_squares import Estimate, System
from inertial.estimation.scatter_and_random_walk import covering
from inertial.estimation.triad import UNKNOWNS, errors_of, linear_names
from inertial.physics.drift import Drift
from inertial.physics.effect import Effect, Reading, Truth
from inertial.physics.motion import Motion
from inertial.tables import BODY, OF_TRIAD
from inertial.text.messages import _
from inertial.text.parameters import EXTENDED, STAGES
from stages.extension.candidates import Candidate
from stages.extension.models import SelectedSizes

# ---- The parameters of a model with effects, their covariance, and how well it fits.

Row = Mapping[str, Any]

NOT_DETERMINED = _("with the effects in the model the manoeuvres do not determine it")


@dataclass(frozen=True)
class Solved:
    """The fit of a candidate for a sensor: rows of its parameters, covariance in that order.

    `effects`: the name of the effect of each row after the twelve; `constants`: rows of the numbers
    in the terms of the effects that are not estimated with them: a time, a mean temperature;
    `fitted`: the effects.
    """

    sensor: str
    rows: list[Row]
    covariance: Array
    estimate: Estimate
    random_walk: float
    effects: Sequence[str] = ()
    mount: str = ""
    constants: Sequence[Row] = ()
    method: str = EXTENDED
    fitted: Sequence[Effect] = ()

    @property
    def stage(self) -> str:
        """The stage of the joint result of this sensor."""
        return STAGES[self.sensor]

    @property
    def values(self) -> Array:
        """The values of its rows, 0 where there is none."""
        return np.array([row["value"] or 0.0 for row in self.rows])

    def with_values(self, values: Array, covariance: Array) -> "Solved":
        """The same with other values and covariance of the rows that have any."""
        sigma = np.sqrt(np.maximum(np.diag(covariance), 0.0))
        rows = [
            row if row["sigma"] is None else {**row, "value": float(value), "sigma": float(own)}
            for row, value, own in zip(self.rows, values, sigma, strict=True)
        ]
        return replace(self, rows=rows, covariance=covariance)

    @property
    def of_sensor(self) -> list[Row]:
        """The rows of the twelve parameters."""
        return self.rows[:UNKNOWNS]

    @property
    def of_effects(self) -> list[Row]:
        """The rows of the effects' parameters."""
        return self.rows[UNKNOWNS:]

    @property
    def determined(self) -> list[str]:
        """Which of the twelve parameters are determined."""
        return [row["parameter"] for row in self.of_sensor if row["value"] is not None]

    def covariance_rows(self) -> pd.DataFrame:
        """The covariance as its table has it, of the parameters that are determined."""
        there = [i for i, row in enumerate(self.rows) if row["value"] is not None]
        names = [self.rows[i]["id"] for i in there]
        return pd.DataFrame(
            {
                "first": np.repeat(names, len(names)),
                "second": np.tile(names, len(names)),
                "covariance": self.covariance[np.ix_(there, there)].ravel(),
            },
            columns=[column.name for column in tables.COVARIANCE.columns],
        )

    def fit_row(
        self, noise_degrees: float, scatter: float, scatter_seconds: float | None
    ) -> dict[str, Any]:
        """How well the model describes the data, with a scatter beyond noise."""
        return {
            "mount": self.mount,
            "sensor": self.sensor,
            "method": self.method,
            "chi_squared": self.estimate.chi_squared,
            "degrees": self.estimate.degrees,
            "p_value": self.estimate.p_value(noise_degrees),
            "scatter": scatter,
            "scatter_seconds": scatter_seconds,
            "unit": UNIT[self.stage],
            "random_walk": self.random_walk,
        }


def solved(
    sensor: str,
    system: System,
    candidate: Candidate,
    motion: Motion,
    random_walk: float,
    sizes: SelectedSizes,
    data: CampaignData,
) -> Solved:
    """The twelve parameters of a sensor and those of the effects of a candidate.

    `sizes`: what of the effects is too large for having been selected, and taken off.
    """
    estimate = sizes.applied(sensor, system, system.solve_shared())
    stage = STAGES[sensor]
    places = list(range(UNKNOWNS))
    effects: list[str] = []
    mount, by_hand = data.mount, data.by_hand is not None
    unknowns = [(name, *described(stage, name, by_hand=by_hand)) for name in linear_names()]
    for effect in candidate.effects:
        for parameter in effect.parameters:
            label = f"{effect.label}.{parameter.name}"
            place = system.column("effect", label)
            known = label in candidate.absorbed or effect.prior_sigma(parameter)
            if place is not None and (estimate.determined[place] or known):
                places.append(place)
                effects.append(effect.name)
                name = f"{effect.name}.{parameter.name}"
                frame = OF_TRIAD if by_hand else BODY
                unknowns.append((name, parameter.unit, frame, parameter.meaning))
    values = estimate.values.copy()
    values[:UNKNOWNS] = errors_of(values[:UNKNOWNS])
    effect_of = dict(zip(places[UNKNOWNS:], effects, strict=True))
    folders = [] if candidate.method == EXTENDED else [candidate.method]

    def row(name: str, unit: str, frame: str, meaning: str, effect: str | None) -> dict[str, Any]:
        return {
            "id": "/".join(["extension", *folders, with_mount(stage, mount), name]),
            "stage": "extension",
            "mount": mount,
            "sensor": sensor,
            "method": candidate.method,
            "effect": effect,
            "parameter": name,
            "value": None,
            "sigma": None,
            "unit": unit,
            "frame": frame,
            "meaning": meaning,
            "reason": NOT_DETERMINED,
        }

    rows: list[Row] = []
    for place, described_as in zip(places, unknowns, strict=True):
        rows.append(row(*described_as, effect_of.get(place)))
        if estimate.determined[place] or place in effect_of:
            value, sigma = float(values[place]), float(estimate.sigma[place])
            rows[-1] = {**rows[-1], "value": value, "sigma": sigma, "reason": ""}
    constants = [
        row(f"{effect.name}.{one.name}", one.unit, "", one.meaning, effect.name)
        | {"value": one.value, "reason": ""}
        for effect in candidate.effects
        if effect.name in effects
        for one in effect.constants(motion)
    ]
    covariance = estimate.covariance[np.ix_(places, places)]
    method = candidate.method
    return Solved(
        sensor,
        rows,
        covariance,
        estimate,
        random_walk,
        effects,
        mount,
        constants,
        method,
        candidate.effects,
    )


def unseen_components(effects: Sequence[Effect], solution: Solved) -> dict[str, float]:
    """The sigma of each component of a vector of any direction that no reading shows, by column.

    They are drawn as those that are seen: of k of these, by Student's distribution of k degrees.
    """
    rows = {row["parameter"]: row["value"] for row in solution.of_effects}
    found: dict[str, float] = {}
    for effect in effects:
        if not effect.vector:
            continue
        names = [f"{effect.name}.{parameter.name}" for parameter in effect.parameters]
        seen = [rows[name] for name in names if rows.get(name) is not None]
        if seen:
            size = covering(np.sqrt(np.mean(np.square(seen))), len(seen) + 1)
            found |= {
                column: float(size)
                for name, column in zip(names, effect.columns, strict=True)
                if name not in rows
            }
    return found


# ---- The change of each of the 24 parameters by the effects.


def moved(solution: Solved, joint: Sequence[Row], scatter: bool, mount: str) -> Iterator[Row]:
    """Each parameter by the joint and by the extended fit.

    Nested fits of the same data differ by a variance σ²(extended) − σ²(joint) (Hausman 1978), if
    both allow for the same noise; `scatter`: the joint fit treated the effect as a scatter of the
    manoeuvres, and then they do not.
    """
    before = {row["parameter"]: row for row in joint}
    for row in solution.of_sensor:
        name = row["parameter"]
        old = before.get(name, {"value": None, "sigma": None, "id": ""})
        both = row["value"] is not None and old["value"] is not None
        difference = row["value"] - old["value"] if both else None
        added = row["sigma"] ** 2 - old["sigma"] ** 2 if both and not scatter else 0.0
        yield {
            "id": row["id"],
            "joint_id": old["id"],
            "mount": mount,
            "sensor": solution.sensor,
            "parameter": name,
            "unit": row["unit"],
            "joint": old["value"],
            "joint_sigma": old["sigma"],
            "extended": row["value"],
            "extended_sigma": row["sigma"],
            "difference": difference,
            "difference_sigma": float(np.sqrt(added)) if added > 0 else None,
            "in_sigmas": difference / old["sigma"] if both and old["sigma"] else None,
        }


# ---- By how much the drifts of a model change the parameters, on average over a recording.
#
# The bias of a ramp is that of its beginning, of a warm-up that of its end, beside a temperature
# that of the mean temperature. Models that drift otherwise are compared, and mixed, by the means.

DRIFTS = (Drift, TemperatureModel)  # of the sensor, with time or temperature alone


def drift_means(solution: Solved, motion: Motion, stretches: slice) -> Iterator[Row]:
    """The rows of a fit; `stretches`: those of `motion` that are of its sensor."""
    there = {row["parameter"] for row in solution.of_effects}
    weights = motion.seconds[stretches] / motion.seconds[stretches].sum()
    for effect in solution.fitted:
        if not isinstance(effect, DRIFTS):
            continue
        for parameter, unit in zip(effect.parameters, np.eye(len(effect.parameters)), strict=True):
            name = f"{effect.name}.{parameter.name}"
            changes = changes_of(effect, unit, motion, solution.sensor)[stretches]
            means = np.nan_to_num(weights @ changes)
            for of, mean in zip(linear_names(), means.tolist(), strict=True):
                if name in there and mean:
                    yield {
                        "mount": solution.mount,
                        "sensor": solution.sensor,
                        "method": solution.method,
                        "parameter": name,
                        "of": of,
                        "mean": mean,
                    }


def changes_of(effect: Effect, values: Array, motion: Motion, sensor: str) -> Array:
    """By how much M, by rows, and bias differ in each stretch, (n, 12), to first order."""

    def read(sensed: Array) -> Array:
        every = np.broadcast_to(sensed, (len(motion.time), 3))
        nothing = Reading(np.zeros_like(every), np.zeros_like(every))
        reading = effect.reads(nothing, Truth(every, every), motion, values)
        return reading.gyro if sensor == "gyro" else reading.accel

    bias = read(np.zeros(3))
    matrix = np.stack([read(axis) - bias for axis in np.eye(3)], axis=2)
    return np.hstack([matrix.reshape(len(bias), 9), bias])
