"""The report for print and for archives: its HTML page as PDF/A-3a (ISO 19005-3), A4.

The page brings its figures and fonts along; nothing else is fetched, neither
from the network nor from the disk. Its numbers as data are attached.
"""

import gc
import importlib
import os
import re
from base64 import b64encode
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from pathlib import Path
from types import ModuleType

from inertial.tables.errors import Refusal
from inertial.tables.stage import Stage
from inertial.text.messages import _
from stages.pdf.chinese_font import font_faces
from stages.pdf.declared import DECLARED

FIGURE = re.compile(r'<div role="img" aria-label=("[^"]*")>(<svg .*?</svg>).*?</div>', re.DOTALL)
PACKAGES = "libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"
VARIANT = "pdf/a-3a"
# A PDF/A wants the day of an attachment; the tables know none, and the same page must give the
# same bytes.
NO_DAY = datetime(1970, 1, 1, tzinfo=UTC)
ATTACHED = {
    ".json": _("The calibration, every number to the last digit"),
    ".xml": _("The certificate as Digital Calibration Certificate"),
}


def pdf(html: Sequence[Path], attached: Sequence[Path] = ()) -> dict[str, bytes]:
    """The page `html`, the only one, as PDF with the files attached."""
    gc.disable()  # all of the document is held up to its last page
    files = {path.name: path.read_bytes() for path in attached}
    return {"pdf": as_pdf(html[0].read_text(encoding="utf-8"), files)}


def as_pdf(page: str, attached: Mapping[str, bytes] | None = None) -> bytes:
    """A page as PDF; the same page gives the same bytes. `attached`: by the names of the files.

    Raises
    ------
    Refusal
        where the system lacks the libraries that set text
    """
    weasyprint = _weasyprint()
    # The date of the fonts, where fontTools makes the subsets of them; else it would be now.
    os.environ.setdefault("SOURCE_DATE_EPOCH", "0")
    nothing_outside = weasyprint.urls.URLFetcher(allowed_protocols=("data",))
    fonts = weasyprint.text.fonts.FontConfiguration()
    chinese = weasyprint.CSS(
        string=font_faces(page), font_config=fonts, url_fetcher=nothing_outside
    )
    document = weasyprint.HTML(string=FIGURE.sub(_image, page), url_fetcher=nothing_outside)
    attachments = [
        weasyprint.Attachment(
            string=content,
            name=name,
            description=ATTACHED.get(Path(name).suffix, name),
            created=NO_DAY,
            modified=NO_DAY,
            relationship="Data",
        )
        for name, content in sorted((attached or {}).items())
    ]
    return bytes(
        document.write_pdf(
            pdf_variant=VARIANT,
            attachments=attachments,
            stylesheets=[chinese],
            font_config=fonts,
        )
    )


def _image(figure: re.Match[str]) -> str:
    """A figure as an image: else the style of the page is applied to its thousands of parts.

    Its columns, which stand behind it for narrow screens, are left out.
    """
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
