"""Which stretches of the logs are navigated, and their readings before and after calibration."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.masked_samples import Columns, Repairs
from inertial.campaign.records import Manoeuvre, Part, rows_of
from inertial.campaign.sample_stretches import columns_in
from inertial.tables import CHANNELS, STATIC_PHASES
from inertial.tables.parquet import Stream
from inertial.text.messages import _

HORIZONS = (60.0, 600.0)  # s
ALIGNMENT = 60.0  # s at rest before, where there is room for it
MIN_ALIGNMENT = 10.0  # s
MAX_HOLE = 1.0  # s without a reading of a channel, that a line may bridge at rest
MAX_HOLE_TURNING = 0.05  # s, the same in a turn
WHOLE = 1e-6  # rad by which a whole turn may differ from a multiple of 360°
TOO_SHORT = _("it is recorded for less than {seconds:.0f} s", seconds=HORIZONS[0] + MIN_ALIGNMENT)
NO_CLOCK = _("its log has no time")
HOLES = _("readings are missing for too long")


@dataclass(frozen=True)
class Window:
    """Records [first, moving) of a log at rest, for the alignment, and [moving, after) navigated.

    `step`: of a sample, s; `part`: the manoeuvre, and the phase of a rest.
    """

    part: Part
    manoeuvre: Manoeuvre
    mount: str
    log: str
    first: int
    moving: int
    after: int
    step: float
    turn: bool

    @property
    def label(self) -> str:
        """As tables name it."""
        return self.part.label


def windows(data: CampaignData, segments: pd.DataFrame) -> tuple[list[Window], list[Part]]:
    """The rests and whole turns of a mount to navigate, and the rests that are not, with reasons.

    A rest is navigated after an alignment of a minute, or of what is left of it before the last.
    """
    found: list[Window] = []
    refused: list[Part] = []
    plan = {m.name: m for m in data.plan}
    own = [row for row in rows_of(segments) if row["manoeuvre"] in plan]
    for row in own:
        if row["phase"] not in STATIC_PHASES:
            continue
        m, part = plan[row["manoeuvre"]], Part(row["manoeuvre"], row["phase"])
        step = data.clocks[row["log"]].interval
        if step is None:
            refused.append(Part(part.manoeuvre, part.phase, NO_CLOCK))
            continue
        samples = row["to_record"] - row["from_record"]
        alignment = min(samples * step - HORIZONS[0], ALIGNMENT)
        if alignment < MIN_ALIGNMENT:
            refused.append(Part(part.manoeuvre, part.phase, TOO_SHORT))
            continue
        moving = row["from_record"] + int(alignment / step)
        after = min(row["to_record"], moving + ceil(HORIZONS[-1] / step) + 1)
        place = (row["log"], row["from_record"], moving, after, step)
        found.append(Window(part, m, data.mount, *place, turn=False))
    return found + list(_turns(data, own)), refused


def _turns(data: CampaignData, segments: Sequence[Mapping[str, object]]) -> Iterator[Window]:
    phases = {(row["manoeuvre"], row["phase"]): row for row in segments}
    for m in data.plan:
        before, rest = (phases.get((m.name, phase)) for phase in ("rest-before", "rest-after"))
        step = data.clocks[m.log].interval
        if m.do != "turn" or before is None or rest is None or step is None:
            continue
        if m.angle is None or not data.performed[m.name].complete:
            continue
        if abs(m.angle - 2 * np.pi * round(m.angle / (2 * np.pi))) > WHOLE or not m.angle:
            continue
        first, moving, after = (
            int(str(each))
            for each in (before["from_record"], before["to_record"], rest["to_record"])
        )
        if (after - moving) * step <= HORIZONS[-1]:
            place = (str(before["log"]), first, moving, after, step)
            yield Window(Part(m.name), m, data.mount, *place, turn=True)


@dataclass(frozen=True)
class Readings:
    """Six channels on the regular grid of a window, (n, 6) each, its first `aligned` at rest.

    `reason`: why they cannot be navigated, else empty; `time`, s, and `temperature`, K: (n,).
    """

    window: Window
    aligned: int
    recorded: Array
    corrected: Array
    time: Array
    temperature: Array
    reason: str = ""


def readings(
    samples: Stream, compensated: Stream, wanted: Sequence[Window], repairs: Repairs
) -> Iterator[Readings]:
    """The readings of each window as recorded and compensated, one window in memory at a time."""
    if not wanted:
        return
    stretches = {k: RecordRange(own.log, own.first, own.after) for k, own in enumerate(wanted)}
    raw = columns_in(samples, stretches, [*CHANNELS, "time", "temperature"], repairs)
    corrected = columns_in(compensated, stretches, CHANNELS)
    for (k, before), (same, after) in zip(raw, corrected, strict=True):
        assert k == same  # both tables have the same records in the same order
        yield _on_grid(wanted[k], before, after)


def _on_grid(window: Window, before: Columns, after: Columns) -> Readings:
    """Both on one grid of samples; what either lacks is missing in both, and bridged by a line."""
    step = window.step
    time = np.asarray(before["time"], np.float64)
    if not np.isfinite(time).all():
        time = before["record"] * step
    steps = np.append(0, np.cumsum(np.maximum(np.rint(np.diff(time) / step), 0)))
    grid = np.arange(steps[-1] + 1)
    recorded, corrected = (
        np.column_stack([part[channel] for channel in CHANNELS]).astype(np.float64)
        for part in (before, after)
    )
    there = np.isfinite(recorded) & np.isfinite(corrected)
    limit = MAX_HOLE_TURNING if window.turn else MAX_HOLE
    hole = max(_longest_hole(steps[column], grid) for column in there.T) * step
    at_rest = before["record"] < window.moving
    aligned = int(steps[at_rest].max(initial=-1)) + 1
    if hole > max(limit, 3 * step) or not aligned:
        nothing = np.empty((0, 6))
        return Readings(window, 0, nothing, nothing, np.empty(0), np.empty(0), HOLES)

    def bridged(values: Array) -> Array:
        columns = zip(there.T, values.T, strict=True)
        return np.column_stack([np.interp(grid, steps[t], column[t]) for t, column in columns])

    temperature = np.asarray(before["temperature"], np.float64)
    some = np.isfinite(temperature)
    warm = np.interp(grid, steps[some], temperature[some]) if some.any() else grid * np.nan
    both = bridged(recorded), bridged(corrected)
    return Readings(window, aligned, *both, time[0] + grid * step, warm)


def _longest_hole(there: Array, grid: Array) -> float:
    """Samples of the grid in a row without a reading."""
    if not len(there):
        return np.inf
    return float(np.diff(np.concatenate([[grid[0] - 1], there, [grid[-1] + 1]])).max() - 1)
