"""The letters of the report: matplotlib's DejaVu fonts, cut to the letters that are used.

They travel inside the page, so that it looks the same on every machine, on
screen and in print, without network and without installed fonts.
"""

from __future__ import annotations

import base64
import io
import string
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import matplotlib as mpl
from fontTools.subset import Options, Subsetter  # type: ignore[import-untyped]
from fontTools.ttLib import TTFont  # type: ignore[import-untyped]


@dataclass(frozen=True)
class Face:
    """A font of the page: its family, weight and style, and its file as base64."""

    family: str
    weight: int
    style: str
    data: str


FACES = (
    ("Report", 400, "normal", "DejaVuSans.ttf"),
    ("Report", 700, "normal", "DejaVuSans-Bold.ttf"),
    ("Report", 400, "italic", "DejaVuSans-Oblique.ttf"),
    ("Report Mono", 400, "normal", "DejaVuSansMono.ttf"),
)


# In every report, whether its words happen to need them or not.
ALWAYS = frozenset(
    string.printable
    + "".join(map(chr, range(0xA0, 0x100)))  # Latin-1: ° ± × µ ² ³
    + "αβγδεωρσφχΔΩ₀₁₂₃₄₅₆₇₈₉ₓ⁰¹²³⁴⁵⁶⁷⁸⁹⁻⁺√−–—…’“”≥≤≈→✓✗●◐○�\u2007\u2008\u202f"
)


def faces(text: str) -> list[Face]:
    """The fonts of the report with the letters of `text`, and those that are always there."""
    return list(_cut("".join(sorted(ALWAYS.union(text)))))


@lru_cache(maxsize=4)
def _cut(letters: str) -> tuple[Face, ...]:
    def each() -> Iterator[Face]:
        folder = Path(mpl.get_data_path()) / "fonts" / "ttf"
        for family, weight, style, file in FACES:
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
            yield Face(family, weight, style, base64.b64encode(written.getvalue()).decode())

    return tuple(each())
