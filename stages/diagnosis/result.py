"""The parameters that count for one sensor, with covariance: of one candidate, or of a mixture."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import hypot
from types import MappingProxyType

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.estimates import covariance_rows
from inertial.campaign.records import Row, rows_of, with_mount
from inertial.effects.temperature_model import (
    BEND,
    BENDS,
    EVERY,
    Piece,
    degree_name,
    knot_name,
    probability_name,
)
from inertial.estimation.mixture import beside_effects, disagree, mixture
from inertial.estimation.triad import UNKNOWNS, linear_names
from inertial.physics.effect import COLDEST, MEAN_TEMPERATURE, WARMEST
from inertial.text.messages import _
from inertial.text.parameters import MIXTURE, STAGES

DriftMeans = Mapping[tuple[str, str], float]  # by parameter of a drift and what it changes
NOT_BY_ALL = _("not all effects that these data may show leave it determined")


@dataclass(frozen=True)
class Result:
    """The twelve parameters of a sensor, then those of its effects.

    `rows`: as in the table of parameters; `covariance`: in their order, NaN: not determined, or a
    constant of an effect.
    """

    method: str
    rows: Sequence[Row]
    covariance: Array

    def widened(self, by: float) -> "Result":
        """The same with sigmas so many times as large."""
        rows = [row | {"sigma": row["sigma"] and row["sigma"] * by} for row in self.rows]
        return replace(self, rows=rows, covariance=self.covariance * by**2)

    def with_matrix(self, ratio: float, sigma: float) -> "Result":
        """The same with M larger by a ratio of this sigma, as by a gravity that is smaller."""
        ones = np.eye(3).ravel()
        rows, common = list(self.rows), np.zeros(len(self.rows))
        for i, row in enumerate(rows[: len(ones)]):
            if row["value"] is not None:
                common[i] = (ones[i] + row["value"]) * ratio
                of_all = row["sigma"] and hypot(row["sigma"], common[i] * sigma)
                rows[i] = row | {"value": common[i] - ones[i], "sigma": of_all}
        return replace(
            self, rows=rows, covariance=self.covariance + sigma**2 * np.outer(common, common)
        )

    def turned(self, rotation: Array, probability: float) -> "Result":
        """The mixture with the mounting as it was before a rotation (3,), rad, of the case.

        `probability`: of that rotation. These readings do not show it: M after it is
        M before times I − [θ×], and either may be what the plan takes for the case.
        """
        values = np.array([_number(row["value"]) for row in self.rows[:UNKNOWNS]])
        if not np.isfinite(values).all():
            return self
        before = values.copy()
        before[:9] += np.cross(np.eye(3) + values[:9].reshape(3, 3), rotation).ravel()
        within = self.covariance[:UNKNOWNS, :UNKNOWNS]
        weights = np.array([1 - probability, probability])
        mean, spread = mixture(np.array([values, before]), np.array([within, within]), weights)
        whole = beside_effects(spread, self.covariance, 1.0)
        sigma = np.sqrt(np.diagonal(whole))
        rows = [_mixed(row, mean[i], sigma[i]) for i, row in enumerate(self.rows[:UNKNOWNS])]
        rows = [row | {"method": MIXTURE} for row in (*rows, *self.rows[UNKNOWNS:])]
        return Result(MIXTURE, rows, whole)

    def covariance_rows(self) -> pd.DataFrame:
        """The covariance as its table has it, of the parameters that are determined."""
        there = [i for i, row in enumerate(self.rows) if row["sigma"] is not None]
        return covariance_rows([row["id"] for row in self.rows], self.covariance, there)


def result_of(
    method: str,
    parameters: Mapping[str, Sequence[Row]],
    covariance: Mapping[tuple[str, str], float],
    probability: Mapping[str, float],
    drift_means: Mapping[str, DriftMeans] = MappingProxyType({}),
) -> Result:
    """The result by a method or, where other members of its class disagree, their mixture.

    Of a drift the bias is that of its beginning, of its end, or of a temperature: they are
    compared, and mixed, by their means over the recording.

    Parameters
    ----------
    parameters : rows of the parameters by method, of this sensor and mount
    covariance : by the ids of two parameters
    probability : of the candidates that compete, by method
    drift_means : by method
    """
    members = [method, *(other for other in probability if other != method)]
    own = {each: ordered(parameters[each]) for each in members}
    spreads = {each: covariance_of(own[each], covariance) for each in members}
    rows, whole = own[method], spreads[method]
    to_means = {each: _to_means(own[each], drift_means.get(each, {})) for each in members}
    means, covariances = zip(
        *(_transformed(to_means[each], own[each], spreads[each]) for each in members), strict=True
    )
    values = np.array([each[:UNKNOWNS] for each in means])
    within = np.array([each[:UNKNOWNS, :UNKNOWNS] for each in covariances])
    weights = np.array([probability.get(each, 1.0) for each in members])
    some = weights > 0
    some[0] = True
    if len(members) > 1 and disagree(values[some], within[some]):
        mean, spread = mixture(values, within, weights)
        mixed = beside_effects(spread, covariances[0], float(weights[0] / weights.sum()))
        back = 2 * np.eye(len(rows)) - to_means[method]  # the inverse: drifts do not drift
        mean, whole = _transformed(back, rows, mixed, np.append(mean, means[0][UNKNOWNS:]))
        sigma = np.sqrt(np.diagonal(whole))
        rows = [
            _mixed(row, mean[i], sigma[i]) if i < UNKNOWNS else row for i, row in enumerate(rows)
        ]
        method = MIXTURE
    return Result(method, [_named(row) | {"method": method} for row in rows], whole)


def _to_means(rows: Sequence[Row], means: DriftMeans) -> Array:
    """What gives the parameters of the sensor their means over the recording, (n, n)."""
    place = {row["parameter"]: i for i, row in enumerate(rows)}
    transform = np.eye(len(rows))
    for (parameter, of), mean in means.items():
        if rows[place[parameter]]["sigma"] is not None:
            transform[place[of], place[parameter]] += mean
    return transform


def _transformed(
    transform: Array, rows: Sequence[Row], covariance: Array, values: Array | None = None
) -> tuple[Array, Array]:
    """Values, of the rows where none are given, and covariance; NaN stays NaN, and where it is."""
    values = np.array([_number(row["value"]) for row in rows]) if values is None else values
    unknown = np.isnan(covariance)
    changed = transform @ np.where(unknown, 0.0, covariance) @ transform.T
    moved = transform @ np.nan_to_num(values)
    return np.where(np.isnan(values), np.nan, moved), np.where(unknown, np.nan, changed)


def ordered(rows: Sequence[Row]) -> list[Row]:
    """The twelve parameters in their order, then those of the effects."""
    by_name = {row["parameter"]: row for row in rows if row["effect"] is None}
    twelve = [by_name[name] for name in linear_names() if name in by_name]
    return [*twelve, *(row for row in rows if row["effect"] is not None)]


def _named(row: Row) -> Row:
    stage = with_mount(STAGES[row["sensor"]], row["mount"])
    return {**row, "id": f"diagnosis/{stage}/{row['parameter']}", "stage": "diagnosis"}


def _mixed(row: Row, value: float, sigma: float) -> Row:
    there = bool(np.isfinite(value))
    reason = row["reason"] if there or row["value"] is None else NOT_BY_ALL
    return {
        **row,
        "value": float(value) if there else None,
        "sigma": float(sigma) if there else None,
        "reason": reason,
    }


def covariance_of(rows: Sequence[Row], covariance: Mapping[tuple[str, str], float]) -> Array:
    names = [row["id"] for row in rows]
    elements = [covariance.get((one, other), np.nan) for one in names for other in names]
    return np.array(elements).reshape(len(names), len(names))


def _number(value: float | None) -> float:
    return np.nan if value is None else float(value)


def covariance_by_ids(*covariances: pd.DataFrame) -> dict[tuple[str, str], float]:
    """The elements of some tables of covariance by the ids of the two parameters."""
    return {
        (row["first"], row["second"]): float(row["covariance"])
        for table in covariances
        for row in rows_of(table)
    }


# ---- The twelve parameters of a sensor as functions of temperature, by the result that counts.
#
# θ(T) = θ(T0) + Σ_k c_k φ_k(T) is linear in parameters of which the result has the covariance, so
# σ(T) follows without approximation: within the temperatures of the campaign, and not beyond.

TEMPERATURES = 41  # of a curve, from the coldest to the warmest
PIECES = {piece.name: piece for piece in EVERY}


def curve_rows(result: Result) -> Iterator[Row]:
    """The rows of every parameter of a sensor that depends on the temperature."""
    numbers = {row["parameter"].rpartition(".")[2]: row["value"] for row in result.rows}
    if not all(numbers.get(name) is not None for name in (MEAN_TEMPERATURE, COLDEST, WARMEST)):
        return
    at = np.linspace(numbers[COLDEST], numbers[WARMEST], TEMPERATURES)
    for own in result.rows:
        if own["effect"] is not None or own["value"] is None:
            continue
        pieces = dict(_pieces(result, own["parameter"]))
        if not pieces:
            continue
        places = [list(result.rows).index(own), *pieces]
        design = np.column_stack(
            [np.ones(len(at)), *(_shape(piece, numbers, at) for piece in pieces.values())]
        )
        value = design @ np.array([result.rows[i]["value"] for i in places], np.float64)
        spread = result.covariance[np.ix_(places, places)]
        sigma = np.sqrt(np.einsum("ti,ij,tj->t", design, spread, design))
        highest = max(piece.power for piece in pieces.values())
        degree = int(numbers.get(degree_name(own["parameter"]), highest))
        bent = degree <= 1 and any(piece.power == BEND for piece in pieces.values())
        for temperature, here, scatter in zip(at, value, sigma, strict=True):
            yield {
                "mount": own["mount"],
                "sensor": own["sensor"],
                "parameter": own["parameter"],
                "temperature": float(temperature),
                "value": float(here),
                "sigma": float(scatter),
                "unit": own["unit"],
                "order": degree,
                "knot": numbers[knot_name(own["parameter"])] if bent else None,
                "probability": numbers.get(probability_name(own["parameter"])),
                "relative_to": None,
                "not_separated": None,
            }


def _pieces(result: Result, parameter: str) -> Iterator[tuple[int, Piece]]:
    """The places in the result of the coefficients of a parameter's function."""
    for place, row in enumerate(result.rows):
        if row["effect"] is None or row["sigma"] is None:
            continue
        name = row["parameter"].partition(".")[2]
        if row["effect"].endswith(("_bias_temperature", "_scale_temperature")):
            kind = row["effect"].split("_")[1]
            piece: Piece | None = Piece(f"{kind}_{name[-1]}", 1)  # k_x of a straight line
        else:
            piece = PIECES.get(name)
        if piece is not None and piece.function == parameter:
            yield place, piece


def _shape(piece: Piece, numbers: Mapping[str, float], at: Array) -> Array:
    if piece.power <= 0:
        beyond = at - numbers[knot_name(piece.knot)]
        return np.asarray(np.maximum(beyond, 0.0) if piece.power in BENDS else 1.0 * (beyond > 0))
    return np.asarray((at - numbers[MEAN_TEMPERATURE]) ** piece.power)
