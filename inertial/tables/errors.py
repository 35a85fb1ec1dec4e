"""How the pipeline says that an input cannot be used."""

from dataclasses import dataclass


@dataclass(eq=False)  # an exception must stay hashable and take its traceback
class Refusal(Exception):  # noqa: N818 (a refusal is what it is, not what went wrong)
    """An input that cannot be used: where it is, what it says, what is allowed, what to do."""

    file: str
    place: str  # a line, a key, or both; empty where it is the whole file
    found: str
    expected: str
    cure: str

    def __str__(self) -> str:
        where = f"{self.file}, {self.place}" if self.place else self.file
        parts = {"found": self.found, "expected": self.expected, "cure": self.cure}
        return "\n".join([where, *(f"  {name + ':':<9} {text}" for name, text in parts.items())])
