"""The verdict in a few plain sentences, on the first page and as a text of its own."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees

from inertial.campaign.records import omissions
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, probability, shortened, significant, whole
from inertial.text.parameters import EXTENDED
from stages.report import outline
from stages.report.linked import CAUSE_TABLES
from stages.report.results import (
    CALIBRATION,
    FREE,
    RESULT_TABLES,
    Estimate,
    effects_in,
    final_results,
    kind_of,
    quantity_of,
)
from stages.report.sections.effect_sentences import summary
from stages.report.sections.findings import FINDING_TABLES, model_findings, ranked
from stages.report.tables import Record, Tables, once
from stages.report.words import listed

SIMULATED = _(
    "SIMULATED: recorded by the simulated laboratory. No instrument of this serial was calibrated."
)
FITS = {FREE: _("unknown attitudes"), EXTENDED: _("with effects")}
KINDS = {"bias": "bias", "scale": _("scale error"), "cross": _("cross-axis term")}
TONE: dict[str, outline.Tone] = {
    "calibrated": "good",
    "calibrated in part": "fair",
    "not calibrated": "poor",
}
MEANING = {
    "calibrated": _("All 24 parameters are determined and both models describe their data."),
    "calibrated in part": _("Some results can be used; the reasons below say which."),
    "not calibrated": _("This campaign gives no result that could be used."),
}
MOST_NAMES = 8


@dataclass(frozen=True)
class Verdict:
    """How good the calibration is, in one of three levels, with the reasons in sentences."""

    level: str
    reasons: tuple[str, ...]


@once
def verdict(tables: Tables) -> Verdict:
    """The level and its reasons.

    Calibrated: the final results determine all twelve parameters of both sensors and
    describe their data (p ≥ 0.01), and no finding spoils a result. Not calibrated: they
    determine none. In part: everything between.
    """
    results = final_results(tables)
    whole = all(len(result.calibration) == len(CALIBRATION) for result in results)
    spoiled = any(finding["severity"] == 3 for finding in ranked(tables))
    if not any(result.calibration for result in results):
        level = _("not calibrated")
    elif whole and not spoiled and not any(result.misfit for result in results):
        level = "calibrated"
    else:
        level = _("calibrated in part")
    return Verdict(level, tuple(_reasons(tables, results)))


def _reasons(tables: Tables, results: Sequence[Estimate]) -> Iterator[str]:
    for result in results:
        yield _determined(result, effects_in(tables, result))
    for result in results:
        words, _unused = result.fit_in_words()
        if words:
            yield f"{result.sensor}: {words}."
    if lacking := list(summary(model_findings(tables))):
        yield _(
            "{lacking} “Unmodelled effects” states their size and the action.",
            lacking=" ".join(lacking),
        )
    for result in results:
        if result.fit and (excluded := omissions(result.manoeuvres)):
            text = shortened(excluded, 400).rstrip(".")
            yield f"{result.sensor}, excluded: {text}."
    yield _performed(tables)
    yield _findings(ranked(tables))


def _determined(result: Estimate, effects: Sequence[str]) -> str:
    """What is determined of a sensor, with effects in the model, and its worst sigma by kind."""
    count = len(result.calibration)
    if not count:
        return _("{sensor}: nothing is determined.", sensor=result.sensor)
    every = _("all 12 parameters are determined")
    amount = (
        every
        if count == len(CALIBRATION)
        else _("{count} of 12 parameters are determined", count=count)
    )
    amount += _(", by static positions of unknown attitude") * (result.method == FREE)
    amount += _(", with {effects} in the model", effects=listed(effects)) if effects else ""
    worst = "; ".join(f"{KINDS[kind]} {text}" for kind, text in _largest_sigmas(result).items())
    return f"{result.sensor}: {amount}." + (f" Largest σ: {worst}." if worst else "")


def _largest_sigmas(result: Estimate) -> dict[str, str]:
    largest: dict[str, str] = {}
    rows = [row for row in result.calibration.values() if row["sigma"] is not None]
    for kind in KINDS:
        if own := [row for row in rows if kind_of(row["parameter"]) == kind]:
            worst = max(own, key=lambda row: float(row["sigma"]))
            unit = quantity_of(worst).laboratory
            largest[kind] = f"{significant(unit.of(worst['sigma']), 2)} {unit.name}"
    return largest


def _performed(tables: Tables) -> str:
    planned, rows = len(tables.frame("manoeuvres")), tables.rows("performed")
    if planned == 0:
        return _("No manoeuvre was planned.")
    complete = sum(bool(row["found"] and row["complete"]) for row in rows)
    missing = [row["manoeuvre"] for row in rows if not row["found"]]
    partly = [
        row["manoeuvre"] + (_(" (gap interpolated)") if row["bridged"] else "")
        for row in rows
        if row["found"] and not row["complete"]
    ]
    text = _(
        "{complete} of {planned} recorded as planned",
        complete=complete,
        planned=counted(planned, "manoeuvre"),
    )
    text += _("; not complete: {partly}", partly=_first(partly)) if partly else ""
    text += _("; not found: {missing}", missing=_first(missing)) if missing else ""
    return f"{text}."


def _first(names: Sequence[str]) -> str:
    shown = ", ".join(shortened(name, 60) for name in names[:MOST_NAMES])
    return (
        _("{shown} and {names} more", shown=shown, names=len(names) - MOST_NAMES)
        if len(names) > MOST_NAMES
        else shown
    )


def _findings(findings: Sequence[Record]) -> str:
    if not findings:
        return _("Findings: none.")
    causes = Counter(row["cause"] for row in findings)
    names = ", ".join(f"{in_words(cause)} ({n})" for cause, n in causes.most_common(MOST_NAMES))
    rest = len(causes) - MOST_NAMES
    others = _(" and {rest} further causes", rest=rest) if rest > 0 else ""
    return f"Findings: {whole(len(findings))}; {names}{others}."


def facts(tables: Tables) -> outline.Pairs:
    """What stands on the plate of the report: instrument, serial, dates, site, table."""
    campaign = tables.row("campaign")
    dates = sorted({row["recorded_on"] for row in tables.rows("clocks") if row["recorded_on"]})
    known = {row["quantity"]: row["value"] for row in tables.rows("known")}
    latitude = campaign["latitude"]
    latitude = _with_unit(None if latitude is None else degrees(latitude), 4, "°")
    height, gravity = (
        _with_unit(campaign["height"], 0, " m"),
        _with_unit(known.get("gravity"), 7, " m/s²"),
    )
    recorded = _("not known: the logs have no absolute clock")
    if dates:
        recorded = " … ".join(dict.fromkeys((dates[0], dates[-1])))
        recorded += _(" (UTC, by the clock of the logs)")
    pairs = {
        "Campaign": campaign["campaign"],
        "Instrument": campaign["instrument"],
        "Serial": campaign["serial"],
        "Date stated": campaign["date"],
        "Date recorded": recorded,
        "Site": _(
            "latitude {latitude}, height {height}, gravity {gravity}",
            latitude=latitude,
            height=height,
            gravity=gravity,
        ),
        "Table": campaign["table"],
        "Laboratory": campaign["laboratory"],
        "Operator": campaign["operator"],
        "Remarks": campaign["notes"],
    }
    return tuple(
        (name, shortened(str(text), 900)) for name, text in pairs.items() if text is not None
    )


def _with_unit(value: float | None, decimals: int, unit: str) -> str:
    return "unknown" if value is None else f"{fixed(value, decimals)}{unit}"


def parts(tables: Tables) -> Iterator[outline.Part]:
    """The level, its reasons, the final results in short, and the plate of the report."""
    given = verdict(tables)
    if tables.row("campaign")["simulated"]:
        yield outline.Paragraph(SIMULATED, "poor")
    yield outline.Level(given.level, TONE[given.level], MEANING[given.level])
    yield outline.Sentences(given.reasons)
    sigmas = ("Bias σ", "Scale σ", _("Cross-axis σ"))
    yield outline.Table(
        "Final results: parameters determined, and the largest σ of each kind.",
        outline.columns("text", "Sensor", "Fit")
        + outline.columns("number", "Determined", *sigmas, "p of the fit"),
        [_in_short(row) for row in final_results(tables)],
    )
    yield outline.Facts(facts(tables))


SECTION = outline.Section(
    "verdict",
    "Verdict",
    _("Whether this calibration can be used, and why."),
    _(
        "Calibrated: the final fits, joint or with effects in the model, determine all "
        "24 parameters and describe their data (p ≥ 0.01). In part: some are not "
        "determined, or a model does not describe its data. Not calibrated: none is "
        "determined."
    ),
    (
        *RESULT_TABLES,
        *FINDING_TABLES,
        *CAUSE_TABLES[1:],
        "campaign",
        "known",
        "clocks",
        "manoeuvres",
        "performed",
    ),
    parts,
)


def _in_short(result: Estimate) -> outline.Row:
    largest = _largest_sigmas(result)
    return outline.table_row(
        result.sensor,
        FITS.get(result.method, "joint"),
        f"{len(result.calibration)} of 12",
        *(largest.get(kind, "—") for kind in KINDS),
        probability(result.fit["p_value"]) if result.fit else "—",
    )


def as_text(tables: Tables) -> str:
    """The verdict as plain text, 80 letters wide."""
    given = verdict(tables)
    lines = []
    if tables.row("campaign")["simulated"]:
        lines += [*textwrap.wrap(SIMULATED, 80), ""]
    lines += [f"Verdict: {given.level}", *textwrap.wrap(MEANING[given.level], 80), ""]
    for reason in given.reasons:
        lines += textwrap.wrap(reason, 80, initial_indent="- ", subsequent_indent="  ")
    lines.append("")
    for name, text in facts(tables):
        lines += textwrap.wrap(
            f"{name + ':':<15}{text}", 80, subsequent_indent=" " * 15, break_on_hyphens=False
        )
    return "\n".join(lines) + "\n"
