"""Iteration with the next items made in a thread while the current one is used."""

from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Item = TypeVar("Item")
_END = object()
_DEPTH = 2  # with one, producer and consumer wait for each other wherever items differ in size


def prefetched(items: Iterator[Item]) -> Iterator[Item]:
    """The same items; the next ones are made in a thread while the current one is used."""
    with ThreadPoolExecutor(1) as thread:
        pending = deque(thread.submit(next, items, _END) for _ in range(_DEPTH))
        while (item := pending.popleft().result()) is not _END:
            pending.append(thread.submit(next, items, _END))
            yield item  # type: ignore[misc]
