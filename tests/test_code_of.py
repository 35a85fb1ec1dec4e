"""Which files a stage rests on: all that it reaches by its imports, and nothing else."""

from __future__ import annotations

from pathlib import Path

import grimp
import pytest

from inertial.tables import code
from inertial.tables.code import ROOT, code_of, hash_of
from stages import ORDER

PROJECT = {
    "requirements.lock": "numpy==2",
    "laboratory/__init__.py": "",
    "stages/__init__.py": "",
    "inertial/__init__.py": "",
    "stages/weigh/__init__.py": "",
    "stages/__main__.py": "",
    "stages/weigh/stage.py": "import numpy\nfrom inertial.scales import beam\n"
    "if TYPE_CHECKING:\n    from inertial.masses import ounce\n\nWEIGHT = 1\n",
    "stages/unrelated/stage.py": "import inertial.scales.unused\n",
    "inertial/scales/__init__.py": "",
    "inertial/scales/beam.py": "def f():\n    import inertial.masses.kilogram as k\n",
    "inertial/scales/unused.py": "",
    "inertial/scales/scales.schema.yaml": "",
    "inertial/scales/page.html": "",
    "inertial/scales/notes.txt": "",
    "inertial/masses/__init__.py": "from inertial.masses.gram import GRAM\n",
    "inertial/masses/kilogram.py": "",
    "inertial/masses/gram.py": "",
    "inertial/masses/ounce.py": "",
    "inertial/figures/__init__.py": "",
    "inertial/figures/style.css": "",
}
REACHED = {
    "requirements.lock",
    "stages/__init__.py",
    "inertial/__init__.py",
    "stages/weigh/__init__.py",
    "stages/__main__.py",
    "stages/weigh/stage.py",
    "inertial/scales/__init__.py",
    "inertial/scales/beam.py",
    "inertial/scales/scales.schema.yaml",
    "inertial/scales/page.html",
    "inertial/masses/__init__.py",
    "inertial/masses/kilogram.py",  # imported by what weigh imports, inside a function
    "inertial/masses/gram.py",  # imported by the package alone
}


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    for name, text in PROJECT.items():
        file = tmp_path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    monkeypatch.setattr(code, "ROOT", tmp_path)
    return tmp_path


def test_it_is_what_the_imports_reach_with_packages_schemas_and_templates(project: Path) -> None:
    assert {str(file.relative_to(project)) for file in code_of("weigh")} == REACHED


@pytest.mark.parametrize("name", sorted(PROJECT))
def test_the_hash_changes_with_these_files_and_no_other(project: Path, name: str) -> None:
    before = hash_of(code_of("weigh"))
    (project / name).write_text(f"{PROJECT[name]}# changed\n")
    assert (hash_of(code_of("weigh")) != before) == (name in REACHED)


def test_it_agrees_with_the_import_graph_of_grimp() -> None:
    graph = grimp.build_graph(
        "stages", "inertial", cache_dir=None, exclude_type_checking_imports=True
    )
    for stage in ORDER:
        upstream: set[str] = set()
        waiting = ["stages.__main__", f"stages.{stage}.stage"]
        while waiting:  # with a module its packages are run, and what they import
            module = waiting.pop()
            if module not in upstream:
                upstream |= {module}
                waiting += graph.find_modules_directly_imported_by(module)
                waiting += [p for p in [module.rpartition(".")[0]] if p in graph.modules]
        ours = {file.relative_to(ROOT) for file in code_of(stage) if file.suffix == ".py"}
        assert {_module(file) for file in ours} == upstream, stage


def _module(file: Path) -> str:
    return ".".join(file.with_suffix("").parts).removesuffix(".__init__")
