"""Where a number comes from: the stage and method that estimated it, its settings, its data."""

from collections.abc import Iterator

from inertial.campaign.log_lines import LogLines, RecordRange, UsedPhase, lines_of, used_phases
from inertial.campaign.records import omissions
from inertial.text.messages import _
from inertial.text.numbers import shortened
from inertial.text.parameters import JOINT
from stages.report.results import ESTIMATE_TABLES, RESULT_TABLES, Estimate, estimates, final_results
from stages.report.tables import Tables

READS = (*RESULT_TABLES, *ESTIMATE_TABLES, "blocks", "manoeuvres", "masks", "samples")


def origins(tables: Tables) -> dict[str, list[str]]:
    """In sentences, by the identifiers of the numbers without their last word."""
    every = [*final_results(tables), *estimates(tables)]
    phases = {id(estimate): _used(tables, estimate) for estimate in every}
    ranges = {phase.records for used in phases.values() for phase in used}
    lines = lines_of(tables.stream("samples"), sorted(ranges, key=lambda own: own.first))
    return {
        row["id"].rpartition("/")[0]: list(
            _sentences(tables, estimate, phases[id(estimate)], lines)
        )
        for estimate in every
        for row in (*estimate.parameters, *estimate.effects)
    }


def _used(tables: Tables, estimate: Estimate) -> list[UsedPhase]:
    used = [part for part in estimate.manoeuvres if not part.reason]
    return used_phases(used, *(tables.frame(name) for name in ("blocks", "manoeuvres", "masks")))


def _sentences(
    tables: Tables,
    estimate: Estimate,
    used: list[UsedPhase],
    lines: dict[RecordRange, LogLines],
) -> Iterator[str]:
    yield estimate.name
    row = next(iter((*estimate.parameters, *estimate.effects)))
    of_result = row["stage"] == "diagnosis"
    estimated = "extended" if of_result and estimate.method != JOINT else estimate.stage
    maker = tables.maker(f"{estimated}_parameters")
    settings = ", ".join(f"{name} {value}" for name, value in maker["settings"].items())
    yield _(
        "Estimated by stage {stage}; settings: {settings}",
        stage=maker["stage"],
        settings=settings or "–",
    )
    if used:
        yield _("From: {places}", places="; ".join(_place(phase, lines) for phase in used))
    if left_out := omissions(estimate.manoeuvres):
        yield _("Left out: {left_out}", left_out=shortened(left_out, 600))
    yield _("In full, with every hash: make trace ID={id}", id=row["id"].rpartition("/")[0] + "/…")


def _place(phase: UsedPhase, lines: dict[RecordRange, LogLines]) -> str:
    where = lines.get(phase.records)
    if where is None:
        return phase.label
    return _(
        "{label}: {log}, {kind} {first}–{last}",
        label=phase.label,
        log=phase.records.log,
        kind=_("lines") if where.of_text else _("rows"),
        first=where.from_line,
        last=where.to_line,
    )
