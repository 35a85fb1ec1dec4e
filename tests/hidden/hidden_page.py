"""The page of the challenge, docs/challenge.md, with its picture."""

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import chain
import jinja2
import numpy as np
from hidden_bars import SHORT, bars, short_by
from hidden_campaigns import Outcome
from hidden_draws import EACH_FROM
from hidden_named_sizes import rows_of_page
from hidden_pictures import RATIOS, picture
from hidden_scores import (
    Tally,
    class_right,
    detected,
    false_names,
    of,
    tally,
    truly_named,
    unknown_or_true,
    warned,
)
from hidden_sizes import LEVEL
from hidden_statistics import TRIALS, every_job

PAGE = chain.ROOT / "docs/challenge.md"
TEMPLATE = Path(__file__).parent / "challenge.md.jinja"
WANTED = 1200  # campaigns
SEEN = 8.0  # the ratio from which on an effect of a physical size should be found

Row = Sequence[str]
Statistics = Sequence[dict[str, Any]]


def write(outcomes: Sequence[Outcome], statistics: Statistics, page: Path = PAGE) -> str:
    """Write page and picture; the bars as text for the terminal."""
    told = list(bars(outcomes, statistics))
    seconds = sum(one.get("seconds", 0.0) + one.get("simulating", 0.0) for one in outcomes)
    seconds += sum(row.get("seconds", 0.0) for row in statistics)
    figures = {
        "campaigns": sum(one["number"] < EACH_FROM for one in outcomes),
        "each": sum(one["number"] >= EACH_FROM for one in outcomes),
        "wanted": WANTED,
        "statistical": sum(row["trials"] for row in statistics),
        "tried": len(statistics),
        "every": len(every_job()),
        "bars": [(bar.words, bar.wanted, bar.measured, bar.verdict) for bar in told],
        "picture": f"{page.stem}.png",
        "clean": list(_clean(outcomes)),
        "decoys": list(_decoys(outcomes)),
        "outside": list(_outside(outcomes)),
        "several": list(_several(outcomes)),
        "singles": list(_singles(outcomes)),
        "elsewhere": list(_elsewhere(outcomes)),
        "power": list(_power(statistics)),
        "sizes": list(rows_of_page(statistics)),
        "level": f"{100 * LEVEL:.2f}",
        "clean_draws": list(_false(statistics)),
        "time": list(_time(outcomes)),
        "hours": f"{seconds / 3600:.1f}",
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page.write_text(jinja2.Template(text, keep_trailing_newline=True).render(figures), "utf-8")
    picture(outcomes, statistics, page.with_suffix(".png"))
    lines = [f"{bar.verdict.strip('*'):9} {bar.words}: {bar.measured}\n" for bar in told]
    return "".join([*lines, f"The page: {page}\n"])


def _counts(counted: Tally) -> str:
    count, number = counted
    return f"{count} of {number}" if number else "–"


def _false_of(outcomes: Sequence[Outcome]) -> str:
    """The false names, each with how often."""
    every = [name for one in outcomes for name in false_names(one)]
    return ", ".join(f"{name} ({every.count(name)})" for name in sorted(set(every)))


def _groups(
    outcomes: Sequence[Outcome], key: Callable[[Outcome], tuple[str, ...]]
) -> Iterator[tuple[tuple[str, ...], list[Outcome]]]:
    for label in sorted({key(one) for one in outcomes}):
        yield label, [one for one in outcomes if key(one) == label]


def _clean(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for (sort,), own in _groups(of(outcomes, "clean"), lambda one: (one["sort"],)):
        false = _counts(tally(own, lambda one: bool(false_names(one))))
        yield sort, false, _counts(tally(own, warned)), _false_of(own)


def _decoys(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    decoys = of(outcomes, "decoy")
    for (sort, name, plan), own in _groups(
        decoys, lambda one: (one["sort"], one["hidden"][0], one["plan"])
    ):
        false = tally(own, lambda one: bool(false_names(one)))
        right = tally(own, class_right) if sort == "mates" else (false[1] - false[0], false[1])
        yield name, plan, _counts(false), _counts(right), _false_of(own)


def _outside(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for (sort,), own in _groups(of(outcomes, "outside"), lambda one: (one["sort"],)):
        right = _counts(tally(own, unknown_or_true))
        yield sort, _counts(tally(own, warned)), right, _false_of(own)


def _several(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    for (sort,), own in _groups(of(outcomes, "several"), lambda one: (one["sort"],)):
        every = tally(own, lambda one: all(detected(one, e) for e in one["hidden"]))
        yield sort, _counts(tally(own, class_right)), _counts(every), _false_of(own)


def _singles(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    single = [one for one in of(outcomes, "single") if one["sort"] != "elsewhere"]
    for (name,), own in _groups(single, lambda one: (one["hidden"][0],)):
        at = [tally(of(own, "single", "ratio", ratio), class_right) for ratio in RATIOS]
        large = [one for one in of(own, "single", "physical") if one["ratios"][name] >= SEEN]
        yield name, *map(_counts, at), _counts(tally(large, class_right))


def _elsewhere(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    own = of(outcomes, "single", "elsewhere")
    for (name,), some in _groups(own, lambda one: (" or ".join(one["hidden"]),)):
        found = tally(some, lambda one: any(detected(one, e) for e in one["hidden"]))
        yield name, _counts(found), _counts(tally(some, truly_named)), _false_of(some)


def _power(statistics: Statistics) -> Iterator[Row]:
    rows = {(row["effect"], row["plan"], row["ratio"]): row for row in statistics if row["ratio"]}
    for name, plan in sorted({key[:2] for key in rows}):
        own = [rows.get((name, plan, ratio)) for ratio in TRIALS if ratio]
        degrees = next(str(row["degrees"]) for row in own if row)
        yield name, plan, degrees, *(_beside_limit(row) for row in own)


def _beside_limit(row: dict[str, Any] | None) -> str:
    if row is None:
        return "–"
    power, share = row["power"] / row["trials"], row["in_class"] / row["trials"]
    figures = f"{power:.2f} / {row['limit']:.2f} ({row['textbook']:.2f}); {share:.2f}"
    return f"**{figures}**" if short_by(row) > SHORT else figures


def _false(statistics: Statistics) -> Iterator[Row]:
    clean = [row for row in statistics if not row["ratio"]]
    for plan in dict.fromkeys(row["plan"] for row in clean):
        own = [row for row in clean if row["plan"] == plan]
        false, trials = sum(row["power"] for row in own), sum(row["trials"] for row in own)
        yield plan, f"{false} of {trials}", f"{100 * false / trials:.2f} %"


def _time(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    def place(one: Outcome) -> str:
        return "on disk" if one["on_disk"] else "in memory"

    whole = [one for one in outcomes if "seconds" in one]
    for (plan, where), own in _groups(whole, lambda one: (one["plan"], place(one))):
        medians = [float(np.median([one[key] for one in own])) for key in ("simulating", "seconds")]
        samples = str(own[0]["samples"])
        yield plan, samples, where, str(len(own)), *(f"{median:.1f}" for median in medians)
