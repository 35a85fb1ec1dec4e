"""The page in a browser: no overflow and no error, every figure there, wide and narrow."""

import json
import re
import shutil
import subprocess
from html import unescape
from pathlib import Path

import pytest

from tests.report import synthetic

CHROMIUM = shutil.which("chromium")
MEASURED = (Path(__file__).parent / "measured.js").read_text(encoding="utf-8")
# Windows are at least 500 wide, so the page stands in a frame of the wanted width.
FRAME = """<iframe src="report.html" width="{width}" height="900" style="border: 0"></iframe>
<script>document.querySelector("iframe").onload = (event) => {{
  document.title = event.target.contentDocument.title;
}};</script>"""
OPTIONS = "--headless --no-sandbox --disable-gpu --allow-file-access-from-files"
OPTIONS += " --enable-logging=stderr --window-size=1500,1000 --dump-dom"


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed (Debian package chromium)")
@pytest.mark.parametrize("width", [1400, 400])
def test_the_page_fits_and_every_figure_is_there(tmp_path, width):
    page = synthetic.documents()["html"].replace("</body>", f"<script>{MEASURED}</script></body>")
    (tmp_path / "report.html").write_text(page, encoding="utf-8")
    frame = tmp_path / "frame.html"
    frame.write_text(FRAME.format(width=width), encoding="utf-8")
    done = subprocess.run(
        [CHROMIUM, *OPTIONS.split(), frame.as_uri()],
        capture_output=True,
        check=True,
        timeout=120,
    )
    assert b"CONSOLE" not in done.stderr
    found = json.loads(unescape(re.search(r"<title>(.*?)</title>", done.stdout.decode()).group(1)))
    assert found["overflow"] <= 0
    assert found["origin"].startswith("diagnosis/accelerometer/bias_x")
    assert "Estimated by stage" in found["origin"]
    assert found["originFits"]
    assert found["wide"] == []
    assert found["figures"] == found["shown"] > 10
    assert (found["columns"] > 0) == (width == 400)
