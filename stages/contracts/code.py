"""Which files of the project a stage rests on: what reruns it, and what its hash covers."""

import ast
import hashlib
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent.parent
DATA = {".yaml", ".html", ".css"}  # schemas and templates lie beside the module that reads them


def code_of(stage: str) -> list[Path]:
    """Every file of `stages/` that `stages.<stage>` can reach by its imports, and the lock file.

    The imports are read from the text, so nothing is run. With a module come the
    schemas and templates that lie in its folder.
    """
    reached: set[Path] = set()
    waiting = ["stages", f"stages.{stage}"]
    while waiting:
        module = ROOT.joinpath(*waiting.pop().split("."))
        for file in (module.with_suffix(".py"), module / "__init__.py"):
            if file.is_file() and file not in reached:
                reached.add(file)
                waiting += _imports(file)
    beside = {
        file
        for folder in {module.parent for module in reached} - {ROOT / "stages"}
        for file in folder.iterdir()
        if file.suffix in DATA
    }
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
def _imports(file: Path) -> list[str]:
    names = []
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names += [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
    parts = [name.split(".") for name in names if name.partition(".")[0] == "stages"]
    # With a module come the packages that it lies in.
    return sorted({".".join(part[:end]) for part in parts for end in range(1, len(part) + 1)})
