"""The pages of several campaigns in a browser: they fit, and filter and sort without a server."""

import json
import re
import subprocess
from html import unescape
from pathlib import Path

import pytest
import test_history as archive

from overviews.history.page import history_page
from overviews.index.page import index_page
from overviews.tables_of import RESULT
from overviews.units import imus_of
from stages.report.tables import Tables
from tests.report.synthetic import campaign as synthetic
from tests.report.test_browser import CHROMIUM, FRAME, OPTIONS

pytestmark = pytest.mark.skipif(
    CHROMIUM is None, reason="chromium is not installed (Debian package chromium)"
)
DATES = {"spring": "2026-03-02", "winter": "2025-12-02", "autumn": "2026-10-02", "some": "unknown"}
LAID_OUT = """
document.querySelectorAll("details").forEach((one) => { one.open = true; });
const box = (one) => one.getBoundingClientRect();
const scrolls = "svg, .wide, .matrix, nav"; // may be wider than the page
document.title = JSON.stringify({
  overflow: document.documentElement.scrollWidth - innerWidth,
  wide: [...document.querySelectorAll("main *")]
    .filter((one) => !one.closest(scrolls) && box(one).right > innerWidth + 1)
    .map((one) => one.outerHTML.slice(0, 90)),
  scrolled: [...document.querySelectorAll(".wide")]
    .filter((one) => one.scrollWidth > one.clientWidth + 1).length,
  figures: document.querySelectorAll(".drawing svg").length,
});
"""
USED = """
const seen = () => [...document.querySelectorAll("#campaigns tbody tr")]
  .filter((row) => !row.hidden).map((row) => row.cells[0].textContent);
const head = (place) => document.querySelectorAll("#campaigns thead tr:last-child th")[place];
const status = () => document.querySelector("#campaigns .status").textContent;
const search = document.querySelector("#campaigns input");
const type = (text) => { search.value = text; search.dispatchEvent(new Event("input")); };
const found = { first: seen() };
head(2).querySelector("button").click();
Object.assign(found, { up: seen(), sorted: head(2).getAttribute("aria-sort") });
head(2).querySelector("button").click();
found.down = seen();
type("AUTUMN usable");
Object.assign(found, { filtered: seen(), status: status() });
search.dispatchEvent(new KeyboardEvent("keydown", { key: "Escape" }));
found.again = seen();
const select = document.querySelector("#campaigns select");
select.value = "0 true";
select.dispatchEvent(new Event("change"));
Object.assign(found, {
  byName: seen(),
  labelled: [...document.querySelectorAll("input, select")].every((one) => one.labels.length),
  over: document.querySelector("#imus .over")?.textContent,
  age: document.querySelector("#imus .age")?.textContent,
});
document.title = JSON.stringify(found);
"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The index of four campaigns and the history of an IMU that was due in 2024."""
    place = tmp_path_factory.mktemp("pages")
    for number, bias in enumerate((1.0, 1.1, 0.9)):
        date = f"202{number}-03-02"
        archive.run(place, bias * 1e-5, campaign=f"c{number}", date=date)
    (imu,) = imus_of(
        place / "history", "A-017", place / "derived", level=0.01, tolerance={"gyro_bias": 1e-7}
    )
    made = synthetic()
    campaigns = {}
    for name, date in DATES.items():
        own = made | {"campaign": made["campaign"].assign(date=date)}
        campaigns[name] = Tables({table: own[table] for table in RESULT}, {})
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("overviews.tables_of.hash_of_file", lambda _file: "c0de" * 16)
        folders = (place / "derived", place)
        return {
            "index": index_page(campaigns, [], {"A-017": [imu]}, folders, "c0de"),
            "history": history_page([imu], place / "history", place, "c0de"),
        }


def shown(folder: Path, html: str, script: str, width: int) -> dict[str, object]:
    """What a script finds in a page of this width, as its title."""
    page = html.replace("</body>", f"<script>{{{script}}}</script></body>")
    (folder / "report.html").write_text(page, encoding="utf-8")
    frame = folder / "frame.html"
    frame.write_text(FRAME.format(width=width), encoding="utf-8")
    command = [str(CHROMIUM), *OPTIONS.split(), frame.as_uri()]
    done = subprocess.run(command, capture_output=True, check=True, timeout=120)
    assert b"CONSOLE" not in done.stderr
    found = re.search(r"<title>(.*?)</title>", done.stdout.decode())
    assert found is not None
    content: dict[str, object] = json.loads(unescape(found.group(1)))
    return content


@pytest.mark.parametrize("width", [1400, 400])
@pytest.mark.parametrize("name", ["index", "history"])
def test_the_page_fits(tmp_path, pages, name, width):
    found = shown(tmp_path, pages[name], LAID_OUT, width)
    assert found["overflow"] <= 0
    assert found["wide"] == [] and found["scrolled"] == 0
    assert (found["figures"] > 0) == (name == "history")


def test_the_index_filters_and_sorts_without_a_server(tmp_path, pages):
    found = shown(tmp_path, pages["index"], USED, 1400)
    oldest_first = ["winter", "spring", "autumn", "some"]  # what is not known is last either way
    assert found["up"] == oldest_first and found["sorted"] == "ascending"
    assert found["down"] == ["autumn", "spring", "winter", "some"]
    assert found["filtered"] == ["autumn"] and found["status"] == "1 of 4 shown"
    assert found["again"] == found["down"]
    assert found["byName"] == ["winter", "spring", "some", "autumn"]
    assert found["labelled"] is True
    assert re.fullmatch(r"overdue by [\d.]+ (days|months|years)", found["over"])
    assert re.fullmatch(r"[\d.]+ (months|years) ago", found["age"])
