"""The steps from a number of the report to the lines of the logs.

The number, its method and fit, the stages between, the manoeuvres used with records, lines, bytes
and times, and the files of the laboratory.
"""

import difflib
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import isnan
from pathlib import Path
from typing import Any

import pandas as pd

from commands.trace.provenance import Campaign, Provenance, StageRun
from inertial import tables
from inertial.campaign.log_lines import LogLines, RecordRange, UsedPhase, lines_of, used_phases
from inertial.campaign.records import Part, Row, labels, parts_of, rows_of
from inertial.tables.errors import Refusal
from inertial.tables.table import Table
from inertial.text.messages import _
from inertial.text.numbers import visible
from inertial.text.parameters import JOINT, STAGES

OF_SENSOR = ("mount", "sensor")
RESULT = "diagnosis/result.parquet"  # the parameters that count
MAX_SUGGESTIONS = 6  # identifiers, where one is not known


@dataclass(frozen=True)
class Step:
    """One step down: its title, and its details."""

    title: str
    lines: Sequence[str]


@dataclass(frozen=True)
class Trace:
    """The steps, and in sentences the broken links between them."""

    steps: Sequence[Step]
    broken: Sequence[str]


@dataclass(frozen=True)
class Number:
    """A row of PARAMETERS, and the table it stands in: folder/file."""

    row: Row
    stage: str
    file: str

    @property
    def table(self) -> str:
        """The table as a provenance names it."""
        return f"{self.stage}/{self.file}"


@dataclass(frozen=True)
class Fit:
    """A row of FIT, the stage that made it, and its manoeuvres, those left out with the reason."""

    stage: str
    row: Row
    manoeuvres: Sequence[Part]


def trace(campaign: Campaign, identifier: str, settings: Mapping[str, Any]) -> Trace:
    """From the number `identifier` of a campaign to the lines it was computed from.

    `settings` are the current ones, one section per stage.

    Raises
    ------
    Refusal
        where there is no such number
    """
    number = number_of(campaign, identifier)
    stage = number.stage
    roots = [number.table, f"{stage}/fit.parquet", f"{stage}/fit_manoeuvres.parquet"]
    roots.append("plan/inputs.parquet")
    provenance = Provenance(campaign, roots, settings)
    content = _Tables(campaign)
    fits = _fits(number, content, provenance)
    steps = [_value(number), _method(number, provenance), *(_fit(fit, number) for fit in fits)]
    steps += [_stage(run) for run in provenance.runs if run.stage != stage]
    steps += _manoeuvres(fits, content, provenance)
    steps.append(_files(campaign, provenance))
    inputs = content.rows("plan/inputs", tables.INPUTS)
    broken = [*provenance.broken, *_listed_otherwise(inputs, provenance), *content.unreadable]
    return Trace(steps, broken)


def number_of(campaign: Campaign, identifier: str) -> Number:
    """The number with this identifier.

    Raises
    ------
    Refusal
        where the campaign has no results, or none with this identifier, with similar ones
    """
    numbers: dict[str, Number] = {}
    results = [*campaign.derived.glob("*/parameters.parquet"), *campaign.derived.glob(RESULT)]
    for path in sorted(results):
        rows = rows_of(tables.PARAMETERS.read(path))
        numbers |= {row["id"]: Number(row, path.parent.name, path.name) for row in rows}
    if not numbers:
        raise Refusal(
            str(campaign.derived),
            "",
            _("no results"),
            _("tables of parameters"),
            _("run the campaign: make report CAMPAIGN={name}", name=campaign.name),
        )
    if identifier not in numbers:
        similar = difflib.get_close_matches(identifier, numbers, n=MAX_SUGGESTIONS, cutoff=0.5)
        likely = similar or list(numbers)[:MAX_SUGGESTIONS]
        raise Refusal(
            str(campaign.derived),
            "",
            _("no number {identifier!r}", identifier=identifier),
            _("one of {count}, such as {names}", count=len(numbers), names=", ".join(likely)),
            _("give one of them: ID=…"),
        )
    return numbers[identifier]


class _Tables:
    """The tables of a campaign; one that cannot be read is a broken link, and empty."""

    def __init__(self, campaign: Campaign) -> None:
        self.campaign = campaign
        self.unreadable: list[str] = []

    def read(self, name: str, table: Table) -> pd.DataFrame:
        """A small table."""
        try:
            return table.read(self.campaign.path(f"{name}.parquet"))
        except Refusal as refusal:
            self._note(refusal)
            return table.empty()

    def rows(self, name: str, table: Table) -> list[Row]:
        """The rows of a small table."""
        return rows_of(self.read(name, table))

    def lines(self, ranges: Sequence[RecordRange]) -> dict[RecordRange, LogLines]:
        """Where some ranges of records stand in their logs."""
        path = self.campaign.path("decode/samples.parquet")
        try:
            return lines_of(tables.SAMPLES.stream(path), ranges)
        except Refusal as refusal:
            self._note(refusal)
            return {}

    def _note(self, refusal: Refusal) -> None:
        self.unreadable.append(
            _("{file} cannot be read: {found}.", file=refusal.file, found=refusal.found)
        )


# ---- the number and its method


def _value(number: Number) -> Step:
    row = number.row
    frame = f", frame: {row['frame']}" if row["frame"] else ""
    if row["value"] is None:
        return Step(
            _("{id} is not determined", id=row["id"]), [row["meaning"] + frame, row["reason"]]
        )
    sigma = "" if row["sigma"] is None else f" ± {row['sigma']:.2g}"  # none of a constant
    value = f"{row['value']:.10g}{sigma}" + _unit(row["unit"])
    return Step(f"{row['id']} = {value}", [row["meaning"] + frame])


def _method(number: Number, provenance: Provenance) -> Step:
    row = number.row
    made_by = [
        line for run in provenance.runs if run.stage == row["stage"] for line in _made_by(run)
    ]
    return Step(
        _(
            "estimated by the stage {stage}, method {method}",
            stage=row["stage"],
            method=row["method"],
        ),
        made_by,
    )


def _fits(number: Number, content: _Tables, provenance: Provenance) -> list[Fit]:
    """The fits that say what a number was estimated from: its own, or those that it rests on.

    A method that keeps no fit uses what the joint one of its sensor and mount used. A stage that
    keeps none rests on the stage behind it that estimates its sensor.
    """
    own = [number.row[key] for key in OF_SENSOR]
    by_stage = {
        run.stage: [
            row
            for row in content.rows(f"{run.stage}/fit", tables.FIT)
            if [row[key] for key in OF_SENSOR] == own
        ]
        for run in provenance.runs
        if content.campaign.path(f"{run.stage}/fit.parquet").is_file()
    }
    if not by_stage:
        content.unreadable.append(
            _("No table says what {id} was estimated from.", id=number.row["id"])
        )
    stages = (number.stage, STAGES[number.row["sensor"]])
    nearest = [name for name in stages if name in by_stage][:1]
    fits = []
    for name in nearest or by_stage:
        by_method = {row["method"]: row for row in by_stage[name]}
        row = by_method.get(number.row["method"]) if name == number.stage else None
        if row := row or by_method.get(JOINT):
            key = [row[key] for key in (*OF_SENSOR, "method")]
            listed = content.rows(f"{name}/fit_manoeuvres", tables.FIT_MANOEUVRES)
            used = [each for each in listed if [each[k] for k in (*OF_SENSOR, "method")] == key]
            fits.append(Fit(name, row, parts_of(used)))
    return fits


def _fit(fit: Fit, number: Number) -> Step:
    row = fit.row
    lines = [
        _(
            "chi-squared {chi_squared:.1f} with {degrees} degrees of freedom, p = {p_value:.2g}",
            chi_squared=row["chi_squared"],
            degrees=row["degrees"],
            p_value=row["p_value"],
        ),
        _(
            "scatter between manoeuvres beyond the noise: {scatter:.3g}{unit}",
            scatter=row["scatter"],
            unit=_unit(row["unit"]),
        ),
        f"used: {labels(fit.manoeuvres) or 'nothing'}",
        *(
            _("left out: {omission}", omission=part.omission)
            for part in fit.manoeuvres
            if part.reason
        ),
    ]
    if (fit.stage, row["method"]) != (number.row["stage"], number.row["method"]):
        method = f"{number.row['stage']}, method {number.row['method']}"
        lines.insert(
            0, _("{method}, keeps no record of what it used; it rests on this fit", method=method)
        )
    return Step(
        _("the fit of the stage {stage}, method {method}", stage=fit.stage, method=row["method"]),
        lines,
    )


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" {unit}"


# ---- the stages between


def _stage(run: StageRun) -> Step:
    return Step(
        _("from the stage {stage}: {join}", stage=run.stage, join=", ".join(sorted(run.tables))),
        _made_by(run),
    )


def _made_by(run: StageRun) -> list[str]:
    settings = ", ".join(f"{name}: {value}" for name, value in run.settings.items())
    tables_read = [file for file in run.inputs if file.endswith(".parquet")]
    return [
        f"settings: {settings or 'none'}",
        _("code: SHA-256 {code}", code=run.code),
        *(
            _("read {file}, SHA-256 {inputs}", file=file, inputs=run.inputs[file])
            for file in tables_read
        ),
    ]


# ---- manoeuvres, records, lines


def _manoeuvres(fits: Sequence[Fit], content: _Tables, provenance: Provenance) -> list[Step]:
    """A step for each manoeuvre that the fits have used, with every phase of it."""
    used = [part for fit in fits for part in fit.manoeuvres if not part.reason]
    phases = used_phases(
        list(dict.fromkeys(used)),
        content.read("segment/blocks", tables.BLOCKS),
        content.read("segment/manoeuvres", tables.MANOEUVRES),
        content.read("segment/masks", tables.MASKS),
    )
    lines = content.lines([phase.records for phase in phases])
    listed = content.rows("plan/logs", tables.LOGS)
    logs = {row["log"]: row["file"] for row in listed}
    gyros = {row["log"]: json.loads(row["layout"]).get("gyro_log") for row in listed}
    clocks = {row["log"]: row for row in content.rows("decode/clocks", tables.CLOCKS)}
    changed = {Path(file).name for file, (was, now) in provenance.files().items() if was != now}
    steps = []
    for label, of_label in groupby(phases, key=lambda phase: phase.label):
        details: list[str] = []
        for phase in of_label:
            log = phase.records.log
            file = logs.get(log, log)
            details.append(in_blocks(phase))
            if phase.records in lines:
                where, path = lines[phase.records], content.campaign.raw / file
                details += [in_lines(path, where), in_time(where, clocks.get(log, {}))]
                if other := gyros.get(log):
                    details.append(_("  and the readings of {log} then", log=other["file"]))
                details += [] if file in changed else first_and_last(path, where)
        steps.append(Step(f"used: {label}", details))
    return steps


# ---- the files of the laboratory


def _files(campaign: Campaign, provenance: Provenance) -> Step:
    lines = []
    for file, (was, now) in provenance.files().items():
        state = "unchanged" if was == now else "MISSING" if now is None else "CHANGED"
        lines.append(f"{campaign.path(file)}, SHA-256 {was}, {state}")
    return Step(_("read from the laboratory"), lines)


def _listed_otherwise(inputs: Sequence[Row], provenance: Provenance) -> list[str]:
    """Files that the report lists with another SHA-256 than they were read with."""
    listed = {row["file"]: row["sha256"] for row in inputs}
    return [
        _(
            "{file} is listed in plan/inputs.parquet with another SHA-256 than it was read "
            "with: {listed} instead of {was}.",
            file=file,
            listed=listed[name],
            was=was,
        )
        for file, (was, _unused) in provenance.files().items()
        if (name := Path(file).name) in listed and listed[name] != was
    ]


# ---- A range of records in words: blocks, lines and bytes of the log, time, first and last line.

GPS_WEEK = 604_800  # s
MAX_SHOWN_BYTES = 100  # of a line


def in_blocks(phase: UsedPhase) -> str:
    """Its blocks, samples and records, and what masks some of them."""
    masked = (
        _(", some masked by {findings}", findings=", ".join(phase.findings))
        if phase.findings
        else ""
    )
    return _(
        "{phase}: {blocks} blocks, {samples:g} samples, records {first} to {after}{masked}",
        phase=phase.phase,
        blocks=phase.blocks,
        samples=phase.samples,
        first=phase.records.first,
        after=phase.records.after - 1,
        masked=masked,
    )


def in_lines(log: Path, where: LogLines) -> str:
    """The lines and bytes of the log; rows where it is no text."""
    if not where.of_text:
        return _(
            "  {log}, rows {from_line} to {to_line}, {decoded} of them decoded",
            log=log,
            from_line=where.from_line,
            to_line=where.to_line,
            decoded=where.decoded,
        )
    return _(
        "  {log}, line {from_line} (from byte {from_byte}) to line {to_line} (from byte "
        "{to_byte}), {decoded} of them decoded",
        log=log,
        from_line=where.from_line,
        from_byte=where.from_byte,
        to_line=where.to_line,
        to_byte=where.to_byte,
        decoded=where.decoded,
    )


def in_time(where: LogLines, clock: Row) -> str:
    """The time span; for GPS also as week and seconds, as the lines state it."""
    if isnan(where.from_s):
        return _("  without time")
    epoch = clock.get("epoch_gps")
    origin = _("the log's first sample") if epoch is None else _("the campaign's first sample")
    span = _(
        "  {from_s:.3f} s to {to_s:.3f} s since {origin}",
        from_s=where.from_s,
        to_s=where.to_s,
        origin=origin,
    )
    if epoch is not None:
        week, start = divmod(epoch + where.from_s, GPS_WEEK)
        span += _(
            "; GPS week {week:.0f}, {start:.3f} s to {start_2:.3f} s",
            week=week,
            start=start,
            start_2=start + where.to_s - where.from_s,
        )
    return span


def first_and_last(log: Path, where: LogLines) -> list[str]:
    """The first and the last line, as they stand in the log."""
    ends = {where.from_line: where.from_byte, where.to_line: where.to_byte}
    if not log.is_file() or not where.of_text:
        return []
    texts = []
    with log.open("rb") as file:
        for line, byte in ends.items():
            file.seek(byte)
            text = file.readline(MAX_SHOWN_BYTES).decode("utf-8", "backslashreplace")
            texts.append(f"  line {line}: " + visible(text.rstrip("\r\n")))
    return texts
