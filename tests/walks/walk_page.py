"""The page of random walks, ramps, jumps and warm-ups, docs/walks.md."""

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import product
from pathlib import Path
from typing import Any

import chain
import jinja2
import numpy as np
from hidden_plans import PLANS
from walk_draws import KINDS, LAWS, LEVEL, RATIOS, WALKS
from walk_guess import SILENCE, WALK

PAGE = chain.ROOT / "docs/walks.md"
TEMPLATE = Path(__file__).parent / "walks.md.jinja"
MAX_BEHIND = 0.05  # of the likelihood-ratio test
WANTED = 200  # draws of each kind, ratio and plan

Outcome = dict[str, Any]
Row = tuple[str, ...]


def write(outcomes: Sequence[Outcome], page: Path = PAGE) -> str:
    """Write the page; its first sentence for the terminal."""
    figures = {
        "draws": len(outcomes),
        "wanted": WANTED * len(KINDS) * len(RATIOS) * len(PLANS),
        "faint": _faint(),
        "margin": MAX_BEHIND,
        "silent": f"{100 * (1 - LEVEL):g}",
        "pairs": list(_pairs(outcomes)),
        "said": list(_pairs([one for one in outcomes if one["walk"] or one["named"]])),
        "instead": list(_instead(outcomes)),
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    right = sum(one["right"] for one in outcomes)
    return f"right in {right} of {len(outcomes)}: {page}\n"


def _faint() -> int:
    """One in how many walks of one axis has a quarter of the mean square, by its half waves.

    Its square is Σ z²/k² over Σ 1/k², all half waves being seen alike.
    """
    shares = np.arange(1.0, 100.0) ** -2 / np.sum(np.arange(1.0, 100.0) ** -2)
    squares = np.random.default_rng(1).standard_normal((20_000, len(shares))) ** 2 @ shares
    return round(1 / float(np.mean(squares < 0.25)))


def _pairs(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    """Of each walk and effect the share right, and that of the test."""
    for ratio, walk, effect in product(RATIOS, WALKS, LAWS):
        own = [
            [one for one in outcomes if (one["ratio"], one["kind"]) == (ratio, kind)]
            for kind in (walk, effect)
        ]
        if all(own):
            right = float(np.mean([np.mean([one["right"] for one in each]) for each in own]))
            limit = float(np.mean([_preferred(*own), _preferred(*own[::-1])]))
            met = "yes" if right >= limit - MAX_BEHIND else "**no**"
            count = str(len(own[0]) + len(own[1]))
            guess = float(np.mean([np.mean([guessed_right(one) for one in each]) for each in own]))
            near = "yes" if right >= guess - MAX_BEHIND else "**no**"
            figures = (f"{value:.2f}" for value in (right, limit))
            names = _in_words(walk), effect
            yield f"{ratio:.0f}", *names, count, *figures, met, f"{guess:.2f}", near


def guessed_right(one: Outcome) -> bool:
    """Whether a walk is guessed to be one, an effect to be something else; silence is wrong."""
    return one["guess"] != SILENCE and (one["guess"] == WALK) == (one["kind"] in WALKS)


def _preferred(own: Sequence[Outcome], others: Sequence[Outcome]) -> float:
    """In which share of some draws the test prefers their kind to that of others."""
    kind, other = own[0]["kind"], others[0]["kind"]
    return float(np.mean([o["likelihoods"][kind] > o["likelihoods"][other] for o in own]))


def _instead(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for ratio, kind in product(RATIOS, KINDS):
        own = [one for one in outcomes if (one["ratio"], one["kind"]) == (ratio, kind)]
        wrong = [one for one in own if not one["right"]]
        silent = str(sum(not one["walk"] and not one["named"] for one in wrong))
        walk = str(sum(one["walk"] and not one["named"] for one in wrong))
        named = Counter(", ".join(one["named"]) for one in wrong if one["named"])
        told = "; ".join(f"{name} ({count})" for name, count in named.most_common())
        true = "gyro_random_walk" if kind in WALKS else kind
        held = str(sum(true in one["members"] for one in wrong))
        share = f"{len(own) - len(wrong)} of {len(own)}"
        yield f"{ratio:.0f}", _in_words(kind), share, silent, walk, told, held


def _in_words(kind: str) -> str:
    return f"random walk, {kind.removeprefix('walk of ')}" if kind in WALKS else kind
