"""A figure of matplotlib's as an element of the page, of no more parts than it needs.

Every part costs time where the page is shown, and three times where it becomes a PDF.
"""

import re

from inertial.text.messages import language

# The last ones of the machine: a page does not bring Chinese letters along.
FAMILIES = (
    "Report, 'Report Chinese', 'Noto Sans CJK SC', 'Source Han Sans SC', 'PingFang SC', "
    "'Microsoft YaHei', 'WenQuanYi Micro Hei', sans-serif"
    if language() == "zh"
    else "Report"
)
NUMBER = r"-?\d+(?:\.\d+)?"
# A straight line; a mark that is one; and where the mark stands.
LINE = rf"M {NUMBER} {NUMBER}L {NUMBER} {NUMBER}"
DRAWN = re.compile(
    rf'<path d="({LINE})"((?: clip-path="[^"]*")?) style="(fill: none; stroke: [^"]*)"/>'
)
MARK = re.compile(rf'<path id="([^"]+)" d="({LINE})" style="([^"]*)"/>')
USED = re.compile(rf'<use xlink:href="#([^"]+)" x="({NUMBER})" y="({NUMBER})"/>')
BETWEEN = ("<text", "<use", "<defs", "</defs", "<path id=")  # lines that are joined
INVISIBLE = re.compile(r'<path d="[^"]*" style="fill: none"/>\n')


def light(drawn: str, key: str) -> str:
    """The svg element alone, without comments, with short numbers and identifiers of its own.

    `drawn`: a file of matplotlib's; `key`: a plain word that the identifiers begin with.
    """
    element = drawn[drawn.index("<svg") :]
    for left_out in (r"<!--.*?-->", r"<metadata>.*?</metadata>", r"<style.*?</style>"):
        element = re.sub(left_out, "", element, flags=re.DOTALL)
    element = element.replace("'DejaVu Sans'", FAMILIES).replace("rotate(-0 ", "rotate(0 ")
    element = re.sub(r' transform="rotate\(0 [^"]*"', "", element)
    used = set(re.findall(r'(?:href="#|url\(#)([^")]+)', element))
    element = re.sub(
        r' id="([^"]+)"', lambda m: f' id="{key}-{m[1]}"' if m[1] in used else "", element
    )
    element = re.sub(r'(href="#|url\(#)', rf"\1{key}-", element)
    element = _without_idle_groups(element).replace("<defs>\n</defs>", "")
    element = _rounded(_styled_once(element))
    return _joined(re.sub(r"\n\s*", "\n", element).strip())


def _without_idle_groups(element: str) -> str:
    """Groups that say nothing about what is in them left out; they are most of the elements."""
    open_groups: list[bool] = []

    def tag(match: re.Match[str]) -> str:
        if match[0].endswith("/>"):  # empty: of a line without points
            return ""
        if match[0].startswith("</"):
            return match[0] if open_groups.pop() else ""
        open_groups.append(match[0] != "<g>")
        return match[0] if open_groups[-1] else ""

    return re.sub(r"<g( [^>]*)?>|</g>", tag, element)


def _styled_once(element: str) -> str:
    """The style of a mark where it is defined, not wherever it is used, if it is but one."""
    styles: dict[str, set[str]] = {}
    for mark, style in re.findall(r'<use xlink:href="#([^"]+)"[^>]* style="([^"]*)"/>', element):
        styles.setdefault(mark, set()).add(style)
    moved: set[str] = set()

    def definition(match: re.Match[str]) -> str:
        own = styles.get(match[2], set())
        if len(own) != 1:
            return match[0]
        moved.add(match[2])
        # What the definition says itself counts for more, as it did.
        return f'{match[1]}{own.pop()}; {match[3]}"'

    def use(match: re.Match[str]) -> str:
        return f"{match[1]}/>" if match[2] in moved else match[0]

    element = re.sub(r'(<path id="([^"]+)"[^>]* style=")([^"]*)"', definition, element)
    return re.sub(r'(<use xlink:href="#([^"]+)"[^>]*?) style="[^"]*"/>', use, element)


def _rounded(element: str) -> str:
    """Coordinates to a hundredth of a point, finer than any printer, with no needless space."""

    def path(match: re.Match[str]) -> str:
        short = re.sub(r"-?\d+\.\d{3,}", lambda n: f"{float(n[0]):.2f}", match[2])
        return match[1] + re.sub(r"\s*\n\s*", "", short) + '"'

    return re.sub(r'( (?:d|x|y)=")([^"]*)"', path, element)


def _joined(element: str) -> str:
    """Straight lines of one look as one path: grids, and the marks of axes.

    Names and marks may stand between them, nothing else, so that nothing is drawn over another.
    """
    element = INVISIBLE.sub("", element)
    marks = {name: (course, style) for name, course, style in MARK.findall(element)}
    parts: list[str] = []
    begun: dict[tuple[str, str], tuple[int, list[str]]] = {}

    def end() -> None:
        for (clip, style), (place, courses) in begun.items():
            parts[place] = f'<path d="{"".join(courses)}"{clip} style="{style}"/>'
        begun.clear()

    for part in element.split("\n"):
        if line := _line(part, marks):
            course, *look = line
            if (key := (look[0], look[1])) not in begun:
                begun[key] = (len(parts), [])
                parts.append("")
            begun[key][1].append(course)
            continue
        if not part.startswith(BETWEEN):
            end()
        parts.append(part)
    end()
    return _without_idle_marks("\n".join(parts))


def _line(part: str, marks: dict[str, tuple[str, str]]) -> tuple[str, str, str] | None:
    """Course, clip and style of a straight line, or of a mark that is one, where it stands."""
    if (drawn := DRAWN.fullmatch(part)) and "dasharray" not in part and "opacity" not in part:
        return drawn[1], drawn[2], drawn[3]
    if (used := USED.fullmatch(part)) and used[1] in marks:
        course, style = marks[used[1]]
        numbers = [float(number) for number in re.findall(NUMBER, course)]
        x, y = float(used[2]), float(used[3])
        from_x, from_y, to_x, to_y = (
            f"{number + shift:.2f}".removesuffix(".00")
            for number, shift in zip(numbers, (x, y, x, y), strict=True)
        )
        return f"M {from_x} {from_y}L {to_x} {to_y}", "", style
    return None


def _without_idle_marks(element: str) -> str:
    """Definitions of marks that nothing uses any more left out."""
    used = set(re.findall(r'href="#([^"]+)"', element))
    kept = [
        part
        for part in element.split("\n")
        if not (mark := MARK.fullmatch(part)) or mark[1] in used
    ]
    return "\n".join(kept).replace("<defs>\n</defs>\n", "")
