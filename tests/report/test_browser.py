"""The page in a browser: it fits, every figure is there, and it serves keyboard and reader."""

import importlib.util
import json
import os
import re
import subprocess
import sys
from html import unescape
from itertools import product
from pathlib import Path

import pytest

from commands.screenshots import CHROMIUM, VIEWS, Page, browser, screenshots
from tests.report import synthetic

MEASURED = (Path(__file__).parent / "measured.js").read_text(encoding="utf-8")
# Windows are at least 500 wide, so the page stands in a frame of the wanted width.
FRAME = """<iframe src="report.html" width="{width}" height="900" style="border: 0"></iframe>
<script>document.querySelector("iframe").onload = (event) => {{
  document.title = event.target.contentDocument.title;
}};</script>"""
OPTIONS = "--headless --no-sandbox --disable-gpu --allow-file-access-from-files"
OPTIONS += " --enable-logging=stderr --window-size=1500,1000 --dump-dom"


AXE = importlib.util.find_spec("axe_core_python")
SERIOUS = ("serious", "critical")
ALWAYS = [(1400, "light", "en")]  # the others with the slow tests
FOCUSED = """(() => {
  const one = document.activeElement, style = getComputedStyle(one);
  return { ring: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) > 0,
    traced: one.classList.contains("traced"), summary: one.tagName === "SUMMARY",
    inner: (one.getAttribute("href") ?? "").startsWith("#") };
})()"""

# A process speaks one language.
CHINESE = """from inertial.text.messages import speak
speak("zh")
from tests.report import synthetic
made = synthetic.campaign(logs=("x-up.asc", "z-backward.asc"))
print(synthetic.report_on(made | {"language": "zh"})["html"])"""

pytestmark = pytest.mark.skipif(
    CHROMIUM is None, reason="chromium is not installed (Debian package chromium)"
)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("browser") / "report.html"
    file.write_text(synthetic.documents()["html"], encoding="utf-8")
    return file


@pytest.fixture(scope="module")
def chinese(tmp_path_factory: pytest.TempPathFactory) -> Path:
    file = tmp_path_factory.mktemp("browser") / "chinese.html"
    told = {**os.environ, "PYTHONUTF8": "1"}
    with file.open("wb") as written:
        subprocess.run([sys.executable, "-c", CHINESE], check=True, stdout=written, env=told)
    return file


@pytest.fixture
def page(report: Path):
    with browser() as opened:
        opened.shape(1400, 1000)
        opened.open(report)
        yield opened


@pytest.mark.skipif(AXE is None, reason="axe-core-python is not installed")
@pytest.mark.parametrize(
    ("width", "scheme", "language"),
    [
        pytest.param(*shown, marks=() if shown in ALWAYS else pytest.mark.slow)
        for shown in product((1400, 400), ("light", "dark"), ("en", "zh"))
    ],
)
def test_axe_has_no_serious_finding(
    page: Page, request: pytest.FixtureRequest, language: str, width: int, scheme: str
) -> None:
    """All unfolded. In the dark scheme no ground is white, which axe takes where it finds none."""
    if language == "zh":
        page.open(request.getfixturevalue("chinese"))
    assert page.evaluate("document.documentElement.lang").startswith(language)
    page.evaluate("document.querySelectorAll('details').forEach((one) => { one.open = true; })")
    (folder,) = AXE.submodule_search_locations
    page.evaluate((Path(folder) / "axe.min.js").read_text(encoding="utf-8") + "; 0")
    unlabelled = "document.querySelector('main').insertAdjacentHTML('afterbegin', '<img>')"
    found = "axe.run(document, {resultTypes: ['violations']}).then((all) => all.violations"
    found += ".flatMap((one) => one.nodes.map((node) => [one.id, one.impact, node.html,"
    found += " node.any[0]?.data?.bgColor])))"
    page.shape(width, 1000, "screen", scheme)
    serious = [row for row in page.evaluate(found) if row[1] in SERIOUS]
    assert [row for row in serious if not (scheme == "dark" and row[3] == "#ffffff")] == []
    page.evaluate(unlabelled)
    assert "image-alt" in [row[0] for row in page.evaluate(found)]  # it does look


def test_the_keyboard_alone_reaches_links_folds_and_traces(page: Page) -> None:
    """Tab reaches all that can be used, each ringed; Enter uses it, Escape ends it."""

    def reached(what: str) -> bool:
        """Whether Tab comes to it, all on the way ringed; `what`: a condition of the focus."""
        for _ in range(600):
            page.press("Tab")
            focus = page.evaluate(FOCUSED)
            assert focus["ring"]
            if focus[what]:
                return True
        return False

    assert reached("traced")
    is_open = "new Promise((done) => setTimeout(() => done("
    is_open += "document.getElementById('origin').matches(':popover-open')), 300))"
    assert not page.evaluate(is_open)
    page.press("Enter")
    assert page.evaluate(is_open)
    page.press("Escape")
    assert not page.evaluate(is_open)
    assert reached("inner") and reached("summary")
    was = page.evaluate("document.activeElement.parentElement.open")
    page.press("Enter")
    assert page.evaluate("document.activeElement.parentElement.open") is not was
    assert page.errors == []


@pytest.mark.slow
def test_screenshots_show_the_whole_page_in_every_view(page: Page, report: Path) -> None:
    screenshots(page, report, report.parent / "pictures")
    names = [file.stem for file in (report.parent / "pictures").glob("*.png")]
    assert {re.sub(r"^report-|-\d+$", "", name) for name in names} == set(VIEWS)
    assert page.errors == []


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
