"""When, and in which sense, the table last turned about each axis before a moment of a log."""

from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.records import Manoeuvre
from inertial.campaign.static_positions import Blocks, by_manoeuvre
from inertial.effects.gyro_hysteresis import BREAK_AWAY


@dataclass(frozen=True)
class _Turn:
    """A turn: when it began and ended, s of its log, and its sense about each axis, (3,), or 0."""

    begin: float
    end: float
    senses: Array


class LastTurns:
    """The turns in each log of a campaign: those of the plan, and those on the way between."""

    def __init__(self, data: CampaignData) -> None:
        blocks = by_manoeuvre(data.blocks)
        self._of_log: dict[str, list[_Turn]] = {}
        for m in data.plan:
            turns = self._of_log.setdefault(m.log, [])
            done = data.performed.get(m.name)
            if done is not None and done.stopped is not None:
                turns.append(_Turn(done.stopped, done.stopped, np.nan_to_num(done.senses)))
            turn = turn_in(blocks[m.name]) if m.do == "turn" and m.name in blocks else None
            if turn is not None:
                turns.append(turn)

    def before(self, m: Manoeuvre, time: Array) -> tuple[Array, Array]:
        """`since` and `turned` of `Motion` at the middles of stretches of a log, s, (k, 3) each."""
        since, turned = np.full((len(time), 3), np.nan), np.zeros((len(time), 3))
        for turn in self._of_log.get(m.log, ()):
            later = (time >= turn.begin)[:, None] & (turn.senses != 0)
            past = (time - turn.end)[:, None]
            latest = later & ~(since < past)  # NaN is no time
            since, turned = np.where(latest, past, since), np.where(latest, turn.senses, turned)
        return since, turned


def turn_in(blocks: Blocks) -> _Turn | None:
    """The turn in the blocks of a manoeuvre, in their order; None where nothing turns.

    In the last block that moves it brakes evenly from the rate at its start, which continues that
    of the two blocks before: it stops after twice the angle over that rate.
    """
    rates = np.nan_to_num(blocks.gyro)
    moving = np.flatnonzero((np.abs(rates) > BREAK_AWAY).any(axis=1))
    if not len(moving):
        return None
    first, last = int(moving[0]), int(moving[-1])
    axis = int(np.argmax(np.abs(rates[last])))
    rate, seconds = np.abs(rates[:, axis]), blocks.seconds
    lasting = float(seconds[last])
    if last >= first + 2:
        apart = (seconds[last - 2] + seconds[last - 1]) / 2
        slope = min((rate[last - 1] - rate[last - 2]) / apart, 0.0)
        start = float(rate[last - 1] + slope * seconds[last - 1] / 2)
        if start > rate[last]:
            lasting = min(lasting, 2 * float(rate[last]) * lasting / start)
    begins = blocks.time - seconds / 2
    turned = rates[moving]
    senses = np.sign(turned.sum(axis=0)) * (np.abs(turned) > BREAK_AWAY).any(axis=0)
    return _Turn(float(begins[first]), float(begins[last]) + lasting, senses)
