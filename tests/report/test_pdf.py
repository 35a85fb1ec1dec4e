"""The report for print: pages, text, PDF/A, the same bytes, and nothing from outside."""

from __future__ import annotations

import re
import shutil
import subprocess
import time
import zlib
from functools import cache
from pathlib import Path
from types import ModuleType

import pytest

from stages.pdf.stage import STAGE, as_pdf, unbroken
from tests.report import synthetic

try:
    import weasyprint
except OSError:
    weasyprint = None
needs_pango = pytest.mark.skipif(weasyprint is None, reason="Pango is not installed")


@cache
def page() -> str:
    """A report on the accelerometer alone, with the raw data of a turn that is not whole."""
    whole = synthetic.brief("z-backward.asc")
    kept = ("accelerometer_parameters", "accelerometer_fit", "traces", "segments", "clocks")
    return synthetic.report_on(synthetic.poor() | {name: whole[name] for name in kept})["html"]


ATTACHED = {"a.calibration.json": b'{"bias": [1]}\n' * 50, "a.dcc.xml": b"<dcc/>\n"}


@cache
def printed() -> bytes:
    """The same for print."""
    return as_pdf(page(), ATTACHED)


def unpacked(document: bytes) -> bytes:
    """The PDF with its compressed streams in the open."""
    streams = re.findall(rb"stream\r?\n(.*?)\r?\nendstream", document, flags=re.DOTALL)
    opened = []
    for stream in streams:
        try:
            opened.append(zlib.decompress(stream))
        except zlib.error:
            opened.append(stream)
    return document + b"\n".join(opened)


def test_no_line_ends_within_a_number_with_its_unit_or_a_name() -> None:
    text = (
        "<main><p>x-forward, x-up-again (rest-before): 0.64 ± 0.16 °/h of 12 ppm/h, a/x-up.asc</p>"
    )
    kept = ["x-forward", "x-up-again", "rest-before", "0.64 ± 0.16 °/h", "12 ppm/h"]
    assert re.findall(r'<span class="sign">(.*?)</span>', unbroken(text)) == kept
    assert unbroken("<p>x-up: 3 ppm</p>") == "<p>x-up: 3 ppm</p>"  # before the text: style, fonts


@needs_pango
def test_it_is_a_pdf_of_several_pages() -> None:
    assert printed().startswith(b"%PDF-")
    assert len(re.findall(rb"/Type /Page\b", unpacked(printed()))) > 3


@needs_pango
def test_it_holds_text(tmp_path: Path) -> None:
    if shutil.which("pdftotext") is None:
        pytest.skip("pdftotext is not installed (Debian package poppler-utils)")
    file = tmp_path / "report.pdf"
    file.write_bytes(printed())
    done = subprocess.run(["pdftotext", "-layout", file, "-"], capture_output=True, check=True)
    text = " ".join(done.stdout.decode().split())
    assert "Not usable" in text
    assert "Six positions, closed formula" in text
    assert "z-backward.asc" in text
    assert "made-up · NovAtel SPAN-CPT · serial SIM-001 · simulated" in text  # on every page
    assert re.search(r"\b2 ?/ ?\d+", text)


@needs_pango
def test_a_figure_says_in_words_what_it_shows() -> None:
    figures = re.findall(r'role="img" aria-label="([^"]*)"', page())
    assert figures
    for words in figures:
        assert f"/Alt ({words})".encode() in unpacked(printed())


@needs_pango
def test_it_declares_pdf_a_3a_with_what_this_asks_for() -> None:
    """ISO 19005-3: part and level in XMP, output intent, language, tags, every font embedded."""
    content = unpacked(printed())
    assert re.search(rb'pdfaid:part="3" pdfaid:conformance="A"', content)
    assert re.search(rb"/S /GTS_PDFA1\b", content)
    assert b"/DestOutputProfile" in content and b"sRGB" in content
    assert b"/Lang (en)" in content and b"/Marked true" in content
    described = len(re.findall(rb"/Type /FontDescriptor\b", content))
    assert described == len(re.findall(rb"/FontFile[23]? \d+ 0 R", content)) > 0
    for word in (b"/JavaScript", b"/Encrypt", b"/LZWDecode", b"/Launch"):
        assert word not in content


@needs_pango
def test_the_files_are_attached_as_they_are(tmp_path: Path) -> None:
    content = unpacked(printed())
    assert content.count(b"/AFRelationship /Data") == 2
    (files,) = re.findall(rb"/AF \[([^\]]*)\]", content)
    assert len(set(re.findall(rb"\d+ 0 R", files))) == 2
    for text in ATTACHED.values():
        assert text in content
    if shutil.which("pdfdetach") is None:
        pytest.skip("pdfdetach is not installed (Debian package poppler-utils)")
    file = tmp_path / "report.pdf"
    file.write_bytes(printed())
    subprocess.run(["pdfdetach", "-saveall", "-o", tmp_path, file], check=True)
    assert {name: (tmp_path / name).read_bytes() for name in ATTACHED} == ATTACHED


@pytest.mark.slow
@needs_pango
def test_the_same_page_gives_the_same_bytes() -> None:
    assert as_pdf(page(), ATTACHED) == printed()


@needs_pango
def test_also_where_fonttools_makes_the_subsets_of_fonts(monkeypatch: pytest.MonkeyPatch) -> None:
    """It marks them with the time; so it does where the system lacks HarfBuzz's."""
    monkeypatch.setattr(weasyprint.pdf.fonts, "harfbuzz_subset", None)
    html = "<p>Some letters of a font: σ, ±</p>"
    today = as_pdf(html)
    monkeypatch.setattr(time, "time", lambda: 2e9)
    assert as_pdf(html) == today


@needs_pango
def test_it_tells_neither_the_time_nor_the_machine() -> None:
    content = unpacked(printed())
    for word in (str(Path.cwd()).encode(), b"file://"):
        assert word not in content
    dates = re.findall(rb"/(?:CreationDate|ModDate) \(([^)]*)\)", content)
    assert dates == [b"D:19700101000000Z"] * 4  # those that the two attachments must have


@needs_pango
def test_nothing_is_fetched_from_network_or_disk(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    secret = tmp_path / "secret.svg"
    secret.write_text('<svg xmlns="http://www.w3.org/2000/svg"><text>secret</text></svg>')
    html = f'<img src="{secret.as_uri()}" alt="a"><img src="http://127.0.0.1:9/b.png" alt="b">'
    assert as_pdf(html).startswith(b"%PDF-")
    assert caplog.text.count("URI uses disallowed protocol") == 2


def test_missing_pango_is_named_with_its_packages(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    def fail(name: str) -> ModuleType:
        raise OSError("cannot load library 'libpango-1.0-0': no such file\nfurther lines")

    monkeypatch.setattr("stages.pdf.stage.importlib.import_module", fail)
    html = tmp_path / "a.html"
    html.write_text("<p>a</p>")
    with pytest.raises(SystemExit) as refused:
        STAGE.command_line([str(tmp_path), "--html", str(html), "--documents", str(tmp_path / "a")])
    message = str(refused.value)
    assert "cannot load library 'libpango-1.0-0'" in message
    assert "apt-get install libpango-1.0-0 libpangoft2-1.0-0 libharfbuzz-subset0" in message
    assert "the report is there as a page" in message
    assert not (tmp_path / "a.pdf").exists()


@needs_pango
def test_the_command_writes_beside_and_moves(tmp_path: Path) -> None:
    html = tmp_path / "a.html"
    html.write_text("<p>a</p>")
    STAGE.command_line([str(tmp_path), "--html", str(html), "--documents", str(tmp_path / "new/a")])
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["a.pdf"]
