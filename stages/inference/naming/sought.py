"""What is sought: effects, each by its columns in the evidence."""

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class Sought:
    """An effect and its columns, once for every value of what is scanned.

    `candidates`: the columns of each candidate; an effect without a scan has one. `free`: no
    physical effect but a course that could be anything, such as a drift without a law; it takes
    the place of several effects that together imitate it, and no one's where one suffices.
    `between`: whether the true value of a scan may lie between two candidates.
    """

    name: str
    candidates: tuple[tuple[int, ...], ...]
    free: bool = False
    between: bool = True


def sought(
    name: str, *candidates: Sequence[int], free: bool = False, between: bool = True
) -> Sought:
    """An effect by the columns of its candidates."""
    each = tuple(tuple(int(i) for i in columns) for columns in candidates)
    return Sought(name, each, free, between)
