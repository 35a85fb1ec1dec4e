"""The verdict in a few plain sentences, on the first page and as a text of its own."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import degrees

import pandas as pd

from inertial.campaign.final_result import EXTENDED
from inertial.tables import AXES
from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from stages.reporting.certainty import in_short, listed
from stages.reporting.evidence import CRITICISM
from stages.reporting.extended import effects_in
from stages.reporting.outline import (
    Column,
    Facts,
    Level,
    Paragraph,
    Part,
    Row,
    Section,
    Sentences,
    Table,
    Tone,
)
from stages.reporting.parameters import SENSOR, Estimate, fit_in_words, kind_of
from stages.reporting.rows import Record, only, records

JOINT = "joint"
FREE = "free_positions"
WANTED = frozenset(
    [f"{kind}_{axis}" for kind in ("bias", "scale") for axis in AXES]
    + [f"cross_{row}{column}" for row in AXES for column in AXES if row != column]
)
SIMULATED = (
    "SIMULATED: recorded by the simulated laboratory. No instrument of this serial was calibrated."
)
WAYS = {FREE: "unknown attitudes", EXTENDED: "with effects"}
KINDS = {"bias": "bias", "scale": "scale error", "cross": "cross-axis term"}
TONE: dict[str, Tone] = {
    "calibrated": "good",
    "calibrated in part": "fair",
    "not calibrated": "poor",
}
MEANING = {
    "calibrated": "All 24 parameters are determined and both models describe their data.",
    "calibrated in part": "Some results can be used; the reasons below say which.",
    "not calibrated": "This campaign gives no result that could be used.",
}


@dataclass(frozen=True)
class Verdict:
    """How good the calibration is, in one of three levels, with the reasons in sentences."""

    level: str
    reasons: tuple[str, ...]


def verdict(
    found: Sequence[Estimate],
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    findings: Sequence[Record],
    decision: Sequence[Record] = (),
) -> Verdict:
    """The level and its reasons; `found`: the results, those that count in place of the joint fit.

    Calibrated: the results that count determine all twelve parameters of both sensors and
    describe their data (p ≥ 0.01), and no finding spoils a result. Not calibrated: they
    determine none. In part: everything between.
    """
    joint = joint_fits(found)
    whole = all(_determined(estimate).keys() >= WANTED for estimate in joint)
    misfit = any(estimate.misfit for estimate in joint)
    if not any(WANTED & _determined(estimate).keys() for estimate in joint):
        level = "not calibrated"
    else:
        spoiled = any(finding["severity"] == 3 for finding in findings)
        good = whole and not misfit and not spoiled
        level = "calibrated" if good else "calibrated in part"
    reasons = [_sentence(estimate, effects_in(estimate, decision)) for estimate in joint]
    for estimate in joint:
        words, _ = fit_in_words(estimate)
        reasons += [f"{estimate.sensor}: {words}."] if words else []
    lacking = [*in_short([row for row in findings if row["id"].startswith(CRITICISM)])]
    if lacking:
        reasons.append(f"{' '.join(lacking)} “What the model lacks” says how much, and what to do.")
    reasons += _left_out(joint)
    reasons.append(_performed(manoeuvres, performed))
    reasons.append(_findings(findings))
    return Verdict(level, tuple(reasons))


def joint_fits(found: Sequence[Estimate]) -> list[Estimate]:
    """The results that count of both sensors, one per mount; an empty one where there is none.

    They are of the joint fits, or of those with effects in the model. Where no attitude is known,
    the fit to rests of unknown attitude stands in its place.
    """
    joint = [estimate for estimate in found if estimate.kind in (JOINT, EXTENDED)]
    free = {(e.stage, e.mount): e for e in found if e.kind == FREE}
    joint = [e if e.determined else free.get((e.stage, e.mount), e) for e in joint]
    missing = [stage for stage in SENSOR if all(estimate.stage != stage for estimate in joint)]
    joint += [Estimate(stage, JOINT, (), None) for stage in missing]
    return sorted(joint, key=lambda estimate: list(SENSOR).index(estimate.stage))


def _determined(estimate: Estimate) -> dict[str, Record]:
    return {row["parameter"]: row for row in estimate.determined}


def _sentence(estimate: Estimate, effects: Sequence[str]) -> str:
    """What is determined of a sensor, with effects in the model, and its worst sigma by kind."""
    have = _determined(estimate)
    count = len(WANTED & have.keys())
    if not count:
        return f"{estimate.sensor}: nothing is determined."
    whole = "all 12 parameters are determined"
    amount = whole if count == len(WANTED) else f"{count} of 12 parameters are determined"
    amount += ", by rests of unknown attitude" * (estimate.kind == FREE)
    amount += f", with {listed(effects)} in the model" if effects else ""
    worst = "; ".join(f"{KINDS[kind]} {text}" for kind, text in _worst(have).items())
    return f"{estimate.sensor}: {amount}." + (f" Largest σ: {worst}." if worst else "")


def _worst(have: dict[str, Record]) -> dict[str, str]:
    worst: dict[str, str] = {}
    for kind in KINDS:
        rows = [
            r for r in have.values() if kind_of(r["parameter"]) == kind and r["sigma"] is not None
        ]
        if rows:
            row = max(rows, key=lambda row: row["sigma"])
            unit = units.quantity(row["parameter"], row["unit"]).laboratory
            worst[kind] = f"{numbers.significant(unit.of(row['sigma']), 2)} {unit.name}"
    return worst


def _left_out(joint: Sequence[Estimate]) -> Iterator[str]:
    for estimate in joint:
        if estimate.fit and estimate.fit["left_out"]:
            text = numbers.shortened(estimate.fit["left_out"], 400).rstrip(".")
            yield f"{estimate.sensor}, left out: {text}."


def _performed(manoeuvres: pd.DataFrame, performed: pd.DataFrame) -> str:
    planned = len(manoeuvres)
    rows = records(performed)
    complete = sum(bool(row["found"] and row["complete"]) for row in rows)
    if planned == 0:
        return "No manoeuvre was planned."
    missing = [row["manoeuvre"] for row in rows if not row["found"]]
    partly = [
        row["manoeuvre"] + (" (bridged)" if row["bridged"] else "")
        for row in rows
        if row["found"] and not row["complete"]
    ]
    text = f"{complete} of {numbers.counted(planned, 'manoeuvre')} recorded as planned"
    if partly:
        text += f"; not complete: {_listed(partly)}"
    if missing:
        text += f"; not found: {_listed(missing)}"
    return f"{text}."


def _listed(names: Sequence[str], most: int = 8) -> str:
    shown = ", ".join(numbers.shortened(name, 60) for name in names[:most])
    return f"{shown} and {len(names) - most} more" if len(names) > most else shown


def _findings(findings: Sequence[Record]) -> str:
    if not findings:
        return "Findings: none."
    causes = Counter(row["cause"] for row in findings)
    listed = ", ".join(f"{in_words(cause)} ({count})" for cause, count in causes.most_common(8))
    more = f" and {len(causes) - 8} further causes" if len(causes) > 8 else ""
    return f"Findings: {numbers.whole(len(findings))}; {listed}{more}."


def facts(
    campaign: Record, known: pd.DataFrame, clocks: pd.DataFrame
) -> tuple[tuple[str, str], ...]:
    """What stands on the plate of the report: instrument, serial, dates, site, table."""
    recorded = sorted({row["recorded_on"] for row in records(clocks) if row["recorded_on"]})
    by_name = {row["quantity"]: row for row in records(known)}
    gravity = by_name.get("gravity", {}).get("value")
    site = [
        _with_unit(None if campaign["latitude"] is None else degrees(campaign["latitude"]), 4, "°"),
        _with_unit(campaign["height"], 0, " m"),
        _with_unit(gravity, 7, " m/s²"),
    ]
    latitude, height, force = site
    pairs = {
        "Campaign": campaign["campaign"],
        "Instrument": campaign["instrument"],
        "Serial": campaign["serial"],
        "Date stated": campaign["date"],
        "Date recorded": " … ".join(dict.fromkeys((recorded[0], recorded[-1])))
        + " (UTC, by the clock of the logs)"
        if recorded
        else "not known: the logs have no absolute clock",
        "Site": f"latitude {latitude}, height {height}, gravity {force}",
        "Table": campaign["table"],
        "Laboratory": campaign["laboratory"],
        "Operator": campaign["operator"],
        "Remarks": campaign["notes"],
    }
    return tuple(
        (name, numbers.shortened(str(text), 900))
        for name, text in pairs.items()
        if text is not None
    )


def _with_unit(value: float | None, decimals: int, unit: str) -> str:
    return "unknown" if value is None else f"{numbers.fixed(value, decimals)}{unit}"


def section(
    given: Verdict,
    found: Sequence[Estimate],
    campaign: Record,
    known: pd.DataFrame,
    clocks: pd.DataFrame,
) -> Section:
    """The level, its reasons, and the result at a glance."""
    parts: list[Part] = []
    if campaign["simulated"]:
        parts.append(Paragraph(SIMULATED, "poor"))
    parts += [
        Level(given.level, TONE[given.level], MEANING[given.level]),
        Sentences(given.reasons),
        Table(
            "The results that count at a glance: parameters determined, largest σ of each kind.",
            (
                Column("Sensor"),
                Column("Fit"),
                Column("Determined", "number"),
                Column("Bias σ", "number"),
                Column("Scale σ", "number"),
                Column("Cross-axis σ", "number"),
                Column("p of the fit", "number"),
            ),
            tuple(_glance(estimate) for estimate in joint_fits(found)),
        ),
        Facts(facts(campaign, known, clocks)),
    ]
    return Section(
        "verdict",
        "Verdict",
        "Whether this calibration can be used, and why.",
        "Calibrated: the fits that count, joint or with effects in the model, determine all 24 "
        "parameters and describe their data (p ≥ 0.01). In part: some are not determined, or a "
        "model does not describe its data. Not calibrated: none is determined.",
        parts,
    )


def _glance(estimate: Estimate) -> Row:
    have = _determined(estimate)
    worst = _worst(have)
    fit = estimate.fit
    return Row(
        (
            estimate.sensor,
            WAYS.get(estimate.kind, "joint"),
            f"{len(WANTED & have.keys())} of 12",
            *(worst.get(kind, "—") for kind in KINDS),
            numbers.probability(fit["p_value"]) if fit else "—",
        )
    )


def as_text(
    given: Verdict, campaign: pd.DataFrame, known: pd.DataFrame, clocks: pd.DataFrame
) -> str:
    """The verdict as plain text, 80 letters wide."""
    about = only(campaign)
    lines = []
    if about["simulated"]:
        lines += [*textwrap.wrap(SIMULATED, 80), ""]
    lines += [f"Verdict: {given.level}", *textwrap.wrap(MEANING[given.level], 80), ""]
    for reason in given.reasons:
        lines += textwrap.wrap(reason, 80, initial_indent="- ", subsequent_indent="  ")
    lines.append("")
    for name, text in facts(about, known, clocks):
        lines += textwrap.wrap(
            f"{name + ':':<15}{text}", 80, subsequent_indent=" " * 15, break_on_hyphens=False
        )
    return "\n".join(lines) + "\n"
