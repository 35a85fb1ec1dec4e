"""Which further manoeuvre would tell the members of a class apart, by this campaign's noise."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.criticising.judging import Judged, said_of
from stages.estimation.evidence import Campaign, evidence
from stages.inference.least_squares import Reduced
from stages.inference.naming.splitting import TELLS, split
from stages.model.effect import Effect

Array = NDArray[np.float64]

LIKE = 0.9  # share of a signal that another effect can mimic, from which the two are one


@dataclass(frozen=True)
class Splitting:
    """The manoeuvre that tells best, and the signal-to-noise ratio of its telling."""

    manoeuvre: str
    separation: float

    @property
    def tells(self) -> bool:
        """Whether the likelier member would be right in 95 of 100 campaigns."""
        return self.separation >= TELLS


class Foreseen:
    """What the campaign would say with each further manoeuvre; reckoned when it is asked for."""

    def __init__(self, judged: Judged, further: Mapping[str, Callable[[], Campaign]]) -> None:
        self._judged, self._further = judged, further
        self._made: dict[str, Campaign] = {}

    def with_(self, manoeuvre: str) -> Campaign:
        """The campaign with a manoeuvre more."""
        if manoeuvre not in self._made:
            self._made[manoeuvre] = self._further[manoeuvre]()
        return self._made[manoeuvre]

    def splitting(self, number: int) -> Splitting | None:
        """For one of the causes; None where it is alone in its class, or nothing tells."""
        causes = self._judged.named.causes
        if len(causes[number].members) < 2 or not self._further:
            return None
        concerned = {*causes[number].members, *(cause.effect for cause in causes)}
        families = {n: one for n, one in self._judged.families.items() if n in concerned}
        every = {}
        for manoeuvre in self._further:
            said, asked = said_of(self.with_(manoeuvre), families, np.inf)
            every[manoeuvre] = said.total
            now = self._judged.said.total.of(said.names)
        found = split(now, every, asked, causes, number)
        return Splitting(found[0].manoeuvre, found[0].separation) if found else None

    def mimicry(self, effect: str, other: str, manoeuvre: str) -> tuple[float, float] | None:
        """Which share of an effect another can mimic, now and with a manoeuvre.

        None: unseen, or less than nearly all of it now.
        """
        if manoeuvre not in self._further or not self._judged.said.sensors:
            return None
        two = [self._judged.effect(name, 0) for name in (effect, other)]
        now = _mimicked(self._judged.said.total, *two)
        if now is None or now < LIKE:
            return None
        then = _mimicked(evidence(self.with_(manoeuvre), two).total, *two)
        return None if then is None else (now, then)


def _mimicked(reduced: Reduced, effect: Effect, other: Effect) -> float | None:
    """Which share of an effect another can mimic; None where either is not seen."""
    own, theirs = (
        [i for i, name in enumerate(reduced.names) if name.startswith(f"{one.label}.")]
        for one in (effect, other)
    )
    total = float(np.trace(reduced.information[np.ix_(own, own)]))
    if total <= 0 or not np.any(reduced.information[np.ix_(theirs, theirs)]):
        return None
    across = reduced.information[np.ix_(theirs, own)]
    inverse = np.linalg.pinv(reduced.information[np.ix_(theirs, theirs)], rcond=1e-10)
    return float(np.trace(across.T @ inverse @ across)) / total
