"""Which files a stage rests on: all that it reaches by its imports, and nothing else."""

from __future__ import annotations

from pathlib import Path

import grimp
import pytest

from inertial.tables import code
from inertial.tables.code import ROOT, code_of, hash_of

PROJECT = {
    "requirements.lock": "numpy==2",
    "laboratory/__init__.py": "",
    "stages/__init__.py": "",
    "stages/weigh.py": "import numpy\nfrom stages.scales import beam\n",
    "stages/unrelated.py": "import stages.scales.unused\n",
    "stages/scales/__init__.py": "",
    "stages/scales/beam.py": "def f():\n    import stages.masses.kilogram as k\n",
    "stages/scales/unused.py": "",
    "stages/scales/scales.schema.yaml": "",
    "stages/scales/page.html": "",
    "stages/scales/notes.txt": "",
    "stages/masses/__init__.py": "from stages.masses.gram import GRAM\n",
    "stages/masses/kilogram.py": "",
    "stages/masses/gram.py": "",
    "stages/figures/__init__.py": "",
    "stages/figures/style.css": "",
}
REACHED = {
    "requirements.lock",
    "stages/__init__.py",
    "stages/weigh.py",
    "stages/scales/__init__.py",
    "stages/scales/beam.py",
    "stages/scales/scales.schema.yaml",
    "stages/scales/page.html",
    "stages/masses/__init__.py",
    "stages/masses/kilogram.py",  # imported by what weigh imports, inside a function
    "stages/masses/gram.py",  # imported by the package alone
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
    graph = grimp.build_graph("stages", cache_dir=None)
    stages = {path.stem for path in (ROOT / "stages").glob("*.py")} - {"__init__"}
    for stage in sorted(stages):
        upstream = {f"stages.{stage}", *graph.find_upstream_modules(f"stages.{stage}")}
        with_packages = {
            name.rsplit(".", cut)[0] for name in upstream for cut in range(name.count(".") + 1)
        }
        ours = {file.relative_to(ROOT) for file in code_of(stage) if file.suffix == ".py"}
        assert {_module(file) for file in ours} == with_packages, stage


def _module(file: Path) -> str:
    return ".".join(file.with_suffix("").parts).removesuffix(".__init__")
