"""Which additional manoeuvre would distinguish the members of a class."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from itertools import combinations
from math import isclose

import numpy as np
import pandas as pd

from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.records import Manoeuvre, Performed
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.splitting import MIN_SEPARATION, split
from inertial.physics.effect import Effect
from inertial.tables import ACCEL, GYRO, STATIC_PHASES
from inertial.text.messages import _
from stages.criticism.effect_selection import evidence_of
from stages.criticism.selection import Selection

# ---- Manoeuvres that a laboratory might add: copies of those performed, to predict their value.
#
# Only their information is used, which depends on attitude, rate and noise; the readings are
# those of the originals and have no meaning.

PAUSE = 60.0  # s, before an added manoeuvre
ALIKE = 0.99  # cosine of two directions (8°), and ratio of two rates, that are as good as one
TURNED_OVER = _("turn also at the same rate with the axis down")
FASTER = _("turn also at twice the rate")
BETWEEN_AXES = _("rest also with two axes at 45° to the vertical")
ONCE_MORE = _("do the rests once more, in the reverse order")


@dataclass(frozen=True)
class ExtendedPlan:
    """A campaign with additional manoeuvres: its plan, what was performed, and its blocks."""

    plan: list[Manoeuvre]
    performed: dict[str, Performed]
    blocks: pd.DataFrame


def extended_plans(
    plan: Sequence[Manoeuvre], performed: Mapping[str, Performed], blocks: pd.DataFrame
) -> dict[str, Callable[[], ExtendedPlan]]:
    """The campaign with each manoeuvre that might be added, by name, computed on demand.

    What the plan has already, as turns with the axis up and down at one rate, is none of them: to
    do it once more brings little of what a manoeuvre of another kind brings.
    """
    rows = blocks.groupby("manoeuvre").indices
    complete = [m for m in plan if performed[m.name].complete]
    whole = [m for m in complete if m.up is not None and m.name in rows]
    turns = [m for m in whole if m.do == "turn" and m.recorded == "whole" and m.rate is not None]
    rests = [m for m in whole if m.do == "rest"]

    def added(pairs: Sequence[tuple[Manoeuvre, Manoeuvre, float]]) -> ExtendedPlan:
        done, times, start = dict(performed), [], float(blocks["time"].max())
        for original, copy, speed in pairs:
            own = blocks["time"].to_numpy()[rows[original.name]]
            times.append(start + PAUSE + (own - np.fmin.reduce(own)) / speed)
            start = float(np.fmax.reduce(times[-1]))
            done[copy.name] = replace(performed[original.name], manoeuvre=copy.name)
        parts = [rows[original.name] for original, _, _ in pairs]
        each = np.repeat(np.arange(len(pairs)), [len(part) for part in parts])
        copies = blocks.iloc[np.concatenate(parts)].copy()
        copies["manoeuvre"] = np.array([copy.name for _, copy, _ in pairs])[each]
        copies["time"] = np.concatenate(times)
        factor = np.array([speed for _, _, speed in pairs])[each]
        copies["seconds"] /= factor
        copies["count"] /= factor
        moving = ~copies["phase"].isin(STATIC_PHASES).to_numpy(bool)
        copies[GYRO] *= np.where(moving, factor, 1.0)[:, None]
        # With the axis down accelerometers read the force the other way, but for a lever arm.
        signs = np.array([_sign_of_force(original, copy) for original, copy, _ in pairs])
        copies[ACCEL] *= signs[each][:, None]
        manoeuvres = [*plan, *(copy for _, copy, _ in pairs)]
        return ExtendedPlan(manoeuvres, done, pd.concat([blocks, copies], ignore_index=True))

    plans: dict[str, Callable[[], ExtendedPlan]] = {}
    if turns:
        over = [(m, _turned_over(m), 1.0) for m in turns]
        if new := [pair for pair in over if not any(_alike(pair[1], m) for m in turns)]:
            plans[TURNED_OVER] = partial(added, new)
        plans[FASTER] = partial(added, [(m, _named(m, "faster"), 2.0) for m in turns])
    if rests:
        first = rests[0]
        ups = [
            (np.eye(3)[i] + sign * np.eye(3)[j]) / np.sqrt(2)
            for i, j in combinations(range(3), 2)
            for sign in (1, -1)
        ]
        diagonal = [
            replace(_named(first, _("at 45° {number}", number=number)), up=up, mark=None)
            for number, up in enumerate(ups, 1)
        ]
        plans[BETWEEN_AXES] = partial(added, [(first, copy, 1.0) for copy in diagonal])
        again = [(m, _named(m, "once more"), 1.0) for m in reversed(rests)]
        plans[ONCE_MORE] = partial(added, again)
    return plans


def _named(m: Manoeuvre, what: str) -> Manoeuvre:
    """A copy at a position of its own."""
    return replace(m, name=f"{m.name} {what}", position=f"{m.position} {what}")


def _turned_over(m: Manoeuvre) -> Manoeuvre:
    assert m.up is not None  # else it is not copied
    return replace(_named(m, "turned over"), up=-m.up)


def _sign_of_force(original: Manoeuvre, copy: Manoeuvre) -> float:
    assert original.up is not None and copy.up is not None  # else it is not copied
    return -1.0 if np.allclose(original.up, -copy.up) else 1.0


def _alike(one: Manoeuvre, other: Manoeuvre) -> bool:
    """Whether two turns are about one axis, with the same end of it up, at one rate."""
    assert one.up is not None and other.up is not None and one.rate and other.rate
    alike = min(float(one.up @ other.up), abs(float(one.axis @ other.axis))) > ALIKE
    return alike and isclose(abs(one.rate), abs(other.rate), rel_tol=1 - ALIKE)


# ---- The manoeuvre that best distinguishes the members of a class, by this campaign's noise.

MIN_MIMICRY = 0.9  # share of a signal that another effect can mimic, to compare manoeuvres


@dataclass(frozen=True)
class Splitting:
    """The manoeuvre that distinguishes best; which pair, and its signal-to-noise ratio.

    `members`: of the class, how many are compared.
    """

    manoeuvre: str
    pair: tuple[str, str]
    separation: float
    members: int = 2

    @property
    def distinguishes(self) -> bool:
        """Whether the likelier member would be right in 95 of 100 campaigns."""
        return self.separation >= MIN_SEPARATION


class ExtendedCampaigns:
    """The campaign with each additional manoeuvre, computed at its first use."""

    def __init__(self, selection: Selection, make: Mapping[str, Callable[[], Campaign]]) -> None:
        self._selection, self._make = selection, make
        self._campaigns: dict[str, Campaign] = {}

    def with_(self, manoeuvre: str) -> Campaign:
        """The campaign with an additional manoeuvre."""
        if manoeuvre not in self._campaigns:
            self._campaigns[manoeuvre] = self._make[manoeuvre]()
        return self._campaigns[manoeuvre]

    def splitting(self, number: int) -> Splitting | None:
        """For one of the causes; None where it is alone in its class, or nothing distinguishes."""
        causes = self._selection.named.causes
        if len(causes[number].members) < 2 or not self._make:
            return None
        concerned = {*causes[number].members, *(cause.effect for cause in causes)}
        families = {n: f for n, f in self._selection.families.items() if n in concerned}
        extended = {}
        for manoeuvre in self._make:
            equations, searched = evidence_of(self.with_(manoeuvre), families, np.inf)
            extended[manoeuvre] = equations.total
            present = self._selection.evidence.total.of(equations.names)
        best = next(iter(split(present, extended, searched, causes, number)), None)
        if best is None:
            return None
        pair, members = best.pair, {name for p in best.pairs for name in (p.first, p.second)}
        names = sorted((pair.first, pair.second), key=causes[number].members.index)
        return Splitting(best.manoeuvre, (names[0], names[1]), pair.extended, len(members))

    def mimicry(self, effect: str, other: str, manoeuvre: str) -> tuple[float, float] | None:
        """Which share of an effect another can mimic, without and with a manoeuvre.

        None where either is not observable, or the present share is below MIN_MIMICRY.
        """
        if manoeuvre not in self._make or not self._selection.evidence.sensors:
            return None
        effects = [self._selection.effect(name, 0) for name in (effect, other)]
        present = _mimicked(self._selection.evidence.total, *effects)
        if present is None or present < MIN_MIMICRY:
            return None
        extended = _mimicked(evidence(self.with_(manoeuvre), effects).total, *effects)
        return None if extended is None else (present, extended)


def _mimicked(reduced: EffectInformation, effect: Effect, other: Effect) -> float | None:
    """Which share of an effect another can mimic; None where either is not observable."""
    own, others = (
        [i for i, name in enumerate(reduced.names) if name in candidate.columns]
        for candidate in (effect, other)
    )
    total = float(np.trace(reduced.information[np.ix_(own, own)]))
    if total <= 0 or not np.any(reduced.information[np.ix_(others, others)]):
        return None
    across = reduced.information[np.ix_(others, own)]
    inverse = np.linalg.pinv(reduced.information[np.ix_(others, others)], rcond=1e-10)
    return float(np.trace(across.T @ inverse @ across)) / total
