"""The report for print: its HTML page as PDF, A4.

The page brings its figures and fonts along; nothing else is fetched, neither
from the network nor from the disk.
"""

import gc
import importlib
import os
import re
from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from inertial.tables.errors import Refusal
from inertial.tables.stage import Stage
from inertial.text.messages import _
from stages.pdf.declared import DECLARED

FIGURE = re.compile(r'<div role="img" aria-label=("[^"]*")>(<svg .*?</svg>)</div>', re.DOTALL)
PACKAGES = _("libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0")


def pdf(html: Sequence[Path]) -> dict[str, bytes]:
    """The page `html`, the only one, as PDF."""
    gc.disable()  # all of the document is held up to its last page
    return {"pdf": as_pdf(html[0].read_text(encoding="utf-8"))}


def as_pdf(page: str) -> bytes:
    """A page as PDF; the same page gives the same bytes.

    Raises
    ------
    Refusal
        where the system lacks the libraries that set text
    """
    weasyprint = _weasyprint()
    # The date of the fonts, where fontTools makes the subsets of them; else it would be now.
    os.environ.setdefault("SOURCE_DATE_EPOCH", "0")
    nothing_outside = weasyprint.urls.URLFetcher(allowed_protocols=("data",))
    document = weasyprint.HTML(string=FIGURE.sub(_image, page), url_fetcher=nothing_outside)
    return bytes(document.write_pdf(pdf_tags=True))


def _image(figure: re.Match[str]) -> str:
    """A figure as an image: else the style of the page is applied to its thousands of parts."""
    words, drawn = figure.groups()
    data = b64encode(drawn.encode()).decode()
    return f'<img alt={words} src="data:image/svg+xml;base64,{data}">'


def _weasyprint() -> ModuleType:
    """WeasyPrint, whose import fails where the system lacks the libraries that set text."""
    try:
        return importlib.import_module("weasyprint")
    except OSError as error:
        raise Refusal(
            "WeasyPrint",
            _("its libraries"),
            str(error).partition("\n")[0],
            _("Pango and HarfBuzz"),
            _("apt-get install {packages}; the report is there as a page", packages=PACKAGES),
        ) from error


STAGE = Stage(pdf, DECLARED)
