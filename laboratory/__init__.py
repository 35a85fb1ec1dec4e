"""The simulated laboratory: an IMU on a turntable, hidden effects, logs to the byte.

    recording = perform(read("data/simulated/demo.yaml"))
    write(recording, Path("data/raw/demo"))

It shares no code with stages/ and inertial/, so that hiding effects is independent of detecting
them.
"""

from laboratory.errors import Complaint, SpecificationError
from laboratory.folder import write
from laboratory.performance import perform
from laboratory.recording import LogTruth, Recording, Spoiled
from laboratory.specification import Specification, read, specify

__all__ = [
    "Complaint",
    "LogTruth",
    "Recording",
    "Specification",
    "SpecificationError",
    "Spoiled",
    "perform",
    "read",
    "specify",
    "write",
]
