"""The parts of a report made on two processors: to draw its figures is most of what it costs."""

import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from typing import Any, TypeVar

Part = TypeVar("Part")

PROCESSES = 2

_works: Sequence[Callable[[], Any]] = ()  # of the process that is forked


def at_once(works: Sequence[Callable[[], Part]]) -> list[Part]:
    """What each of them makes, in their order.

    The processes are forked, so that they have all tables already; where that is not safe, beyond
    Linux, one after the other is made here.
    """
    if sys.platform != "linux":
        return [work() for work in works]
    with ProcessPoolExecutor(PROCESSES, get_context("fork"), _begin, (works,)) as pool:
        return list(pool.map(_made, range(len(works))))


def _begin(works: Sequence[Callable[[], Any]]) -> None:
    global _works
    _works = works


def _made(number: int) -> Any:
    return _works[number]()
