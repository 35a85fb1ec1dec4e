"""The machine and the versions that a result was measured with."""

import os
import platform
from datetime import UTC, datetime
from importlib.metadata import version

from benchmarks.processes import in_peers

OWN = ("numpy", "scipy", "pandas", "pyarrow")
PEERS = ("imucal", "allantools", "novatel-edie", "numpy", "pandas", "pyarrow")


def described() -> list[str]:
    """Date, machine and versions, as items of a list."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count()
    load = os.getloadavg()[0]
    own = ", ".join(f"{name} {version(name)}" for name in OWN)
    peers = in_peers("versions", *PEERS)
    return [
        f"- Date: {datetime.now(UTC):%Y-%m-%d %H:%M} UTC",
        f"- Machine: {platform.machine()}, {platform.system()}, {cores} processors,"
        f" load before the start {load:.1f}",
        f"- Here: Python {platform.python_version()}, {own}; one thread of OpenBLAS",
        "- Peers: " + ", ".join(f"{name} {peers[name]}" for name in PEERS),
    ]
