"""Which stretch of a window is which manoeuvre, and which records are which phase of it."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from stages.contracts.records import Manoeuvre
from stages.segmentation.alignment import align, rest_score, turn_score
from stages.segmentation.motion import Stretch, steady_part
from stages.segmentation.windows import Binned

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Part:
    """One phase of one manoeuvre: records [first, after) of its log."""

    manoeuvre: str
    phase: str
    log: str
    first: int
    after: int


def match(one: Binned, found: Sequence[Stretch], level: Array) -> dict[str, int | None]:
    """For each manoeuvre of the window its stretch, None where it is not found."""
    sought = [m for m in one.window.manoeuvres if m.do != "positions"]
    scores = np.array([[_score(one, stretch, m, level) for stretch in found] for m in sought])
    places = align(scores.reshape(len(sought), len(found)))
    return {m.name: place for m, place in zip(sought, places, strict=True)}


def _score(one: Binned, stretch: Stretch, m: Manoeuvre, level: Array) -> float:
    inside = slice(stretch.first, stretch.after)
    if stretch.moves is (m.do == "rest"):
        return 0.0
    if m.do == "rest":
        forces = one.forces[inside]
        there = np.isfinite(forces).all(axis=1)
        force = forces[there].mean(axis=0) if there.any() else np.full(3, np.nan)
        return rest_score(float(one.seconds[inside].sum()), m.seconds, force, m.up)
    about = one.about(m.axis, level)[inside]
    if m.recorded == "steady":
        return turn_score(float(np.nanmean(about)), m.rate)
    return turn_score(float(np.nansum(about * one.seconds[inside])), m.angle)


def motion(one: Binned, found: Sequence[Stretch], place: int) -> tuple[int, int]:
    """The bins of a turn; in a window of its own it is all that moves, pauses included."""
    if one.window.alone:
        moves = [stretch for stretch in found if stretch.moves]
        return moves[0].first, moves[-1].after
    return found[place].first, found[place].after


def rest_part(one: Binned, stretch: Stretch, name: str, margin: float) -> Part:
    """A rest without the margin beside a motion."""
    room = round(margin / one.bin_seconds)
    first = stretch.first + (room if stretch.first > 0 else 0)
    after = stretch.after - (room if stretch.after < one.bins else 0)
    first, after = (first, after) if after > first else (stretch.first, stretch.after)
    return Part(name, "rest", one.window.log, int(one.edges[first]), int(one.edges[after]))


def position_parts(
    one: Binned,
    found: Sequence[Stretch],
    m: Manoeuvre,
    matched: Mapping[str, int | None],
    margin: float,
) -> Iterator[Part]:
    """Every rest that is long enough and no other manoeuvre's, numbered."""
    number = 0
    for place, stretch in enumerate(found):
        seconds = float(one.seconds[stretch.first : stretch.after].sum())
        free = not stretch.moves and place not in matched.values()
        if free and seconds >= (m.seconds or 0.0):
            number += 1
            yield rest_part(one, stretch, f"{m.name}-{number:02d}", margin)


def turn_parts(
    one: Binned,
    found: Sequence[Stretch],
    m: Manoeuvre,
    matched: Mapping[str, int | None],
    level: Array,
    margin: float,
) -> Iterator[Part]:
    """The phases of a turn, and the rests beside it that no other manoeuvre has."""
    place = matched[m.name]
    assert place is not None  # only a turn that was found has phases
    first, after = motion(one, found, place)
    room = round(margin / one.bin_seconds)
    start, stop = max(first - room, 0), min(after + room, one.bins)
    free = [place + side not in matched.values() for side in (-1, 1)]
    before = 0 if one.window.alone else found[max(place - 1, 0)].first
    behind = one.bins if one.window.alone else found[min(place + 1, len(found) - 1)].after

    phases: list[tuple[str, int, int]] = []
    if free[0] and first > 0:
        phases.append(("rest-before", before, start))
    if m.rate is None:
        phases.append(("turning", start, stop))
    else:
        a, b = steady_part(one.about(m.axis, level)[first:after])
        steady = (first + a, first + b)
        phases += [
            ("spin-up", start, steady[0]),
            ("steady", *steady),
            ("spin-down", steady[1], stop),
        ]
    if free[1] and after < one.bins:
        phases.append(("rest-after", stop, behind))
    for phase, a, b in phases:
        if b > a:
            yield Part(m.name, phase, one.window.log, int(one.edges[a]), int(one.edges[b]))
