"""The parameters by result and method, each with its sigma, and what could not be determined."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import groupby
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.records import grouped, labels, omissions
from inertial.tables import AXES
from inertial.text import units
from inertial.text.cause_names import in_words
from inertial.text.messages import _, first_of, listed
from inertial.text.numbers import aligned, counted, fixed, plus_minus, shortened, significant, whole
from inertial.text.typography import capital
from stages.report.outline import (
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
    Traced,
    columns,
    head,
    table_row,
    value_and_sigma,
)
from stages.report.results import (
    KIND,
    METHOD,
    RESULT_TABLES,
    STATIC_SCALE,
    Estimate,
    by_kind,
    estimates,
    final_results,
    kind_of,
    quantity_of,
    symbol,
    withheld,
    written,
)
from stages.report.sections.effect_tables import extended
from stages.report.sections.effect_terms import with_scanned_sigmas, without_sigma
from stages.report.tables import Record, Tables
from stages.report.words import phases_in_words, term

BY_METHOD = _(
    "What follows is no result of its own: the same parameters by each method, side by side. How "
    "they should agree is compared in “Comparisons”."
)
STATIC = "static"  # the method of the gyros by static positions alone
MAX_LETTERS = 40  # of an identifier that stays in one line
MAX_SYMBOLS = 18
MAX_METHODS = 4  # side by side in one table


def parts(tables: Tables) -> Iterator[Part]:
    """The model, the result that counts with its matrices, then every method side by side."""
    yield Equation(
        _("reading = M · truth + bias"),
        _(
            "M = I + S + N: scale errors sₓ… on the diagonal; off the diagonal, the cross-axis "
            "term m with indices i, j is the response of sensor i to an input along axis j."
        ),
    )
    correction = _("truth = M⁻¹ · (reading − bias)")
    if any(result.effects for result in final_results(tables)):
        correction = _("truth = M⁻¹ · (reading − bias − further terms)")
    yield Equation(correction, _("the compensation of a reading."))
    if not any(estimate.parameters for estimate in estimates(tables)):
        yield Paragraph(_("None: no method estimated a parameter."), "poor")
        return
    for result in final_results(tables):
        yield Heading(_("Result: {name}", name=result.name))
        if result.place in withheld(tables):
            yield Paragraph(_("Withheld: the sensor is not usable, as page one says."), "poor")
        else:
            detected = tables.rows("effects")
            yield from _result(
                replace(result, effects=tuple(with_scanned_sigmas(result.effects, detected)))
            )
    yield Heading(_("By method"))
    yield Paragraph(BY_METHOD)
    yield _fits(estimates(tables))
    counted_ones = {result.method for result in final_results(tables) if result.determined}
    for _place, own in groupby(estimates(tables), lambda estimate: estimate.place):
        methods = [estimate for estimate in own if estimate.determined]
        if len(methods) == 1 and methods[0].method in counted_ones:
            continue  # it stands above as the result
        for first in range(0, len(methods), MAX_METHODS):
            yield _side_by_side(methods[first : first + MAX_METHODS])
    yield from extended(tables)


PARAMETERS = Section(
    "parameters",
    _("Parameters"),
    _(
        "Bias, scale error and cross-axis terms of both sensors: the final result, then each "
        "method that the plan allows."
    ),
    _(
        "Each value stands with its standard deviation σ; mounting rotation and non-orthogonality "
        "are derived from the cross-axis terms and scale errors. The result is that of section 1, "
        "valid as far as the verdict says, in the archive, in the exports and in “Residuals”, "
        "“Compensation”, “Navigation performance” and “Uncertainty budget”; sections that use "
        "another fit say so."
    ),
    (*RESULT_TABLES, "effects"),
    parts,
)


def _result(estimate: Estimate) -> Iterator[Part]:
    if estimate.fit is not None:
        yield Paragraph(*_fit(estimate, estimate.fit))
    every = (*estimate.determined, *estimate.effects)
    long = any(len(row["id"]) > MAX_LETTERS for row in every)
    if not estimate.determined:
        yield Paragraph(_reason(estimate), "poor")
        return
    yield Table(
        _("{name}: value and sigma of each parameter.", name=estimate.name),
        (
            Column(_("symbol"), "symbol"),
            *value_and_sigma(unit=True),
            Column(_("Meaning"), "note"),
            Column(_("Identifier"), "code" if long else "identifier"),
        ),
        [*_rows(estimate.determined), *_effects(estimate)],
        note=" ".join(without_sigma(estimate.effects)),
    )
    if matrices := _matrices(estimate):
        yield matrices


def _fits(each: Sequence[Estimate]) -> Table:
    """How well the model of each method describes its data."""
    return Table(
        _("The fit of each method."),
        (
            Column(_("Method")),
            *columns("number", "χ²", _("degrees of freedom")),
            Column(_("Whether the model describes the data")),
        ),
        [
            table_row(
                estimate.name,
                significant(fit["chi_squared"]),
                whole(fit["degrees"]),
                capital(_words_of(estimate, fit)),
                tone=estimate.fit_in_words()[1],
            )
            for estimate in each
            if (fit := estimate.fit) is not None
        ],
        _("No fit was made."),
        _(
            "The deviations of a scatter between manoeuvres, where it is estimated, take up "
            "degrees of freedom; a fit without it has more."
        )
        if any(one.fit["scatter"] for one in each if one.fit is not None)
        else "",
    )


def _side_by_side(methods: Sequence[Estimate]) -> Table:
    """The parameters of one sensor by several methods, a row each."""
    of_method = [{row["parameter"]: row for row in estimate.determined} for estimate in methods]
    first = {name: row for own in reversed(of_method) for name, row in own.items()}
    lines: list[Row] = []
    for kind, group in groupby(by_kind(first.values()), lambda row: kind_of(row["parameter"])):
        names = [row["parameter"] for row in group]
        lines.append(head(KIND.get(kind, capital(shortened(kind, 60)))))
        sides = [_column([own.get(name) for name in names]) for own in of_method]
        for name, *cells in zip(names, *sides, strict=True):
            unit = quantity_of(first[name]).shown.name
            lines.append(table_row(symbol(name), *(text for pair in cells for text in pair), unit))
    return Table(
        _("{sensor}: the parameters by method.", sensor=methods[0].sensor)
        if len(methods) == 1
        else _(
            "{sensor}: the same parameters by {count} methods.",
            sensor=methods[0].sensor,
            count=len(methods),
        ),
        (
            Column(_("symbol"), "symbol"),
            *(
                column
                for estimate in methods
                for column in value_and_sigma(capital(METHOD.get(estimate.method, estimate.method)))
            ),
            Column(_("unit"), "unit"),
        ),
        lines,
        note=STATIC_SCALE if any(one.method == STATIC for one in methods) else "",
    )


def _column(rows: Sequence[Record | None]) -> list[tuple[str, str]]:
    """Value and sigma of some parameters of one kind by one method; a gap where it has none."""
    there = [row for row in rows if row is not None]
    pairs = zip(*map(aligned, zip(*written(there), strict=True)), strict=True) if there else ()
    cells = iter(
        (Traced(value, row["id"]), sigma) for row, (value, sigma) in zip(there, pairs, strict=True)
    )
    return [("", "") if row is None else next(cells) for row in rows]


def _reason(estimate: Estimate) -> str:
    """Why nothing is determined: the one reason of all, or where the reasons stand."""
    reasons = {row["reason"] for row in estimate.parameters}
    if len(reasons) == 1 and (reason := reasons.pop()):
        return shortened(reason, 600)
    return _("None is determined; “Undetermined parameters” states the reasons.")


def _fit(estimate: Estimate, fit: Record) -> tuple[str, Tone]:
    return _(
        "χ² = {chi_squared} with {degrees} of freedom: {words}.",
        chi_squared=significant(fit["chi_squared"]),
        degrees=counted(fit["degrees"], "degree"),
        words=_words_of(estimate, fit),
    ), estimate.fit_in_words()[1]


def _words_of(estimate: Estimate, fit: Record) -> str:
    """Whether its model describes the data, and what its sigmas include."""
    return estimate.fit_in_words()[0] + _random_walk(fit)


def _random_walk(fit: Record) -> str:
    """The random walk of the bias; nothing where it has none."""
    if not fit["random_walk"]:
        return ""
    unit = units.quantity("bias", fit["unit"]).shown
    size, sigma = (
        unit.of(units.HOUR**0.5 * (fit[key] or 0.0)) for key in ("random_walk", "random_walk_sigma")
    )
    return _(
        ". The random walk of the bias is {size} {name}/√h; the bias is stated "
        "for the middle of the campaign, and the σ include the random walk",
        size=plus_minus(size, sigma) if sigma else significant(size, 2),
        name=unit.name,
    )


def _effects(estimate: Estimate) -> Iterator[Row]:
    """The parameters of the effects in its model, below the name of each effect."""
    there = [row for row in estimate.effects if row["value"] is not None]
    yield from _rows(there, lambda row: in_words(row["effect"]))


def _rows(
    parameters: Sequence[Record],
    kind_in: Callable[[Record], str] = lambda row: kind_of(row["parameter"]),
) -> Iterator[Row]:
    """One row per parameter below the name of its kind, digits under digits."""
    groups = grouped(parameters, kind_in)
    cells = [line for group in groups.values() for line in written(group)]
    lines = iter(zip(*map(aligned, zip(*cells, strict=True)), strict=True))
    for kind, group in groups.items():
        name = KIND.get(kind, capital(shortened(kind, 60)))
        frames = listed(list(dict.fromkeys(term(row["frame"]) for row in group if row["frame"])))
        yield head(
            _("{name}; frame: {frames}", name=name, frames=shortened(frames, 60))
            if frames
            else name
        )
        for row, (value, sigma) in zip(group, lines, strict=False):
            yield table_row(
                symbol(row["parameter"]),
                *(Traced(value, row["id"]), sigma, quantity_of(row).shown.name),
                shortened(row["meaning"], 160),
                row["id"],
                anchor=row["id"],
            )


def _matrices(estimate: Estimate) -> Matrices | None:
    """M, its inverse and the bias as numbers, where all twelve parameters are determined."""
    known = estimate.calibration
    matrix, bias = np.eye(3), np.zeros(3)
    try:
        for i, axis in enumerate(AXES):
            bias[i] = known[f"bias_{axis}"]["value"]
            for j, other in enumerate(AXES):
                name = f"scale_{axis}" if i == j else f"cross_{axis}{other}"
                matrix[i, j] += known[name]["value"]
        inverse = np.linalg.inv(matrix)
    except (KeyError, np.linalg.LinAlgError):
        return None
    unit = known["bias_x"]["unit"]
    caption = _("{name}: ready for use.", name=estimate.name)
    if estimate.effects:
        caption = _(
            "{name}: ready for use, together with the further terms of section 1.",
            name=estimate.name,
        )
    return Matrices(
        caption,
        (
            Matrix("M", _entries(matrix, 7)),
            Matrix("M⁻¹", _entries(inverse, 7)),
            Matrix(_("bias"), _entries(bias[:, np.newaxis], 7 if unit == "m/s²" else 10), unit),
        ),
    )


def _entries(matrix: NDArray[np.floating[Any]], decimals: int) -> tuple[tuple[str, ...], ...]:
    return tuple(tuple(fixed(float(entry), decimals) for entry in line) for line in matrix)


# ---- not determined, and excluded


def undetermined_parts(tables: Tables) -> Iterator[Part]:
    """Parameters without a value with the reason; manoeuvres without a part in the fit."""
    if not estimates(tables):
        yield Paragraph(
            _("Nothing was determined: no method found the manoeuvres it needs."), "poor"
        )
        return
    yield Table(
        _("Parameters that are not determined."),
        (
            Column(_("Sensor, method")),
            Column(_("Parameters"), "symbol"),
            Column(_("Reason, and what would help")),
        ),
        [line for estimate in estimates(tables) for line in _undetermined(estimate)],
        _("None: every parameter of every method has a value."),
        _withheld_all_the_same(tables),
    )
    yield Table(
        _("Manoeuvres by fit."),
        columns("text", _("Sensor, method"), _("Used"), _("Excluded, with the reason")),
        [
            table_row(
                estimate.name,
                shortened(phases_in_words(labels(estimate.manoeuvres)) or _("none"), 1500),
                shortened(phases_in_words(omissions(estimate.manoeuvres)) or _("none"), 1500),
                tone="fair" if omissions(estimate.manoeuvres) else "",
            )
            for estimate in estimates(tables)
            if estimate.fit
        ],
        _("No fit was made."),
    )


UNDETERMINED = Section(
    "undetermined",
    _("Undetermined parameters"),
    _(
        "Parameters that the plan or the recording cannot determine, and manoeuvres "
        "that a fit excludes."
    ),
    _(
        "A parameter that is not determined has no value anywhere in this report; it is "
        "not zero. Each reason names the manoeuvre that would help."
    ),
    RESULT_TABLES,
    undetermined_parts,
)


def _withheld_all_the_same(tables: Tables) -> str:
    """That a result is withheld although methods determine it; nothing where none is."""
    places = withheld(tables)
    sensors = [result.sensor for result in final_results(tables) if result.place in places]
    if not sensors:
        return ""
    return _(
        "Of each method; the result that counts is withheld: {sensors}.", sensors=listed(sensors)
    )


def _undetermined(estimate: Estimate) -> Iterator[Row]:
    """One row per reason, its parameters together."""
    gaps = [row for row in estimate.parameters if row["value"] is None]
    for reason, group in groupby(gaps, lambda row: row["reason"]):
        each = [symbol(row["parameter"]) for row in group]
        yield table_row(
            estimate.name,
            first_of(each, MAX_SYMBOLS),
            shortened(capital(reason or _("no reason is stated")), 600),
            tone="fair",
        )
