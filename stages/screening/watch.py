"""Detectors at work on pieces of logs: what they see, put together over the borders of pieces."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain

from stages.detectors.detector import Detector, Event, Given, Log, Piece

# By detector, name of what was shown (empty for the campaign as a whole) and channel.
Seen = dict[tuple[Detector, str, int | None], list[Event]]


@dataclass(frozen=True)
class Watched:
    """What the detectors saw in stretches of logs, each stretch under its name."""

    seen: Seen
    logs: Mapping[str, Log]  # by the same names


def watch(
    detectors: Sequence[Detector],
    cut: Iterable[tuple[str, Piece]],
    logs: Mapping[str, Log],
    given: Given,
) -> Watched:
    """Show every piece to every detector; what one masks those after it do not see.

    Parameters
    ----------
    cut : pieces of logs, or of rests, each under its name
    logs : the log of each name
    """
    seen: Seen = {}
    for name, piece in cut:
        shown = piece
        first = int(piece.record[piece.first])
        after = int(piece.record[piece.after - 1]) + 1
        for detector in detectors:
            events = list(detector.finds(shown, logs[name]))
            if detector.masks:
                shown = shown.without(events)
            for event in events:
                # A piece answers for its own records; an event without records, for a border.
                if (event.after > first and event.first < after) or first <= event.first < after:
                    _add(seen.setdefault((detector, name, event.channel), []), event)
    for detector in detectors:
        for event in chain(detector.judges(given), detector.compares(logs)):
            seen.setdefault((detector, "", event.channel), []).append(event)
        for name, log in logs.items():
            for event in detector.concludes(log):
                _add(seen.setdefault((detector, name, event.channel), []), event)
    return Watched(seen, logs)


def _add(events: list[Event], event: Event) -> None:
    """Join an event with the one before where a border of pieces cut it."""
    if events and event.first < events[-1].after:
        last = events[-1]
        size = max(last.size, event.size, key=abs)
        if event.after > last.after:
            events[-1] = replace(last, after=event.after, to_s=event.to_s, size=size)
    else:
        events.append(event)
