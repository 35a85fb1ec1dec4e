"""A bias that jumps and goes back within one manoeuvre: what the model shows of it without a name.

An effect of the catalogue is a bias that jumps and stays so. One that returns shows as two levels,
or as a structure that one manoeuvre alone carries; the recording itself shows the jump.
"""

from collections.abc import Mapping
from dataclasses import dataclass

from inertial.campaign.hypotheses import FOUND, LAW, MODEL, UNKNOWN_STRUCTURE, Hypothesis
from inertial.campaign.records import Row
from inertial.effects import LAWS
from inertial.effects.law import TELEGRAPH
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from stages.diagnosis.causes import LEFT_OUT, MODELLED, Cause
from stages.diagnosis.one_event import ONE_EVENT
from stages.diagnosis.sizes_of_causes import Size

BIAS_JUMP = "bias_jump"
RECORD_AGAIN = _(
    "Record {manoeuvre} again; see whether contact, supply or temperature changed then."
)


def named(cause: Cause) -> Cause:
    """The same as a jump of a bias, where that is what it is."""
    main, shown = cause.main, _shown(cause)
    places = {one.manoeuvre for one in shown} | {cause.manoeuvre} - {None}
    if main.stage != MODEL or len(cause.members) > 1 or len(places) != 1:
        return cause
    levels = main.verdict == LAW and LAWS[main.cause].family == TELEGRAPH
    structure = main.cause == UNKNOWN_STRUCTURE and main.manoeuvres == places and bool(shown)
    return JumpInOneManoeuvre(**vars(cause)) if levels or structure else cause


def _shown(cause: Cause) -> list[Hypothesis]:
    """The jumps that the recording shows among its consequences."""
    every = (each for member in cause.members for each in member.consequences)
    return [each for each in every if each.cause == BIAS_JUMP]


@dataclass(frozen=True)
class JumpInOneManoeuvre(Cause):
    """Such a cause: it has the name of what the recording shows, and the cure of the model."""

    @property
    def manoeuvre(self) -> str | None:
        return super().manoeuvre or next(one.manoeuvre for one in _shown(self))

    @property
    def verdict(self) -> str:
        return FOUND

    @property
    def condition(self) -> str | None:
        return None if self.cure in (LEFT_OUT, MODELLED) else super().condition

    @property
    def name(self) -> str:
        words = in_words(BIAS_JUMP)
        words += _(" of the {axis} axis", axis=self._axis) if self._axis else ""
        return words + _(" ({place})", place=self.manoeuvre)

    @property
    def _axis(self) -> str | None:
        axes = {one.axis for one in (self.main, *_shown(self))} - {None}
        return next(iter(axes)) if len(axes) == 1 else None

    def row(self, sizes: Mapping[str, Size], sentences: Mapping[str, str]) -> Row:
        row, shown = super().row(sizes, sentences), _shown(self)
        row |= {"cause": BIAS_JUMP, "axis": self._axis, "manoeuvre": self.manoeuvre}
        row |= {"action": RECORD_AGAIN.format(manoeuvre=self.manoeuvre)}
        if not shown:
            return row
        own = max(shown, key=lambda one: one.size).row
        sentence = f"{own['sentence']} {ONE_EVENT.format(sentence=row['sentence'])}"
        row |= {"log": own["log"], "sentence": sentence, "consequence": own["consequence"]}
        if self.main.verdict == LAW:
            return row
        return row | {"size": own["size"], "sigma": None, "unit": own["unit"]}
