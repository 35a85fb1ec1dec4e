"""The SVG that goes into the page: light, and not a mark without its colour."""

from __future__ import annotations

import re
from xml.etree import ElementTree

from stages.report.drawing import Margins, hatch_masked, side_by_side, style, svg


def drawn() -> str:
    with style():
        figure, (left, right) = side_by_side((1.0, 2.0), 1.0, Margins())
        for panel in (left, right):
            panel.plot([0, 1, 2], [1, 3, 2], marker=".", color="#d55e00")
            panel.fill_between([0, 1, 2], [0, 1, 0], [2, 4, 3], color="#0072b2", alpha=0.2)
        right.plot([0.5], [1], marker="v", color="#8e2a5b")
        hatch_masked(right, 0.5, 1.0)
        return svg(figure, "test")


def test_every_mark_keeps_its_style() -> None:
    text = drawn()
    defined = dict(re.findall(r'<path id="([^"]+)"[^>]*? style="([^"]*)"', text))
    uses = re.findall(r'<use xlink:href="#([^"]+)"([^>]*)/>', text)
    assert len(uses) == 9  # six points, a wedge, two areas
    for mark, more in uses:
        assert "fill: " in more or "fill: " in defined[mark]
    assert "opacity: 0.2" in text


def test_grid_and_marks_of_an_axis_are_one_line_each_with_all_their_parts() -> None:
    text = drawn()
    names = re.findall(r'text-anchor: middle[^>]* x="([^"]+)" y="([^"]+)"', text)
    assert len(names) >= 6
    for colour in ("#d5dbe2", "#5f6c7b"):  # grid; marks
        lines = re.findall(rf'<path d="([^"]*)"[^>]*stroke: {colour}', text)
        assert len(lines) <= 6
        begins = {x for line in lines for x in re.findall(r"M ([\d.]+)", line)}
        assert {x for x, _ in names} <= begins


def test_curves_hold_no_needless_space() -> None:
    assert not [path for path in re.findall(r' d="([^"]*)"', drawn()) if "\n" in path]


def test_a_line_without_points_leaves_the_picture_whole() -> None:
    with style():
        figure, (panel, _) = side_by_side((1.0, 1.0), 1.0, Margins())
        panel.plot([], [], marker="o")
        panel.plot([0, 1], [0, 1], marker="o")
        pictures = svg(figure, "test")
    element = ElementTree.XML(pictures[: pictures.index("</svg>") + len("</svg>")])
    assert element.tag.endswith("svg")  # a strict reader, as that of the PDF is, takes it


def test_panels_share_the_width_as_asked() -> None:
    _, (left, right) = side_by_side((1.0, 2.0), 1.0, Margins())
    ratio = right.get_position().width / left.get_position().width
    assert abs(ratio - 2) < 1e-9
