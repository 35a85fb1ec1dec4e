"""The calibration report: the result, how sure it is, and where every number comes from."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from inertial.tables.stage import Stage
from inertial.text.messages import _
from inertial.text.numbers import shortened
from stages.report.declared import DECLARED
from stages.report.outline import Report
from stages.report.page import page
from stages.report.sections import (
    averaging,
    basis,
    characteristics,
    comparisons,
    compensation,
    findings,
    noise,
    noise_by_manoeuvre,
    parameters,
    raw_data,
    residuals,
    studies,
    temperature,
    unmodelled_effects,
    verdict,
)
from stages.report.tables import Tables

SECTIONS = (
    verdict.SECTION,
    parameters.PARAMETERS,
    unmodelled_effects.SECTION,
    findings.SECTION,
    parameters.UNDETERMINED,
    residuals.SECTION,
    comparisons.COMPARISONS,
    compensation.SECTION,
    characteristics.SECTION,
    comparisons.HISTORY,
    basis.RECORDED,
    raw_data.SECTION,
    noise.SECTION,
    temperature.SECTION,
    averaging.SECTION,
    studies.SECTION,
    noise_by_manoeuvre.SECTION,
    basis.KNOWN,
    basis.ACCOUNT,
    basis.PROVENANCE,
)


def report(provenance: Mapping[str, Mapping[str, Any]], **read: Any) -> dict[str, str]:
    """The report of one campaign as a page, and its verdict as plain text."""
    tables = Tables(read, provenance)
    about = tables.row("campaign")
    name, serial = (shortened(about[key], 80) for key in ("campaign", "serial"))
    instrument = f"{shortened(about['instrument'], 80)} · serial {serial}"
    outline = Report(
        title=_("Calibration report: {name} · {instrument}", name=name, instrument=instrument),
        campaign=name,
        instrument=instrument,
        running=f"{name} · {instrument}" + (" · simulated" if about["simulated"] else ""),
        simulated=bool(about["simulated"]),
        sections=[(section, own) for section in SECTIONS if (own := list(section.parts(tables)))],
    )
    return {"html": page(outline), "txt": verdict.as_text(tables)}


STAGE = Stage(report, DECLARED)
