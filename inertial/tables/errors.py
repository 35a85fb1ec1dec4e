"""How the pipeline says that an input cannot be used."""

from dataclasses import dataclass

from inertial.text.messages import _


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


def no_permission(error: PermissionError) -> Refusal:
    """A file or folder that the user may not read, or not write."""
    return Refusal(
        str(error.filename),
        "",
        _("no permission to read or to write it"),
        _("a file that this user may read, in a folder that he may write to"),
        _("have its owner allow it: chmod u+rw, or g+rw and a group; or copy it elsewhere"),
    )
