"""The page of the mutants, docs/mutants.md."""

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import chain
import jinja2
from ruamel.yaml import YAML

HERE = Path(__file__).parent
PAGE = chain.ROOT / "docs/mutants.md"
TEMPLATE, EXPLAINED = HERE / "mutants.md.jinja", HERE / "explained.yaml"
KINDS = ("sign", "transpose", "index", "factor", "term")

Outcome = Mapping[str, Any]


def write(outcomes: Sequence[Outcome], of: int) -> str:
    """Write the page; what is said in the terminal."""
    why = YAML(typ="safe").load(EXPLAINED) or []
    told = {(one["file"], one["before"], one["after"]): one["why"] for one in why}
    alive = sorted(
        (one for one in outcomes if one["killed"] is None),
        key=lambda one: (one["file"], one["line"]),
    )
    rows = [(*_words(one), told.get(_key(one), "")) for one in alive]
    figures = {
        "tried": len(outcomes),
        "all": of,
        "dead": len(outcomes) - len(alive),
        "explained": sum(bool(row[-1]) for row in rows),
        "alive": rows,
        "kinds": list(_table(outcomes, "kind", KINDS)),
        "packages": list(
            _table([one | {"package": one["file"].split("/")[1]} for one in outcomes], "package")
        ),
        "code": ", ".join(sorted({one["code"][:16] for one in outcomes})),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    PAGE.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    return (
        f"{len(outcomes)} of {of} mutants: {len(alive)} survive, {figures['explained']} explained\n"
        f"The page: {PAGE}\n"
    )


def _key(one: Outcome) -> tuple[str, str, str]:
    return one["file"], one["before"], one["after"]


def _words(one: Outcome) -> tuple[str, str, str, str]:
    """Place, fault, and how many tests execute its line."""
    before, after = (
        " ".join(one[name].split()).replace("|", "\\|") for name in ("before", "after")
    )
    return f"{one['file']}:{one['line']}", before, after, str(one["tests"])


def _table(
    outcomes: Sequence[Outcome], column: str, values: Sequence[str] = ()
) -> Iterator[tuple[str, int, int]]:
    tried = Counter(one[column] for one in outcomes)
    alive = Counter(one[column] for one in outcomes if one["killed"] is None)
    for value in values or sorted(tried):
        yield value, tried[value], alive[value]
