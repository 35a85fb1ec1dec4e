"""The parameters, each with its sigma in the units of the laboratory and of the SI."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.final_result import extended_methods
from inertial.tables import AXES
from inertial.text import numbers, units
from stages.reporting.outline import (
    Column,
    Equation,
    Heading,
    Matrices,
    Matrix,
    Paragraph,
    Part,
    Row,
    Section,
    Table,
    Tone,
)
from stages.reporting.rows import Record, records

SENSOR = {"accelerometer": "Accelerometer", "gyroscope": "Gyroscope"}
METHOD = {
    "joint": "joint fit of all manoeuvres",
    "six_position": "six positions, S0",
    "free_positions": "rests of unknown attitude, by |f| = g",
    "up_and_down": "two positions with tilt, S1",
    "pooled_positions": "stops at one attitude pooled, S3",
    "static": "rests up and down, S0",
    "turns": "turns forward and back, S0",
    "turn_and_stop": "turn and stop, S3: M, and the bias by turns",
    "stops": "turn and stop, S3: the bias by stops",
    "rate_table": "rate table, S4",
}
KIND = {
    "bias": "Bias",
    "scale": "Scale error",
    "cross": "Cross-axis terms",
    "mounting": "Mounting rotation of the sensor triad against the case",
    "symmetric": "Axes out of square: the symmetric rest P of M = P R",
}
SYMBOL = {"bias": "b", "scale": "s", "cross": "m", "mounting": "ρ", "symmetric": "p"}
WALK = ("random_walk", "random_walk_sigma")
SMALL_P = 0.01
MISFIT = "the model does not describe the data within the noise; sigmas are of noise only"
REPLACED = (
    "These are not the parameters that count: the fit with effects in the model replaces them. "
    "It stands below “What the model lacks”, and in the archive and the export."
)
COLUMNS = (
    Column("", "symbol"),
    Column("value", "number", "Laboratory"),
    Column("± σ", "sigma", "Laboratory"),
    Column("unit", "unit", "Laboratory"),
    Column("value", "number", "SI"),
    Column("± σ", "sigma", "SI"),
    Column("unit", "unit", "SI"),
    Column("Meaning", "note"),
)
LONG_IDENTIFIER = 40  # which then takes several lines


@dataclass(frozen=True)
class Estimate:
    """The parameters that one method estimated, with its fit."""

    stage: str
    method: str
    parameters: tuple[Record, ...]
    fit: Record | None

    @property
    def kind(self) -> str:
        """The method without the mount that a parameter set may be of: joint of joint@upright."""
        return self.method.partition("@")[0]

    @property
    def mount(self) -> str:
        """The mount of its parameters where there are several."""
        return self.method.partition("@")[2]

    @property
    def sensor(self) -> str:
        """The sensor in words, with the mount where there are several."""
        mount = numbers.shortened(self.mount, 60)
        sensor = SENSOR.get(self.stage, self.stage)
        return f"{sensor} (mount {mount})" if mount else sensor

    @property
    def name(self) -> str:
        """Sensor and method in words."""
        return f"{self.sensor}, {METHOD.get(self.kind, self.kind)}"

    @property
    def determined(self) -> list[Record]:
        """The parameters that have a value."""
        return [row for row in self.parameters if row["value"] is not None]

    @property
    def misfit(self) -> bool:
        """Whether the residuals are larger than the noise allows."""
        p_value = self.fit["p_value"] if self.fit else None
        return p_value is not None and bool(p_value < SMALL_P)


def estimates(
    accelerometer_parameters: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
) -> list[Estimate]:
    """Every method of both sensors, in the order of the tables; a fit without parameters too."""
    found = []
    for stage, parameters, fit in (
        ("accelerometer", accelerometer_parameters, accelerometer_fit),
        ("gyroscope", gyroscope_parameters, gyroscope_fit),
    ):
        fits = {row["method"]: row for row in records(fit)}
        rows = records(parameters)
        for method in dict.fromkeys([*(row["method"] for row in rows), *fits]):
            own = tuple(by_kind(row for row in rows if row["method"] == method))
            found.append(Estimate(stage, method, own, fits.get(method)))
    return found


def in_words_of(method: str) -> str:
    """The sensor of a method of the extension, with the mount where there are several."""
    stage, _, mount = method.partition("@")
    return Estimate(stage, f"extended@{mount}" if mount else "extended", (), None).sensor


def kind_of(parameter: str) -> str:
    """What a parameter is one of: bias, scale, cross, mounting, symmetric."""
    return parameter.partition("_")[0]


def by_kind(rows: Iterable[Record]) -> list[Record]:
    """Bias first, then scale, cross-axis terms and the rest; within, as they come."""
    order = {kind: place for place, kind in enumerate(KIND)}
    return sorted(rows, key=lambda row: order.get(kind_of(row["parameter"]), len(order)))


def symbol(parameter: str) -> str:
    """The parameter's sign with its axes: b_x, s_x, m_xy; its name where it has none."""
    kind, _, axes = parameter.partition("_")
    return f"{SYMBOL[kind]}_{axes}" if kind in SYMBOL and axes else parameter


def section(found: Sequence[Estimate], decision: pd.DataFrame) -> Section:
    """Parameters by sensor and method; `decision`: whether the extended result counts."""
    replaced = extended_methods(records(decision))
    parts: list[Part] = [
        Equation(
            "reading = M · truth + bias",
            "M = I + S + N: scale errors sₓ… on the diagonal; off it m with row first: the second "
            "index names the axis of the input, the first the sensor that answers to it.",
        ),
        Equation("truth = M⁻¹ · (reading − bias)", "the compensation of a reading."),
    ]
    for estimate in found:
        parts += _parts(estimate)
        if estimate.kind == "joint" and _extended(estimate) in replaced:
            parts.append(Paragraph(REPLACED, "fair"))
    if not any(estimate.parameters for estimate in found):
        parts.append(Paragraph("None: no method estimated a parameter.", "poor"))
    return Section(
        "parameters",
        "Parameters",
        "What calibrates this instrument: bias, scale error and cross-axis terms of both sensors, "
        "by each method that the plan allows.",
        "Each value stands with its standard deviation σ, first in the unit of the laboratory, "
        "then in the SI. Specific force: the axis that points up reads +g. Rotations follow the "
        "right hand. The joint fit is the result, unless it is said beside it that the one "
        "with effects in the model replaces it; the other methods are there to be compared.",
        parts,
    )


def _extended(estimate: Estimate) -> str:
    """What the extension calls its method for the same sensor and mount."""
    return estimate.stage + (f"@{estimate.mount}" if estimate.mount else "")


def _parts(estimate: Estimate) -> Iterator[Part]:
    yield Heading(estimate.name)
    if estimate.fit is not None:
        yield _fit(estimate)
    long = any(len(row["id"]) > LONG_IDENTIFIER for row in estimate.determined)
    yield Table(
        caption=f"Determined: {numbers.counted(len(estimate.determined), 'parameter')}.",
        columns=(*COLUMNS, Column("Identifier", "code" if long else "identifier")),
        rows=tuple(_rows(estimate.determined)),
        empty="None is determined; “Not determined, and left out” says why.",
    )
    if matrices := _matrices(estimate):
        yield matrices


def fit_in_words(estimate: Estimate) -> tuple[str, Tone]:
    """Whether the model describes the data, plainly; nothing where no fit was made."""
    fit = estimate.fit
    if fit is None:
        return "", ""
    p_is = numbers.p_is(fit["p_value"])
    if not estimate.misfit:
        if not fit["degrees"]:
            return "nothing is left over to test the model with", "fair"
        return f"the model describes the data within the noise ({p_is})", "good"
    if not (fit["scatter"] or fit["random_walk"]):
        return f"{MISFIT} ({p_is})", "poor"
    if not fit["scatter"]:
        return f"noise alone does not describe the data ({p_is}), a bias that walks does", "fair"
    unit = units.quantity("bias", fit["unit"]).laboratory
    scatter = f"{numbers.significant(unit.of(fit['scatter']), 2)} {unit.name}"
    return (
        f"the model does not describe the data within the noise ({p_is}); manoeuvres differ by "
        f"{scatter} beyond it, which the sigmas allow for"
    ), "poor"


def _fit(estimate: Estimate) -> Paragraph:
    fit = estimate.fit or {}
    words, tone = fit_in_words(estimate)
    sizes = {"the scatter between manoeuvres": "scatter", "the walk of the bias": "random_walk"}
    there = [name for name, size in sizes.items() if fit[size]]
    allowed = f", {' and '.join(there)} allowed for" if there else ""
    return Paragraph(
        f"χ² = {numbers.significant(fit['chi_squared'])} with "
        f"{numbers.counted(fit['degrees'], 'degree')} of freedom{allowed}: {words}.{_walk(fit)}",
        tone,
    )


def _walk(fit: Record) -> str:
    """How far the bias walks; nothing where it does not."""
    if not fit["random_walk"]:
        return ""
    unit = units.quantity("bias", fit["unit"]).laboratory
    per_root_hour = [units.HOUR**0.5 * (fit[size] or 0.0) for size in WALK]
    walk, sigma = (numbers.significant(unit.of(size), 2) for size in per_root_hour)
    return (
        f" The bias walks by {walk} ± {sigma} {unit.name}/√h; its value is that in the middle of "
        "the campaign, and the sigmas allow for the walk."
    )


def _rows(parameters: Sequence[Record]) -> Iterator[Row]:
    """One row per parameter below the name of its kind, digits under digits."""
    kinds = groupby(parameters, lambda row: kind_of(row["parameter"]))
    groups = [list(rows) for _, rows in kinds]
    cells = [line for group in groups for line in written(group)]
    columns = [numbers.aligned(column) for column in zip(*cells, strict=True)]
    lines = iter(zip(*columns, strict=True))
    for group in groups:
        kind = kind_of(group[0]["parameter"])
        name = KIND.get(kind, numbers.shortened(kind, 60).capitalize())
        frames = " and ".join(dict.fromkeys(row["frame"] for row in group))
        yield Row((f"{name}; frame: {numbers.shortened(frames, 60)}",), heads=True)
        for row in group:
            value, sigma, si_value, si_sigma = next(lines)
            unit = units.quantity(row["parameter"], row["unit"])
            meaning = numbers.shortened(row["meaning"], 160)
            laboratory = (value, sigma, unit.laboratory.name)
            si = (si_value, si_sigma, unit.si.name)
            yield Row((symbol(row["parameter"]), *laboratory, *si, meaning, row["id"]), row["id"])


def written(group: Sequence[Record]) -> list[tuple[str, ...]]:
    """Value and sigma of parameters of one kind, in the laboratory's unit and in the SI's."""
    quantities = [units.quantity(row["parameter"], row["unit"]) for row in group]
    laboratory = in_units(group, [quantity.laboratory for quantity in quantities])
    si = in_units(group, [quantity.si for quantity in quantities])
    return [(*pair, *si_pair) for pair, si_pair in zip(laboratory, si, strict=True)]


def in_units(group: Sequence[Record], each: Sequence[units.Unit]) -> list[tuple[str, str]]:
    """Values and sigmas, with common decimals where the unit is the same."""
    values = [unit.of(row["value"]) for row, unit in zip(group, each, strict=True)]
    sigmas = [unit.of(row["sigma"]) for row, unit in zip(group, each, strict=True)]
    by_unit: dict[str, list[float | None]] = {}
    for sigma, unit in zip(sigmas, each, strict=True):
        by_unit.setdefault(unit.name, []).append(sigma)
    decimals = {name: numbers.common_decimals(those) for name, those in by_unit.items()}
    return [
        numbers.with_sigma(value, sigma, decimals[unit.name])
        for value, sigma, unit in zip(values, sigmas, each, strict=True)
    ]


def _matrices(estimate: Estimate) -> Matrices | None:
    """M, its inverse and the bias as numbers, where all twelve parameters are determined."""
    known = {row["parameter"]: row["value"] for row in estimate.determined}
    matrix, bias = np.eye(3), np.zeros(3)
    try:
        for i, row in enumerate(AXES):
            bias[i] = known[f"bias_{row}"]
            for j, column in enumerate(AXES):
                matrix[i, j] += known[f"scale_{row}" if i == j else f"cross_{row}{column}"]
        inverse = np.linalg.inv(matrix)
    except (KeyError, np.linalg.LinAlgError):
        return None
    unit = next(row["unit"] for row in estimate.determined if row["parameter"] == "bias_x")
    return Matrices(
        f"{estimate.name}: ready for use.",
        (
            Matrix("M", _entries(matrix, 7)),
            Matrix("M⁻¹", _entries(inverse, 7)),
            Matrix("bias", _entries(bias[:, np.newaxis], 7 if unit == "m/s²" else 10), unit),
        ),
    )


def _entries(matrix: NDArray[np.floating[Any]], decimals: int) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(numbers.fixed(float(entry), decimals) for entry in row) for row in matrix)
