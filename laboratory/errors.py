"""Errors of a specification."""

from typing import NamedTuple


class Complaint(NamedTuple):
    """One thing wrong with a specification."""

    place: str  # the key, from the top of the file: "plan[3].rate_deg_s"
    found: str
    expected: str

    def __str__(self) -> str:
        return f"{self.place}: found {self.found}; expected {self.expected}"


class SpecificationError(ValueError):
    """A specification that the laboratory refuses: file, key, what was found, what is expected."""

    def __init__(self, source: str, *complaints: Complaint) -> None:
        self.source = source
        self.complaints = complaints
        super().__init__("\n".join(f"{source}: {complaint}" for complaint in complaints))
