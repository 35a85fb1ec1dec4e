"""The report as one HTML page: the outline poured into its template, with style and fonts.

The letters are matplotlib's DejaVu fonts, cut to those that are used. They travel inside the
page, so that it looks the same on every machine, without network and installed fonts.
"""

import base64
import io
import re
import string
from dataclasses import dataclass
from functools import lru_cache
from html import unescape
from pathlib import Path

import matplotlib as mpl
from fontTools.subset import Options, Subsetter  # type: ignore[import-untyped]
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from inertial.text.messages import LOCALES, _
from inertial.text.typography import typeset
from stages.report.outline import Report

FOLDER = Path(__file__).parent
MOST_LETTERS = {"code": 64}  # of a word that a cell of this kind has room for: a hash
MOST_LETTERS_ELSE = 24
SENTENCE = re.compile(r">[^<>]+<(?!/(?:code|text|script))")  # but identifiers, and words of figures
SYMBOL = re.compile(r"(?<![\w/.])([A-Za-zΣωθφτδρ]\d?)_([xyzij]{1,2}|\d)(?![\w/.]\w)")
FONTS = (
    ("Report", 400, "normal", "DejaVuSans.ttf"),
    ("Report", 700, "normal", "DejaVuSans-Bold.ttf"),
    ("Report", 400, "italic", "DejaVuSans-Oblique.ttf"),
    ("Report Mono", 400, "normal", "DejaVuSansMono.ttf"),
)
WORDS = {  # of the template
    "See also": _("See also"),
    "Contents": _("Contents"),
    "How to read it.": _("How to read it."),
    "Simulated": _("Simulated"),
    "Where this number comes from": _("Where this number comes from"),
    "No instrument of this serial was calibrated: the simulated laboratory recorded it.": _(
        "No instrument of this serial was calibrated: the simulated laboratory recorded it."
    ),
}
FULL_WIDTH_QUOTES = frozenset("“”‘’")
# In every report, whether its words happen to need them or not.
ALWAYS = frozenset(
    string.printable
    + "".join(map(chr, range(0xA0, 0x100)))  # Latin-1: ° ± × µ ² ³
    + "αβγδεωρσφχΔΩ₀₁₂₃₄₅₆₇₈₉ₓ⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺√−–—…’“”≥≤≈→✓✗●◐○�\u2007\u2008\u202f"
)


def page(report: Report) -> str:
    """One file: text, tables, figures, style, fonts and one short script; no network.

    Whatever came from outside is escaped; only the figures, which are drawn here, the style and
    the script go in as they are.
    """
    environment = Environment(
        loader=FileSystemLoader(FOLDER, encoding="utf-8"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.finalize = lambda text: typeset(text) if type(text) is str else text
    environment.filters["drawn"] = Markup
    environment.globals["words"] = WORDS
    environment.tests |= {"long": _long, "words": _words}
    style, script = (
        Markup((FOLDER / file).read_text(encoding="utf-8")) for file in ("report.css", "report.js")
    )
    template = environment.get_template("report.html")
    plain = unescape(template.render(report=report, style=style, script=script, fonts=[]))
    letters = ALWAYS.union(plain)
    if report.language == LOCALES["zh"]:
        letters -= FULL_WIDTH_QUOTES  # as wide as a character, hence of the Chinese font
    fonts = _fonts("".join(sorted(letters)))
    whole = template.render(report=report, style=style, script=script, fonts=fonts)
    head, main, body = whole.partition("<main>")
    # The indices of symbols in sentences are below the line, as in tables.
    below = SENTENCE.sub(lambda text: SYMBOL.sub(r"<i>\1</i><sub>\2</sub>", text[0]), body)
    return head + main + below


def _long(text: str, kind: str) -> bool:
    """Whether a cell holds a word that must be broken anywhere."""
    return any(len(word) > MOST_LETTERS.get(kind, MOST_LETTERS_ELSE) for word in text.split())


def _words(text: str, kind: str) -> bool:
    """Whether a cell for a number holds words, which need not stand in one line."""
    return kind == "number" and " " in text and not any(map(str.isdigit, text))


@dataclass(frozen=True)
class Font:
    """A font of the page: its family, weight and style, and its file as base64."""

    family: str
    weight: int
    style: str
    data: str


@lru_cache(maxsize=4)
def _fonts(letters: str) -> list[Font]:
    """Each font with these letters only."""
    folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
    fonts = []
    for family, weight, style, file in FONTS:
        options = Options(flavor="woff2", layout_features=["kern"])
        options.name_IDs = [1, 2]
        options.notdef_outline = True
        options.drop_tables += ["FFTM"]  # a time stamp of FontForge
        with TTFont(folder / file, recalcTimestamp=False) as font:
            subsetter = Subsetter(options)
            subsetter.populate(text=letters)
            subsetter.subset(font)
            font.flavor = "woff2"
            written = io.BytesIO()
            font.save(written)
        data = base64.b64encode(written.getvalue()).decode()
        fonts.append(Font(family, weight, style, data))
    return fonts
