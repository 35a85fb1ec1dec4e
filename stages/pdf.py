"""The lab report for print: its HTML page as PDF, A4.

    python -m stages.pdf --html reports/demo.html --output reports/demo.pdf

The page brings its figures and fonts along; nothing else is fetched, neither
from the network nor from the disk.
"""

import argparse
import gc
import importlib
import os
import re
import sys
from base64 import b64encode
from collections.abc import Sequence
from pathlib import Path
from types import ModuleType

from inertial.tables.errors import Refusal
from inertial.tables.whole_files import write_whole

FIGURE = re.compile(r'<div role="img" aria-label=("[^"]*")>(<svg .*?</svg>)</div>', re.DOTALL)
PACKAGES = "libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0"


def pdf(html: str) -> bytes:
    """`html` as PDF; the same page gives the same bytes.

    Raises
    ------
    Refusal
        where the system lacks the libraries that set text
    """
    weasyprint = _weasyprint()
    # The date of the fonts, where fontTools makes the subsets of them; else it would be now.
    os.environ.setdefault("SOURCE_DATE_EPOCH", "0")
    nothing_outside = weasyprint.urls.URLFetcher(allowed_protocols=("data",))
    document = weasyprint.HTML(string=FIGURE.sub(_image, html), url_fetcher=nothing_outside)
    return bytes(document.write_pdf(pdf_tags=True))


def _image(figure: re.Match[str]) -> str:
    """A figure as an image: else the page's style is asked for each of its thousands of parts."""
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
            "its libraries",
            str(error).partition("\n")[0],
            "Pango and HarfBuzz",
            f"apt-get install {PACKAGES}",
        ) from error


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the page, write the PDF beside its place, then move it there."""
    parser = argparse.ArgumentParser(description=pdf.__doc__)
    parser.add_argument("--html", type=Path, required=True, help="the page that report wrote")
    parser.add_argument("--output", type=Path, required=True, help="the PDF")
    given = parser.parse_args(arguments)
    gc.disable()  # all of the document is held up to its last page
    try:
        write_whole({given.output: pdf(given.html.read_text(encoding="utf-8"))})
    except Refusal as refusal:
        sys.exit(f"pdf: {refusal}\nThe report is there as a page: {given.html}")


if __name__ == "__main__":
    main()
