"""Which files of the project a stage rests on: what reruns it, and what its hash covers."""

import hashlib
import re
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
# `from inertial.physics import site`, over several lines too, or `import inertial.physics`. The
# text is searched: to parse it takes longer than many a stage works.
IMPORT = re.compile(
    r"^[ \t]*(?:from|import) ((?:overviews|stages|inertial)[\w.]*)(?: import (\([^)]*\)|.*))?",
    re.MULTILINE,
)
# What only a type checker imports changes no result.
OF_TYPES = re.compile(r"^if TYPE_CHECKING:\n(?:[ \t]+.*\n|\n)+", re.MULTILINE)
# Schemas and templates lie beside the module that reads them.
DATA = {".yaml", ".json", ".html", ".css", ".js"}
TRANSLATIONS = "inertial/text/*.po"
SPEAKS = 'documents=("html"'  # stands in declared.py of a stage that speaks other languages


def code_of(stage: str, package: str = "stages") -> list[Path]:
    """Every file that `python -m stages <stage>` can reach by its imports, and the lock file.

    `package`: where it lies, which for a page of several campaigns is `overviews`.

    The imports are read from the text, so nothing is run. With a module come the
    schemas and templates that lie in its folder.
    """
    reached: set[Path] = set()
    own = f"{package}.{stage}"
    waiting = [package, own, f"{package}.__main__", f"{own}.page", f"{own}.stage"]
    seen: set[str] = set()
    while waiting:
        if (module := waiting.pop()) not in seen:
            seen.add(module)
            for file in _files(ROOT, module):
                reached.add(file)
                waiting += _imports(file)
    folders = {file.parent for file in reached} - {ROOT / "stages", ROOT / "inertial"}
    beside = {file for folder in folders for file in _data(folder)}
    declared = _files(ROOT, f"{own}.declared")
    if package != "stages" or any(SPEAKS in f.read_text(encoding="utf-8") for f in declared):
        beside |= set(ROOT.glob(TRANSLATIONS))
    return sorted(reached | beside | {ROOT / "requirements.lock"})


def hash_of(files: list[Path]) -> str:
    """SHA-256 over the names and contents of `files`."""
    digest = hashlib.sha256()
    for file in files:
        digest.update(f"{file.relative_to(ROOT)}\n".encode() + file.read_bytes())
    return digest.hexdigest()


def hash_of_file(path: Path) -> str:
    """SHA-256 of one file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@cache
def _files(root: Path, module: str) -> list[Path]:
    path = root.joinpath(*module.split("."))
    return [file for file in (path.with_suffix(".py"), path / "__init__.py") if file.is_file()]


@cache
def _data(folder: Path) -> list[Path]:
    return [file for file in folder.iterdir() if file.suffix in DATA]


@cache
def _imports(file: Path) -> list[str]:
    names = []
    text = OF_TYPES.sub("", file.read_text(encoding="utf-8"))
    for module, imported in IMPORT.findall(text):
        names += [module, *(f"{module}.{name}" for name in re.findall(r"\w+", imported))]
    parts = [name.split(".") for name in names]
    # With a module come the packages that it lies in.
    return sorted({".".join(part[:end]) for part in parts for end in range(1, len(part) + 1)})
