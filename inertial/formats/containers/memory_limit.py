"""A limit on the memory that a library may take while it reads a container.

A few bytes of a compressed file can unpack to more than any memory holds. The limit is one of the
kernel on the address space of the process (RLIMIT_AS): what a library allocates beyond it fails
there and then. It counts from the address space in use, of which pyarrow and numba reserve much.
"""

import resource
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from threading import Lock

MAX_READER_BYTES = 4 << 30

_STATM = Path("/proc/self/statm")  # its first number: pages of address space
_LOCK = Lock()  # the limit is the whole process's


@contextmanager
def limited_memory() -> Iterator[None]:
    """Limit the memory that is allocated inside; without effect where there is no /proc."""
    if not _STATM.exists():
        yield
        return
    with _LOCK:
        used = int(_STATM.read_text().split()[0]) * resource.getpagesize()
        soft, hard = resource.getrlimit(resource.RLIMIT_AS)
        set_limits = [limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY]
        limit = min([used + MAX_READER_BYTES, *set_limits])
        resource.setrlimit(resource.RLIMIT_AS, (limit, hard))
        try:
            yield
        finally:
            resource.setrlimit(resource.RLIMIT_AS, (soft, hard))
