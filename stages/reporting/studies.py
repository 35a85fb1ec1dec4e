"""S0's studies: what a longer rest, another window or a larger angle changes, and the table."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from inertial.text import numbers
from stages.reporting import epochs as of_epochs
from stages.reporting import time_angle as of_time_angle
from stages.reporting import windows as of_windows
from stages.reporting.outline import Heading, Paragraph, Part, Section, Sentences
from stages.reporting.rows import Record, records


def section(
    epochs: pd.DataFrame,
    spreads: pd.DataFrame,
    windows: pd.DataFrame,
    growing: pd.DataFrame,
    middles: pd.DataFrame,
    time_angle: pd.DataFrame,
    motions: pd.DataFrame,
    not_studied: pd.DataFrame,
) -> Section:
    """Rests by epochs, turns by windows, and the table's time and angle."""
    left = records(not_studied)
    parts: list[Part] = [Heading("Rests, epoch by epoch")]
    parts += list(of_epochs.parts(epochs, spreads)) or [_none("rests", left)]
    parts.append(Heading("Turns, window by window"))
    parts += list(of_windows.parts(windows, growing, middles)) or [_none("turns", left)]
    parts.append(Heading("The table's time and angle"))
    parts += list(of_time_angle.parts(time_angle, motions)) or [_none("turns", left)]
    parts.append(of_windows.middle(middles))
    parts += list(of_time_angle.limits())
    reasons = tuple(numbers.shortened(f"{row['subject']}: {row['reason']}", 400) for row in left)
    if reasons:
        parts += [Heading("Not in these studies"), Sentences(reasons)]
    return Section(
        "studies",
        "Studies",
        "The parameters by single epochs and running means of the rests, by a window that slides "
        "through the turns and by one that grows, and the angle of the table against time.",
        "A window of N samples lies between N + 1 edges and lasts N sample intervals: its angle by "
        "time is N · interval · set rate. These studies change no result; they tell what rests, "
        "windows and table are good for.",
        parts,
    )


def _none(study: str, left: Sequence[Record]) -> Paragraph:
    why = "; the reasons are below" if any(row["study"] == study for row in left) else ""
    return Paragraph(f"None: there are no {study} that could be studied{why}.")
