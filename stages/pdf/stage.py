"""The report for print and for archives: its HTML page as PDF/A-3a (ISO 19005-3), A4.

The page brings its figures and fonts along; nothing else is fetched, neither
from the network nor from the disk. Its numbers as data are attached.
"""

import gc
import importlib
import io
import os
import re
import string
from base64 import b64encode
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from functools import lru_cache
from html import unescape
from importlib.util import find_spec
from pathlib import Path
from types import ModuleType

from fontTools.subset import Options, Subsetter  # type: ignore[import-untyped]
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]
from fontTools.varLib.instancer import instantiateVariableFont  # type: ignore[import-untyped]

from inertial.tables.errors import Refusal
from inertial.tables.stage import Stage
from inertial.text.messages import _
from stages.pdf.declared import DECLARED

FIGURE = re.compile(r'<div role="img" aria-label=("[^"]*")>(<svg .*?</svg>).*?</div>', re.DOTALL)
# What no line ends within: a number with its unit, a unit with a solidus, a coverage factor, and a
# name or a term that begins with a single letter, as x-forward and g-sensitivity do.
UNIT = r"(?:°(?:/[\w√/]+)?|[µm]?g|[mµ]?m(?:/s[²³]?)?|m?rad(?:/s)?|ppm(?:/\w+)?|arcsec|Hz|s|h|%|σ)"
NUMBER = rf"−?\d[\d.\u202f]*(?: ± [\d.]+)? ?{UNIT}"
NAME = r"[A-Za-z](?:-[a-z]{1,12}){1,3}|rest-(?:before|after)"
TOGETHER = re.compile(rf"(?<![\w/.-])(?:{NUMBER}|°/[\w√/]+|{NAME}|k = \d)(?![\w²³√/-])")
SENTENCE = re.compile(r">[^<>]* [^<>]*<")
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
    printed = unbroken(FIGURE.sub(_image, page))
    document = weasyprint.HTML(string=printed, url_fetcher=nothing_outside)
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


def unbroken(page: str) -> str:
    """A page in whose sentences no line ends within what `TOGETHER` describes."""
    head, main, body = page.partition("<main>")

    def sentence(text: re.Match[str]) -> str:
        return TOGETHER.sub(r'<span class="sign">\g<0></span>', text[0])

    return head + main + SENTENCE.sub(sentence, body)


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


# ---- The font of Chinese letters in the PDF: Noto Sans SC (OFL 1.1), cut to those that are used
#
# The page on screen takes the fonts of the machine, for a whole one has 17 MB; the archive must
# look the same everywhere.

FAMILY = "Report Chinese"  # as report.css names it
PACKAGE = "justmytype_intl_cjk"
FILE = "fonts/ofl/notosanssc/NotoSansSC[wght].ttf"
WEIGHTS = (400, 700)
FIRST, LAST = "\u2e80", "\uffef"  # Chinese characters and full-width marks lie between
SPACES = "\u00a0\u2007\u2008\u202f"
MARKS = "“”‘’…—·"  # as wide as a character in Chinese


def font_faces(page: str) -> str:
    """CSS with the font of the Chinese letters of a page; nothing where it has none."""
    letters = {letter for letter in unescape(page) if FIRST <= letter <= LAST}
    if not letters:
        return ""
    # Spaces and letters between Chinese ones may be set in the font of these.
    return "".join(_faces("".join(sorted(letters.union(MARKS, string.printable, SPACES)))))


@lru_cache(maxsize=2)
def _faces(letters: str) -> tuple[str, ...]:
    return tuple(_each(letters))


def _each(letters: str) -> Iterator[str]:
    for weight in WEIGHTS:
        options = Options(layout_features=["locl", "palt"])
        options.notdef_outline = True
        with TTFont(_file(), recalcTimestamp=False) as font:
            subsetter = Subsetter(options)
            subsetter.populate(text=letters)
            subsetter.subset(font)
            written = io.BytesIO()
            instantiateVariableFont(font, {"wght": weight}).save(written)
        data = b64encode(written.getvalue()).decode()
        yield (
            f'@font-face {{ font-family: "{FAMILY}"; font-weight: {weight}; '
            f'src: url("data:font/ttf;base64,{data}") format("truetype"); }}\n'
        )


def _file() -> Path:
    found = find_spec(PACKAGE)
    assert found is not None and found.submodule_search_locations  # requirements.lock has it
    return Path(found.submodule_search_locations[0]) / FILE


STAGE = Stage(pdf, DECLARED)
