"""The font of Chinese letters in the PDF: Noto Sans SC (OFL 1.1), cut to those that are used.

The page on screen takes the fonts of the machine, for a whole one has 17 MB; the archive must look
the same everywhere.
"""

from __future__ import annotations

import io
import string
from base64 import b64encode
from collections.abc import Iterator
from functools import lru_cache
from html import unescape
from importlib.util import find_spec
from pathlib import Path

from fontTools.subset import Options, Subsetter  # type: ignore[import-untyped]
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]
from fontTools.varLib.instancer import instantiateVariableFont  # type: ignore[import-untyped]

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
