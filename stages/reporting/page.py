"""The report as one HTML page: the outline poured into its template."""

from __future__ import annotations

from html import unescape
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from stages.reporting.fonts import faces
from stages.reporting.outline import Report

FOLDER = Path(__file__).parent
LONGEST = {"code": 64}  # letters of a word that a cell of this kind has room for: a hash
LONGEST_ELSE = 24


def page(report: Report) -> str:
    """One file: text, tables, figures, style and fonts; no network, no script.

    Whatever came from outside is escaped; only the figures, which are drawn here,
    and the style go in as they are.
    """
    environment = Environment(
        loader=FileSystemLoader(FOLDER, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["drawn"] = Markup
    environment.tests["long"] = _long
    style = Markup((FOLDER / "report.css").read_text(encoding="utf-8"))
    template = environment.get_template("report.html")
    plain = template.render(report=report, style=style, faces=[])
    return template.render(report=report, style=style, faces=faces(unescape(plain)))


def _long(text: str, kind: str) -> bool:
    """Whether a cell holds a word that must be broken anywhere."""
    return any(len(word) > LONGEST.get(kind, LONGEST_ELSE) for word in text.split())
