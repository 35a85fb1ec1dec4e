"""The twelve parameters of a sensor as functions of temperature, by the result that counts.

θ(T) = θ(T0) + Σ_k c_k φ_k(T) is linear in parameters of which the result has the covariance, so
σ(T) follows without approximation: within the temperatures of the campaign, and not beyond.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from inertial.arrays import Array
from inertial.campaign.records import Row
from inertial.effects.temperature_model import (
    BEND,
    BENDS,
    EVERY,
    Piece,
    degree_name,
    knot_name,
    probability_name,
)
from inertial.physics.effect import COLDEST, MEAN_TEMPERATURE, WARMEST
from stages.diagnosis.result import Result

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
