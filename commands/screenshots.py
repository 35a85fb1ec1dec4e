"""`python -m commands.screenshots`: a report as a person sees it, in pictures to look at.

Wide and narrow, light and dark, and as printed; a page is longer than a picture, so each is
several, one below the other. Palette PNG, for a report has few colours.
"""

import argparse
import io
import sys
from pathlib import Path

from PIL import Image

from commands.browser import Page, browser

HEIGHT = 2000  # of a picture, pixels
COLOURS = 64
VIEWS = {  # width in pixels, medium, scheme
    "1400-light": (1400, "screen", "light"),
    "1400-dark": (1400, "screen", "dark"),
    "400-light": (400, "screen", "light"),
    "400-dark": (400, "screen", "dark"),
    "print": (794, "print", "light"),  # A4 at 96 pixels per inch
}


def screenshots(page: Page, report: Path, folder: Path) -> None:
    """All pictures of a report into a folder, which is made."""
    folder.mkdir(parents=True, exist_ok=True)
    page.open(report)
    for view, (width, medium, scheme) in VIEWS.items():
        page.shape(width, HEIGHT, medium, scheme)
        length = int(page.evaluate("document.documentElement.scrollHeight"))
        for number, top in enumerate(range(0, length, HEIGHT), 1):
            taken = page.picture(width, top, min(HEIGHT, length - top))
            with Image.open(io.BytesIO(taken)) as picture:
                few = picture.convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
                few.save(folder / f"{report.stem}-{view}-{number:02}.png", optimize=True)


def main() -> None:
    """The pictures of a campaign's report."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--campaign", required=True)
    parser.add_argument("--reports", type=Path, default=Path("reports"))
    options = parser.parse_args()
    folder = options.reports / "screenshots" / options.campaign
    with browser() as page:
        screenshots(page, options.reports / f"{options.campaign}.html", folder)
    sys.stdout.write(f"{len(list(folder.glob('*.png')))} pictures in {folder}\n")


if __name__ == "__main__":
    main()
