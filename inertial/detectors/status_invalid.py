"""Records that the instrument itself calls invalid."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import runs
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed


class StatusInvalid(Detector):
    """A record whose status lacks a bit that must be set, or has one that must be clear.

    Cause: the instrument found a fault in itself: a sensor, its temperature, a start-up. What it
    reads then is not to be trusted.
    """

    name = "status_invalid"
    source = "the status word in the instrument's manual, as data/instruments.yaml quotes it"
    unit = "records"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        there = np.isfinite(piece.status)
        bits = np.where(there, piece.status, 0).astype(np.int64)
        lacks = ~bits & log.given.must_be_set
        has = bits & log.given.must_be_clear
        for start, end in runs(there & ((lacks | has) != 0)):
            facts = (int(bits[start]), int(lacks[start]), int(has[start]))
            yield piece.event(start, end, float(end - start), facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        status, lacks, has = event.facts
        single = event.size == 1
        at = f", {fixed(event.from_s, 3)} s," if np.isfinite(event.from_s) else ""
        why = [
            _(
                "{lacks} {value} not set",
                lacks=_bits(lacks),
                value=_("is") if lacks.bit_count() == 1 else _("are"),
            )
        ] * bool(lacks)
        why += [
            _(
                "{bits} {value} set",
                bits=_bits(has),
                value=_("is") if has.bit_count() == 1 else _("are"),
            )
        ] * bool(has)
        return Description(
            _(
                "{name}: the instrument marks {counted} from line {line}{at} as invalid: status "
                "{status:08x}, {why}.",
                name=name,
                counted=counted(int(event.size), "record"),
                line=event.line,
                at=at,
                status=status,
                why=_(" and ").join(why),
            ),
            _("Their readings are not to be trusted, by up to the full range of the sensor."),
            _(
                "{value} masked; the time is counted. See the status word in the instrument's "
                "manual.",
                value=_("It is") if single else _("They are"),
            ),
        )


def _bits(word: int) -> str:
    """The bits that are set, by number from 0."""
    numbers = [str(bit) for bit in range(word.bit_length()) if word >> bit & 1]
    return f"bit{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}"
