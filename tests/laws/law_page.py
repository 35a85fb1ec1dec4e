"""The page of the laws, docs/laws.md."""

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import chain
import jinja2
import numpy as np

PAGE = chain.ROOT / "docs/laws.md"
TEMPLATE = Path(__file__).parent / "laws.md.jinja"
MAX_BEHIND_BAYES, MIN_RIGHT = 0.05, 0.90
MAX_WRONG, MIN_GAIN = 0.02, 0.8
AT = 20.0  # signal-to-noise ratio of the second bar
WANTED = 240  # draws, twenty of each family

Outcome = dict[str, Any]
Row = tuple[str, ...]


def write(outcomes: Sequence[Outcome], page: Path = PAGE) -> str:
    """Write the page; its first sentence for the terminal."""
    laws = [one for one in outcomes if "error" not in one]
    figures = {
        "laws": len(laws),
        "wanted": WANTED,
        "code": outcomes[0]["code"] if outcomes else "",
        "errors": len(outcomes) - len(laws),
        "bars": list(_bars(laws)),
        "families": list(_families(laws)),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    right = sum(one["right"] for one in laws)
    return f"the form is right in {right} of {len(laws)}: {page}\n"


def _bars(laws: Sequence[Outcome]) -> Iterator[Row]:
    """What is asked, what was measured, and whether that is enough."""
    if laws:
        right, bayes = (np.mean([one[key] for one in laws]) for key in ("right", "bayes_right"))
        yield (
            f"class of form right, within {MAX_BEHIND_BAYES} of the Bayes classifier",
            f"{_of(laws, 'right')}, Bayes {_of(laws, 'bayes_right')}",
            _met(right >= bayes - MAX_BEHIND_BAYES),
        )
        at = [one for one in laws if one["ratio"] == AT]
        yield (
            f"the same at a signal-to-noise ratio of {AT:.0f}: at least {MIN_RIGHT}",
            f"{_of(at, 'right')}, Bayes {_of(at, 'bayes_right')}",
            _met(np.mean([one["right"] for one in at]) >= MIN_RIGHT if at else False),
        )
        instead, beside = (sum(bool(one[key]) for one in laws) for key in ("wrong", "wrong_beside"))
        yield (
            f"a confident wrong name of the catalogue: at most {100 * MAX_WRONG:.0f} %",
            f"{instead} instead of a law, {beside} beside one, of {len(laws)}",
            _met(instead + beside <= MAX_WRONG * len(laws)),
        )
        gains = [drop / most for one in laws for drop, most in one["gain"] if most > 0]
        yield (
            f"median gain on held-out manoeuvres, of SNR² there: at least {MIN_GAIN}",
            f"{np.median(gains):.2f} of {len(gains)}" if gains else "none",
            _met(bool(gains) and float(np.median(gains)) >= MIN_GAIN),
        )


def _families(laws: Sequence[Outcome]) -> Iterator[Row]:
    for title in dict.fromkeys(one["family"] for one in laws):
        own = [one for one in laws if one["family"] == title]
        missed = [one for one in own if not one["right"]]
        instead = [", ".join(each["cause"] for each in one["named"]) or "nothing" for one in missed]
        wrong = sum(bool(one["wrong"]) for one in own)
        yield title, _of(own, "right"), _of(own, "bayes_right"), str(wrong), "; ".join(instead)


def _of(outcomes: Sequence[Outcome], key: str) -> str:
    return f"{sum(bool(one[key]) for one in outcomes)} of {len(outcomes)}"


def _met(met: bool) -> str:
    return "met" if met else "**not met**"
