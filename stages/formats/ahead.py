"""The next pieces of a log are read while the one before is worked on."""

from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
_END = object()
_WAITING = 2  # with one, who makes and who uses wait for each other wherever pieces differ


def ahead(items: Iterator[Item]) -> Iterator[Item]:
    """The same items; some are made in a thread of its own while the one before them is used."""
    with ThreadPoolExecutor(1) as thread:
        coming = deque(thread.submit(next, items, _END) for _ in range(_WAITING))
        while (item := coming.popleft().result()) is not _END:
            coming.append(thread.submit(next, items, _END))
            yield item  # type: ignore[misc]
