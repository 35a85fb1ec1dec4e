"""How the pipeline says that an input cannot be used."""

from dataclasses import dataclass


@dataclass(eq=False)  # an exception must stay hashable and take its traceback
class Refusal(Exception):
    """An input that cannot be used: where it is, what it says, what is allowed, what to do."""

    file: str
    place: str  # a line, a key, or both; empty where it is the whole file
    found: str
    expected: str
    cure: str

    def __str__(self) -> str:
        where = f"{self.file}, {self.place}" if self.place else self.file
        return f"{where}\n  found:    {self.found}\n  expected: {self.expected}\n  cure:     {self.cure}"
