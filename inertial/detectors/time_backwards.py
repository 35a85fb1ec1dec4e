"""Time that goes back."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.stamps import disorders
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed


@dataclass(frozen=True)
class _Facts:
    """Time before the step back; whether the stamps are ahead; the share that is a replay."""

    before: float
    ahead: bool
    replayed: float


class TimeBackwards(Detector):
    """A stretch of records from where time goes back to where it has passed its former maximum.

    Where stamps jump ahead first and come back after fewer records than that, these are the
    stretch. `from_s` and `to_s` are both the stamp behind the step, for which time it was in
    between is unknown; the records give its duration.
    """

    name = "time_backwards"
    cause = _("logs were joined, the clock was set, or a stamp was spoilt")
    source = "design study, 41c"
    costs = _("when these records were taken is not known")
    unit = "s"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        # Nothing is left of a record that repeats an earlier one.
        replayed = np.asarray(np.isnan(piece.values).all(axis=1))
        for disorder in disorders(piece.time, piece.reached, log.interval):
            step = disorder.end if disorder.ahead and disorder.end < len(piece) else disorder.start
            before = max(piece.reached, float(piece.time[:step].max(initial=-np.inf)))
            facts = _Facts(
                before, disorder.ahead, float(replayed[disorder.start : disorder.end].mean())
            )
            event = piece.event(disorder.start, disorder.end, disorder.size, facts=facts)
            stamp = float(piece.time[step])
            # Where it begins in an earlier piece this is its continuation.
            yield event if step == 0 else replace(event, from_s=stamp, to_s=stamp)

    def describe(self, event: Event, name: str) -> Description:
        facts, records = event.facts, counted(event.after - event.first, "record")
        if facts.ahead:
            sentence = _(
                "{name}: the stamps of {records} from line {line} are {size:.6f} s ahead; then "
                "time goes back to {from_s} s.",
                name=name,
                records=records,
                line=event.line,
                size=event.size,
                from_s=fixed(event.from_s, 3),
            )
        else:
            sentence = _(
                "{name}: at line {line} time goes back by {size:.6f} s, from {before} s to "
                "{from_s} s; {records} lie behind.",
                name=name,
                line=event.line,
                size=event.size,
                before=fixed(facts.before, 3),
                from_s=fixed(event.from_s, 3),
                records=records,
            )
        if facts.replayed == 1:
            return Description(
                _("{sentence} They repeat earlier ones.", sentence=sentence),
                _("None beyond that of the repetition."),
                _("The repetition is masked. Look for logs that were joined."),
            )
        masked = _("What repeats earlier ones is masked") if facts.replayed else "Nothing is masked"
        return Description(
            sentence,
            _(
                "Means and sums do not use the stamps and stand. When these records were taken "
                "is unknown by {size:.3g} s: so is what depends on it, a drift of a bias and "
                "the order of the manoeuvres.",
                size=event.size,
            ),
            _(
                "{masked}; a turn in which time goes back is left out. Look for logs that were "
                "joined, or for a clock that was set.",
                masked=masked,
            ),
        )
