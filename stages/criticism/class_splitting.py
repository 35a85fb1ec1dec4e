"""Which further manoeuvre would distinguish the members of a class."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.equations import Campaign, evidence
from inertial.campaign.records import Manoeuvre, Performed
from inertial.estimation.least_squares import EffectInformation
from inertial.model_selection.splitting import MIN_SEPARATION, split
from inertial.physics.effect import Effect
from inertial.tables import GYRO, STATIC_PHASES
from inertial.text.messages import _
from stages.criticism.selection import Selection, columns_of, evidence_of

# ---- Manoeuvres that a laboratory might add: copies of those performed, to predict their value.
#
# Only their information counts, which depends on attitude, rate and noise; the readings are those
# of the originals and mean nothing.

PAUSE = 60.0  # s, before an added manoeuvre
TURNED_OVER = _("turn also at the same rate with the axis down")
FASTER = _("turn also at twice the rate")
BETWEEN_AXES = _("rest also with two axes at 45° to the vertical")
ONCE_MORE = _("do the rests once more, in the reverse order")


@dataclass(frozen=True)
class Further:
    """A campaign with some manoeuvres more: its plan, what was performed, and its blocks."""

    plan: list[Manoeuvre]
    performed: dict[str, Performed]
    blocks: pd.DataFrame


def further(
    plan: Sequence[Manoeuvre], performed: Mapping[str, Performed], blocks: pd.DataFrame
) -> dict[str, Callable[[], Further]]:
    """Manoeuvres that might be added to a campaign, by name; each is made when it is used."""
    rows = blocks.groupby("manoeuvre").indices
    complete = [m for m in plan if performed[m.name].complete]
    whole = [m for m in complete if m.up is not None and m.name in rows]
    turns = [m for m in whole if m.do == "turn" and m.recorded == "whole" and m.rate is not None]
    rests = [m for m in whole if m.do == "rest"]

    def added(pairs: Sequence[tuple[Manoeuvre, Manoeuvre, float]]) -> Further:
        done, times, start = dict(performed), [], float(blocks["time"].max())
        for original, copy, faster in pairs:
            own = blocks["time"].to_numpy()[rows[original.name]]
            times.append(start + PAUSE + (own - np.fmin.reduce(own)) / faster)
            start = float(np.fmax.reduce(times[-1]))
            done[copy.name] = replace(performed[original.name], manoeuvre=copy.name)
        parts = [rows[original.name] for original, _, _ in pairs]
        each = np.repeat(np.arange(len(pairs)), [len(part) for part in parts])
        more = blocks.iloc[np.concatenate(parts)].copy()
        more["manoeuvre"] = np.array([copy.name for _, copy, _ in pairs])[each]
        more["time"] = np.concatenate(times)
        factor = np.array([faster for _, _, faster in pairs])[each]
        more["seconds"] /= factor
        more["count"] /= factor
        moving = ~more["phase"].isin(STATIC_PHASES).to_numpy(bool)
        more[GYRO] *= np.where(moving, factor, 1.0)[:, None]
        manoeuvres = [*plan, *(copy for _, copy, _ in pairs)]
        return Further(manoeuvres, done, pd.concat([blocks, more], ignore_index=True))

    found: dict[str, Callable[[], Further]] = {}
    if turns:
        found[TURNED_OVER] = partial(added, [(m, _turned_over(m), 1.0) for m in turns])
        found[FASTER] = partial(added, [(m, _named(m, "faster"), 2.0) for m in turns])
    if rests:
        like = rests[0]
        ups = [
            (np.eye(3)[i] + sign * np.eye(3)[j]) / np.sqrt(2)
            for i, j in combinations(range(3), 2)
            for sign in (1, -1)
        ]
        diagonal = [
            replace(_named(like, f"at 45° {number}"), up=up, mark=None)
            for number, up in enumerate(ups, 1)
        ]
        found[BETWEEN_AXES] = partial(added, [(like, copy, 1.0) for copy in diagonal])
        again = [(m, _named(m, "once more"), 1.0) for m in reversed(rests)]
        found[ONCE_MORE] = partial(added, again)
    return found


def _named(m: Manoeuvre, what: str) -> Manoeuvre:
    """A copy at a position of its own."""
    return replace(m, name=f"{m.name} {what}", position=f"{m.position} {what}")


def _turned_over(m: Manoeuvre) -> Manoeuvre:
    assert m.up is not None  # else it is not copied
    return replace(_named(m, "turned over"), up=-m.up)


# ---- The manoeuvre that best distinguishes the members of a class, by this campaign's noise.

Array = NDArray[np.float64]

MIN_MIMICRY = 0.9  # share of a signal that another effect can mimic, to compare manoeuvres


@dataclass(frozen=True)
class Splitting:
    """The manoeuvre that distinguishes best, and its signal-to-noise ratio."""

    manoeuvre: str
    separation: float

    @property
    def tells(self) -> bool:
        """Whether the likelier member would be right in 95 of 100 campaigns."""
        return self.separation >= MIN_SEPARATION


class Foreseen:
    """The campaign with each further manoeuvre, computed at its first use."""

    def __init__(self, selection: Selection, further: Mapping[str, Callable[[], Campaign]]) -> None:
        self._selection, self._further = selection, further
        self._made: dict[str, Campaign] = {}

    def with_(self, manoeuvre: str) -> Campaign:
        """The campaign with a further manoeuvre."""
        if manoeuvre not in self._made:
            self._made[manoeuvre] = self._further[manoeuvre]()
        return self._made[manoeuvre]

    def splitting(self, number: int) -> Splitting | None:
        """For one of the causes; None where it is alone in its class, or nothing distinguishes."""
        causes = self._selection.named.causes
        if len(causes[number].members) < 2 or not self._further:
            return None
        concerned = {*causes[number].members, *(cause.effect for cause in causes)}
        families = {n: one for n, one in self._selection.families.items() if n in concerned}
        every = {}
        for manoeuvre in self._further:
            said, asked = evidence_of(self.with_(manoeuvre), families, np.inf)
            every[manoeuvre] = said.total
            now = self._selection.evidence.total.of(said.names)
        found = split(now, every, asked, causes, number)
        return Splitting(found[0].manoeuvre, found[0].separation) if found else None

    def mimicry(self, effect: str, other: str, manoeuvre: str) -> tuple[float, float] | None:
        """Which share of an effect another can mimic, now and with a manoeuvre.

        None: unseen, or less than nearly all of it now.
        """
        if manoeuvre not in self._further or not self._selection.evidence.sensors:
            return None
        two = [self._selection.effect(name, 0) for name in (effect, other)]
        now = _mimicked(self._selection.evidence.total, *two)
        if now is None or now < MIN_MIMICRY:
            return None
        then = _mimicked(evidence(self.with_(manoeuvre), two).total, *two)
        return None if then is None else (now, then)


def _mimicked(reduced: EffectInformation, effect: Effect, other: Effect) -> float | None:
    """Which share of an effect another can mimic; None where either is not seen."""
    own, theirs = (
        [i for i, name in enumerate(reduced.names) if name in columns_of(one)]
        for one in (effect, other)
    )
    total = float(np.trace(reduced.information[np.ix_(own, own)]))
    if total <= 0 or not np.any(reduced.information[np.ix_(theirs, theirs)]):
        return None
    across = reduced.information[np.ix_(theirs, own)]
    inverse = np.linalg.pinv(reduced.information[np.ix_(theirs, theirs)], rcond=1e-10)
    return float(np.trace(across.T @ inverse @ across)) / total
