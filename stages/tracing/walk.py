"""The way from a number down to the lines of the logs, in steps that can be read."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from math import isnan
from pathlib import Path
from typing import Any

import pandas as pd

from inertial import tables
from inertial.campaign.records import Row, rows_of
from inertial.tables.errors import Refusal
from inertial.tables.table import Table
from inertial.text.numbers import visible
from stages.tracing.lines import Lines, Stretch, lines_of
from stages.tracing.number import Number, number
from stages.tracing.origins import Campaign, Origin, Origins
from stages.tracing.stretches import Used, used

WEEK = 604_800  # s
SHOWN = 100  # bytes of a line


@dataclass(frozen=True)
class Step:
    """One step down: what it is, and what there is to say of it."""

    title: str
    lines: Sequence[str]


@dataclass(frozen=True)
class Walk:
    """The steps, and in sentences which links between them do not hold."""

    steps: Sequence[Step]
    broken: Sequence[str]


def walk(campaign: Campaign, identifier: str, settings: Mapping[str, Any]) -> Walk:
    """From the number `identifier` of a campaign to the lines it came from.

    `settings` are those of today, one section per stage.

    Raises
    ------
    Refusal
        where there is no such number
    """
    found = number(campaign, identifier)
    stage = found.table.partition("/")[0]
    told_by = [found.table, f"{stage}/fit.parquet", "plan/inputs.parquet"]
    origins = Origins(campaign, told_by, settings)
    content = _Content(campaign)
    fits = _fits(found, content, origins)
    steps = [_number(found), _method(found, origins), *(_fit(fit, found) for fit in fits)]
    steps += [_stage(origin) for origin in origins.stages if origin.stage != stage]
    steps += _manoeuvres(fits, content, origins)
    steps.append(_files(campaign, origins))
    inputs = content.rows("plan/inputs", tables.INPUTS)
    return Walk(steps, [*origins.broken, *_otherwise_listed(inputs, origins), *content.broken])


class _Content:
    """The tables of a campaign; one that cannot be read breaks the chain, but not the walk."""

    def __init__(self, campaign: Campaign) -> None:
        self.campaign = campaign
        self.broken: list[str] = []

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

    def lines(self, stretches: Sequence[Stretch]) -> dict[Stretch, Lines]:
        """Where the records of some stretches stand in their logs."""
        path = self.campaign.path("decode/samples.parquet")
        try:
            return lines_of(tables.SAMPLES.stream(path), stretches)
        except Refusal as refusal:
            self._note(refusal)
            return {}

    def _note(self, refusal: Refusal) -> None:
        self.broken.append(f"{refusal.file} cannot be read: {refusal.found}.")


# ---- the number and its method


def _number(found: Number) -> Step:
    row = found.row
    frame = f", frame: {row['frame']}" if row["frame"] else ""
    if row["value"] is None:
        return Step(f"{row['id']} is not determined", [row["meaning"] + frame, row["reason"]])
    value = f"{row['value']:.10g} ± {row['sigma']:.2g}" + _unit(row["unit"])
    return Step(f"{row['id']} = {value}", [row["meaning"] + frame])


def _method(found: Number, origins: Origins) -> Step:
    row = found.row
    made = [line for o in origins.stages if o.stage == row["stage"] for line in _made(o)]
    return Step(f"estimated by the stage {row['stage']}, method {row['method']}", made)


@dataclass(frozen=True)
class Fit:
    """A row of FIT, and the stage that made it."""

    stage: str
    row: Row


def _fits(found: Number, content: _Content, origins: Origins) -> list[Fit]:
    """The fits that say what a number was estimated from: its own, or those that it rests on.

    A method that keeps no fit chose from what the joint one of its mount used. A stage that keeps
    none rests on the stages behind it, and where its method is called after one, on that one.
    """
    method, _, mount = found.row["method"].partition("@")
    joint = f"joint@{mount}" if mount else "joint"
    stage = found.table.partition("/")[0]
    by_stage = {
        origin.stage: {
            row["method"]: row for row in content.rows(f"{origin.stage}/fit", tables.FIT)
        }
        for origin in origins.stages
        if content.campaign.path(f"{origin.stage}/fit.parquet").is_file()
    }
    if not by_stage:
        content.broken.append(f"No table says what {found.row['id']} was estimated from.")
    nearest = [one for one in (stage, method) if one in by_stage][:1]
    fits = []
    for one in nearest or by_stage:
        own = by_stage[one].get(found.row["method"]) if one == stage else None
        row = own or by_stage[one].get(joint)
        fits += [Fit(one, row)] if row else []
    return fits


def _fit(fit: Fit, found: Number) -> Step:
    row = fit.row
    lines = [
        f"chi-squared {row['chi_squared']:.1f} with {row['degrees']} degrees of freedom, "
        f"p = {row['p_value']:.2g}",
        f"scatter between manoeuvres beyond the noise: {row['scatter']:.3g}{_unit(row['unit'])}",
        f"used: {row['used'] or 'nothing'}",
        *(f"left out: {one}" for one in row["left_out"].split("; ") if one),
    ]
    if (fit.stage, row["method"]) != (found.row["stage"], found.row["method"]):
        whose = f"{found.row['stage']}, method {found.row['method']}"
        lines.insert(0, f"{whose}, keeps no record of what it used; it rests on what this fit used")
    return Step(f"the fit of the stage {fit.stage}, method {row['method']}", lines)


def _unit(unit: str) -> str:
    return "" if unit == "1" else f" {unit}"


# ---- the stages between


def _stage(origin: Origin) -> Step:
    return Step(f"from the stage {origin.stage}: {', '.join(sorted(origin.tables))}", _made(origin))


def _made(origin: Origin) -> list[str]:
    settings = ", ".join(f"{name}: {value}" for name, value in origin.settings.items())
    made_from = [file for file in origin.inputs if file.endswith(".parquet")]
    return [
        f"settings: {settings or 'none'}",
        f"code: SHA-256 {origin.code}",
        *(f"read {file}, SHA-256 {origin.inputs[file]}" for file in made_from),
    ]


# ---- manoeuvres, records, lines


def _manoeuvres(fits: Sequence[Fit], content: _Content, origins: Origins) -> list[Step]:
    """A step for each manoeuvre that the fits have used, with every phase of it."""
    labels = [label for fit in fits for label in fit.row["used"].split(", ")]
    parts = used(
        list(dict.fromkeys(labels)),
        content.read("segment/blocks", tables.BLOCKS),
        content.read("plan/manoeuvres", tables.MANOEUVRES),
        content.read("quality/masks", tables.MASKS),
    )
    lines = content.lines([part.stretch for part in parts])
    logs = {row["log"]: row["file"] for row in content.rows("plan/logs", tables.LOGS)}
    clocks = {row["log"]: row for row in content.rows("decode/clocks", tables.CLOCKS)}
    changed = {Path(file).name for file, (was, now) in origins.files().items() if was != now}
    steps = []
    for label, phases in groupby(parts, key=lambda part: part.label):
        told: list[str] = []
        for part in phases:
            file = logs.get(part.stretch.log, part.stretch.log)
            told += [_blocks(part)]
            if part.stretch in lines:
                where, clock = lines[part.stretch], clocks.get(part.stretch.log, {})
                log = content.campaign.raw / file
                told += [_place(log, where), _when(where, clock)]
                told += [] if file in changed else _texts(log, where)
        steps.append(Step(f"used: {label}", told))
    return steps


def _blocks(part: Used) -> str:
    masked = f", some masked by {', '.join(part.findings)}" if part.findings else ""
    return (
        f"{part.phase}: {part.blocks} blocks, {part.samples:g} samples, "
        f"records {part.stretch.first} to {part.stretch.after - 1}{masked}"
    )


def _place(log: Path, where: Lines) -> str:
    if not where.of_text:
        return (
            f"  {log}, rows {where.from_line} to {where.to_line}, {where.decoded} of them decoded"
        )
    return (
        f"  {log}, line {where.from_line} (from byte {where.from_byte}) "
        f"to line {where.to_line} (from byte {where.to_byte}), {where.decoded} of them decoded"
    )


def _when(where: Lines, clock: Row) -> str:
    """The time span; for GPS also as week and seconds, as the lines say it."""
    if isnan(where.from_s):
        return "  without time"
    epoch = clock.get("epoch_gps")
    since = "the log's first sample" if epoch is None else "the campaign's first sample"
    told = f"  {where.from_s:.3f} s to {where.to_s:.3f} s since {since}"
    if epoch is not None:
        week, start = divmod(epoch + where.from_s, WEEK)
        told += f"; GPS week {week:.0f}, {start:.3f} s to {start + where.to_s - where.from_s:.3f} s"
    return told


def _texts(log: Path, where: Lines) -> list[str]:
    """The first and the last line, as they stand in the log."""
    ends = {where.from_line: where.from_byte, where.to_line: where.to_byte}
    if not log.is_file() or not where.of_text:
        return []
    with log.open("rb") as file:
        told = []
        for line, byte in ends.items():
            file.seek(byte)
            text = visible(file.readline(SHOWN).decode("utf-8", "backslashreplace").rstrip("\r\n"))
            told.append(f"  line {line}: {text}")
    return told


# ---- the files that the laboratory gave


def _files(campaign: Campaign, origins: Origins) -> Step:
    told = []
    for file, (was, now) in origins.files().items():
        state = "unchanged" if was == now else "MISSING" if now is None else "CHANGED"
        told.append(f"{campaign.path(file)}, SHA-256 {was}, {state}")
    return Step("read from the laboratory", told)


def _otherwise_listed(inputs: Sequence[Row], origins: Origins) -> list[str]:
    """Files that the report lists with another SHA-256 than they were read with."""
    listed = {row["file"]: row["sha256"] for row in inputs}
    return [
        f"{file} is listed in plan/inputs.parquet with another SHA-256 than it was read with:"
        f" {listed[name]} instead of {was}."
        for file, (was, _) in origins.files().items()
        if (name := Path(file).name) in listed and listed[name] != was
    ]
