"""The calibration report: the result, how sure it is, and where every number comes from."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import count
from string import ascii_uppercase
from typing import Any

from inertial.tables.stage import Stage
from inertial.text.messages import ENGLISH, LOCALES, _
from inertial.text.numbers import shortened
from inertial.text.typography import typeset
from inertial.text.units import written_in
from stages.report.declared import DECLARED
from stages.report.outline import Chapter, Report, Section
from stages.report.page import page
from stages.report.results import origins
from stages.report.sections import (
    averaging,
    basis,
    certificate,
    characteristics,
    comparisons,
    compensation,
    findings,
    navigation,
    noise,
    noise_by_manoeuvre,
    parameters,
    raw_data,
    repeatability,
    residual_figures,
    residuals,
    studies,
    temperature,
    terms,
    uncertainty_budget,
    unmodelled_effects,
    verdict,
)
from stages.report.tables import Tables

EVIDENCE = (
    certificate.SECTION,
    verdict.SECTION,
    noise.SECTION,
    residual_figures.SECTION,
    unmodelled_effects.SECTION,
    comparisons.COMPARISONS,
    compensation.SECTION,
    navigation.SECTION,
    navigation.ALIGNMENT,
    uncertainty_budget.SECTION,
    temperature.SECTION,
    comparisons.HISTORY,
    repeatability.SECTION,
)
ANNEXES = (
    parameters.PARAMETERS,
    parameters.UNDETERMINED,
    findings.SECTION,
    unmodelled_effects.EFFECTS,
    residuals.SECTION,
    compensation.CHECKS,
    characteristics.SECTION,
    averaging.SECTION,
    studies.SECTION,
    basis.RECORDED,
    raw_data.SECTION,
    noise_by_manoeuvre.SECTION,
    basis.KNOWN,
    basis.IDEAL,
    basis.ACCOUNT,
    basis.PROVENANCE,
)


def report(
    provenance: Mapping[str, Mapping[str, Any]],
    *,
    units: str = "laboratory",
    language: str = ENGLISH,
    **read: Any,
) -> dict[str, str]:
    """The report of one campaign as a page, and its verdict as plain text.

    `language`: that of the process, which `__main__` has set before anything was imported.
    """
    with written_in(units):
        return _report(Tables(read, provenance), LOCALES[language])


def _report(tables: Tables, language: str) -> dict[str, str]:
    about = tables.row("campaign")
    name, serial = (shortened(about[key], 80) for key in ("campaign", "serial"))
    instrument = _(
        "{instrument} · serial {serial}",
        instrument=shortened(about["instrument"], 80),
        serial=serial,
    )
    number = shortened(certificate.certificate_number(tables), 80)
    outline = Report(
        title=certificate.title_of(tables, number),
        campaign=name,
        instrument=instrument,
        running=f"{number} · {instrument}" + (_(" · simulated") if about["simulated"] else ""),
        simulated=bool(about["simulated"]),
        language=language,
        chapters=_every_chapter(tables),
        origins={key: [*map(typeset, said)] for key, said in origins(tables).items()},
    )
    return {"html": page(outline), "txt": verdict.as_text(tables)}


def _every_chapter(tables: Tables) -> list[Chapter]:
    """The evidence, the annexes, and behind these the terms that all of them use."""
    letters = iter(ascii_uppercase)
    annexes = list(_chapters(ANNEXES, letters, tables))
    chapters = [*_chapters(EVIDENCE, map(str, count(1)), tables), *annexes]
    if annexes and (used := list(terms.used(chapters))):
        chapters.append(Chapter(next(letters), terms.SECTION, used))
    return chapters


def _chapters(
    sections: Sequence[Section], numbers: Iterator[str], tables: Tables
) -> Iterator[Chapter]:
    """The sections that have something to show."""
    for each in sections:
        section = certificate.section(tables) if each is certificate.SECTION else each
        if parts := list(section.parts(tables)):
            yield Chapter(next(numbers), section, parts)


STAGE = Stage(report, DECLARED)
