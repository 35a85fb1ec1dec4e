"""The page of the clean campaigns, docs/silence.md."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import chain
import jinja2
import numpy as np
from scipy.stats import beta, binomtest, kstest, norm

PAGE = chain.ROOT / "docs/silence.md"
TEMPLATE = Path(__file__).parent / "silence.md.jinja"
WANTED = 2000  # campaigns, for a bound of 1.5 % where 1 % are named
LEVEL = 0.01  # required rate of false names; the lower `criticism: level` is of any finding
BOUND = 0.95  # probability that the rate is below its one-sided bound
SURE = 0.01  # of all tests of a table together that one is called uneven
# Tests whose p-values are bounds (at most as many are below a value as that value): what searches
# pays for that by a bound, and the lean of a table is sought beside the tilts of its axes, of
# which the simulated table has none.
BOUNDS = ("structure ", "table_tilt", "table_inner_axis")

Outcome = dict[str, Any]
Row = tuple[str, ...]


def write(outcomes: Sequence[Outcome], draws: int, page: Path = PAGE) -> str:
    """Write the page; its first sentence for the terminal."""
    false, laws, unexplained = (
        [one for one in outcomes if one[what]] for what in ("named", "laws", "unexplained")
    )
    chances = list(_even(outcomes, "chances", lambda values: kstest(values, "uniform").pvalue))
    errors = list(_even(outcomes, "errors", lambda values: kstest(values, "norm").pvalue))
    figures = {
        "campaigns": len(outcomes),
        "wanted": WANTED,
        "code": outcomes[0]["code"] if outcomes else "",
        "falsely": len(false),
        "bound": f"{100 * upper(len(false), len(outcomes)):.1f}",
        "laws": len(laws),
        "law_bound": f"{100 * upper(len(laws), len(outcomes)):.1f}",
        "unexplained": len(unexplained),
        "by_sort": list(_rates(outcomes, "sort")),
        "by_plan": list(_rates(outcomes, "plan")),
        "names": sorted({name for one in false for name in one["named"]}),
        "law_names": sorted({name for one in laws for name in one["laws"]}),
        "chances": chances,
        "errors": errors,
        "sure": SURE,
        "level": f"{100 * chain.SETTINGS['criticism']['level']:g}",
        "wanted_rate": f"{100 * LEVEL:g}",
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    return f"{len(false)} of {len(outcomes)} clean campaigns have a false name: {page}\n"


def upper(count: int, of: int) -> float:
    """The one-sided upper bound of a rate, by Clopper and Pearson."""
    return 1.0 if count >= of else float(beta.ppf(BOUND, count + 1, of - count))


def _rates(outcomes: Sequence[Outcome], by: str) -> Iterator[Row]:
    """The false names of each kind, with the bound, and whether it is above the level."""
    for kind in dict.fromkeys(one[by] for one in outcomes):
        own = [one for one in outcomes if one[by] == kind]
        false = sum(bool(one["named"]) for one in own)
        p = binomtest(false, len(own), LEVEL, alternative="greater").pvalue
        yield kind, f"{false} of {len(own)}", f"{100 * upper(false, len(own)):.1f}", f"{p:.2g}"


def _even(
    outcomes: Sequence[Outcome], what: str, test: Callable[[np.ndarray], float]
) -> Iterator[Row]:
    """Each quantity: in how many campaigns, its histogram in tenths, and the test of evenness."""
    names = sorted({name for one in outcomes for name in one[what]})
    for name in names:
        values = np.array([one[what][name] for one in outcomes if name in one[what]])
        ranks = values if what == "chances" else norm.cdf(values)
        tenths = np.histogram(ranks, bins=10, range=(0, 1))[0]
        p = test(values)
        verdict = "uneven" if p < SURE / len(names) else "even"
        if verdict == "uneven" and name.startswith(BOUNDS):
            below = binomtest(int(tenths[0]), len(values), 0.1, alternative="greater").pvalue
            verdict = "too many" if below < SURE / len(names) else "conservative"
        spread = "" if what == "chances" else f"{np.sqrt(np.mean(values**2)):.2f}"
        yield name, str(len(values)), spread, " ".join(map(str, tenths)), f"{p:.2g}", verdict
