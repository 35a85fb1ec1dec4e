"""What can go wrong with a recording after the IMU has done its work."""

from typing import Protocol

from laboratory.rawimusa import Samples


class Fault(Protocol):
    """One fault of one log."""

    @property
    def log(self) -> str:
        """The log that it spoils."""
        ...

    def spoils(self, samples: Samples) -> Samples:
        """The samples that are left to be written."""
        ...
