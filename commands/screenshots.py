"""`python -m commands.screenshots`: a report as a person sees it, in pictures to look at.

Wide and narrow, light and dark, and as printed; a page is longer than a picture, so each is
several, one below the other. Palette PNG, for a report has few colours.

The browser is Debian's headless Chromium, by its own protocol over two pipes: Chrome DevTools
Protocol 1.3 (`--remote-debugging-pipe`).
"""

import argparse
import base64
import io
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from PIL import Image

# ---- the browser

CHROMIUM = shutil.which("chromium")
OPTIONS = (
    *("--headless", "--no-sandbox", "--disable-gpu", "--allow-file-access-from-files"),
    *("--remote-debugging-pipe", "--hide-scrollbars"),
)
KEYS = {"Tab": 9, "Enter": 13, "Escape": 27}  # with their codes
ERRORS = ("Runtime.exceptionThrown", "Log.entryAdded")


class Page:
    """A page of the browser; `errors`: what its console reports."""

    def __init__(self, sent: BinaryIO, received: BinaryIO) -> None:
        self._sent, self._received = sent, received
        self._number = 0
        self._session: dict[str, str] = {}
        self.errors: list[Mapping[str, Any]] = []
        target = self._call("Target.createTarget", url="about:blank")["targetId"]
        attached = self._call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = {"sessionId": attached["sessionId"]}
        for domain in ("Page", "Runtime", "Log"):
            self._call(f"{domain}.enable")

    def _call(self, method: str, **params: Any) -> Mapping[str, Any]:
        """The result of a method."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": params, **self._session}
        self._sent.write(json.dumps(message).encode() + b"\0")
        self._sent.flush()
        while (answer := self._next()).get("id") != self._number:
            pass
        if "error" in answer:
            raise RuntimeError(f"Chromium refuses {method}: {answer['error']['message']}")
        result: Mapping[str, Any] = answer["result"]
        return result

    def _next(self) -> Mapping[str, Any]:
        """The next message of the browser."""
        text = bytearray()
        while (byte := self._received.read(1)) != b"\0":
            if not byte:
                raise RuntimeError("Chromium has ended")
            text += byte
        message: Mapping[str, Any] = json.loads(text)
        if message.get("method") in ERRORS:
            self.errors.append(message["params"])
        return message

    def open(self, file: Path) -> None:
        """Load a file, and wait until it is there."""
        self._call("Page.navigate", url=file.resolve().as_uri())
        while self._next().get("method") != "Page.loadEventFired":
            pass

    def shape(self, width: int, height: int, media: str = "screen", scheme: str = "light") -> None:
        """The size of the window in pixels, and what the style is for."""
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        self._call("Emulation.setDeviceMetricsOverride", **size)
        features = [{"name": "prefers-color-scheme", "value": scheme}]
        self._call("Emulation.setEmulatedMedia", media=media, features=features)

    def press(self, key: str) -> None:
        """Press a key and let it go."""
        code = {"key": key, "code": key, "windowsVirtualKeyCode": KEYS[key]}
        text = {"text": "\r"} if key == "Enter" else {}
        self._call("Input.dispatchKeyEvent", type="keyDown", **code, **text)
        self._call("Input.dispatchKeyEvent", type="keyUp", **code)

    def evaluate(self, script: str) -> Any:
        """The value of an expression, or of its promise."""
        result = self._call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in result:
            raise RuntimeError(f"the page's script: {result['exceptionDetails']}")
        return result["result"].get("value")

    def picture(self, width: int, top: int, height: int) -> bytes:
        """A stretch of the page as PNG."""
        clip = {"x": 0, "y": top, "width": width, "height": height, "scale": 1}
        taken = self._call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
        return base64.b64decode(taken["data"])


@contextmanager
def browser() -> Iterator[Page]:
    """A page in a browser of its own, which ends with it."""
    if CHROMIUM is None:
        raise FileNotFoundError("chromium is not installed; on Debian: apt-get install chromium")
    (theirs_in, ours_out), (ours_in, theirs_out) = os.pipe(), os.pipe()
    # The browser reads from descriptor 3 and writes to 4.
    command = f'exec "$0" "$@" 3<&{theirs_in} 4>&{theirs_out}'
    started = subprocess.Popen(
        ["bash", "-c", command, CHROMIUM, *OPTIONS],
        pass_fds=(theirs_in, theirs_out),
        stderr=subprocess.DEVNULL,
    )
    os.close(theirs_in)
    os.close(theirs_out)
    with os.fdopen(ours_out, "wb") as sent, os.fdopen(ours_in, "rb") as received:
        try:
            yield Page(sent, received)
        finally:
            started.terminate()
            started.wait()


# ---- the pictures

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
