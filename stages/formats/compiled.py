"""Loops over the bytes of a log, compiled where they are first run and kept for the next run."""

import hashlib
from collections.abc import Callable
from pathlib import Path
from typing import TypeVar, cast

import numba

HERE = Path(__file__).parent

Loop = TypeVar("Loop", bound=Callable[..., object])


def _state() -> str:
    """A word for what all files beside this one say."""
    sources = (path.read_bytes() for path in sorted(HERE.glob("*.py")))
    return hashlib.sha256(b"\0".join(sources)).hexdigest()[:16]


# A loop that is kept does not notice when one that it calls changes, in a file of its own. So each
# state of the files has a folder of its own.
numba.config.CACHE_DIR = str(HERE / "__pycache__" / _state())  # type: ignore[attr-defined]


# The arrays of a loop are its caller's, and it makes none. So it need not count who holds them,
# which takes a sixth of the time; numba compiles loops of its own so.
_LENT = {"nogil": True, "_nrt": False}


def compiled(loop: Loop) -> Loop:
    """The same, as machine code; it may run beside other threads.

    An index may be negative and then counts from the end, which is looked for at every byte. So
    each loop first returns where its place is negative, though it never is: so the compiler knows,
    and the loop takes two thirds of the time.
    """
    return cast(Loop, numba.njit(cache=True, **_LENT)(loop))  # type: ignore[call-overload]


def inlined(loop: Loop) -> Loop:
    """The same, compiled into every loop that calls it: to call it takes as long as it does."""
    return cast(Loop, numba.njit(inline="always", **_LENT)(loop))  # type: ignore[call-overload]
