"""The picture of the challenge: power beside its limit, and names given for what was hidden."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib
import numpy as np
from hidden_campaigns import Outcome
from hidden_scores import NOTHING, UNKNOWN, detected, first_name, of
from matplotlib.axes import Axes
from matplotlib.figure import Figure

matplotlib.use("Agg")
RATIOS = (5.0, 6.0, 8.0, 10.0, 15.0)
COLOURS = {"1": "#4477aa", "2": "#66ccee", "3": "#228833", "9": "#aa3377"}


def picture(outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]], file: Path) -> None:
    """Draw both."""
    figure = Figure(figsize=(11.5, 7.5), layout="constrained")
    left, right = figure.subplots(1, 2, width_ratios=(1, 1.7))
    _power(left, outcomes, statistics)
    _confusion(right, of(outcomes, "single", "ratio"))
    figure.savefig(file, dpi=110, metadata={"Software": None})


def _power(axes: Axes, outcomes: Sequence[Outcome], statistics: Sequence[dict[str, Any]]) -> None:
    """Pooled over the effects of equal degrees: limit as a line, measured as points."""
    single = of(outcomes, "single", "ratio")
    for degrees, colour in COLOURS.items():
        rows = [row for row in statistics if row["ratio"] and str(row["degrees"]) == degrees]
        ratios = sorted({row["ratio"] for row in rows})
        own = [[row for row in rows if row["ratio"] == ratio] for ratio in ratios]
        limit = [np.mean([row["limit"] for row in some]) for some in own]
        power = [np.mean([row["power"] / row["trials"] for row in some]) for some in own]
        axes.plot(ratios, limit, color=colour, label=f"limit, degrees of freedom: {degrees}")
        axes.plot(ratios, power, "o", color=colour, mfc="none")
        for ratio in RATIOS:
            some = [
                one for one in of(single, "single", "ratio", ratio)
                if str(one["limits"]["degrees"]) == degrees
            ]  # fmt: skip
            if some:
                share = float(np.mean([bool(one["named"]) for one in some]))
                error = np.sqrt(max(share * (1 - share), 0.25 / len(some)) / len(some))
                axes.errorbar(ratio + 0.12, share, error, fmt="s", ms=4, lw=0.8, color=colour)
    axes.set(xlabel="SNR", ylabel="share of campaigns in which a cause is named", ylim=(0.0, 1.03))
    axes.set_title("Power: ○ statistics, ■ campaigns, – limit", fontsize=9)
    axes.legend(fontsize=7, loc="lower right")
    axes.grid(alpha=0.3)


def _confusion(axes: Axes, single: Sequence[Outcome]) -> None:
    """Rows: hidden; columns: the most significant name; framed where its class holds the truth."""
    hidden = sorted({one["hidden"][0] for one in single})
    extra = sorted({first_name(one) for one in single} - {*hidden, NOTHING, UNKNOWN})
    named = [*hidden, *extra, UNKNOWN, NOTHING]
    share = np.zeros((len(hidden), len(named)))
    classes = np.zeros_like(share, dtype=bool)
    for one in single:
        row, column = hidden.index(one["hidden"][0]), named.index(first_name(one))
        share[row, column] += 1
        classes[row, column] |= row != column and detected(one, one["hidden"][0])
    share /= np.maximum(share.sum(axis=1, keepdims=True), 1)
    axes.imshow(share, cmap="Blues", vmin=0, vmax=1, aspect="auto")
    for row, column in np.argwhere(classes):
        axes.plot(column, row, "s", ms=7, mfc="none", mec="#228833")
    axes.set_xticks(range(len(named)), [name.replace("_", " ") for name in named])
    axes.set_yticks(range(len(hidden)), [name.replace("_", " ") for name in hidden])
    axes.tick_params(labelsize=6)
    axes.tick_params(axis="x", rotation=90)
    axes.set(xlabel="named", ylabel="hidden")
    axes.set_title("Single effects, SNR 5 to 15; □: named as one of a class with it", fontsize=9)
