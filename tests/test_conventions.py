"""What users of Snakemake expect of a workflow: its layout, use as a module, description."""

import re
import subprocess
import sys
import tomllib
from importlib import metadata
from pathlib import Path

import chain
import pytest
from ruamel.yaml import YAML

from stages import ORDER

GOAL = "reports/june.html"


def snakemake(snakefile: Path, folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    where = ["--snakefile", str(snakefile), "--directory", str(folder)]
    command = [sys.executable, "-m", "snakemake", "--nolock", "--cores", "1", *where, *arguments]
    return subprocess.run(command, capture_output=True, text=True)


def planned(snakefile: Path, folder: Path, *goals: str) -> set[str]:
    done = snakemake(snakefile, folder, "--dry-run", "--", *goals)
    assert done.returncode == 0, done.stderr
    return set(re.findall(r"^(\w+) +\d+$", done.stdout + done.stderr, re.MULTILINE)) - {"total"}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("june")
    chain.simulate(chain.short(), folder / "data/raw/june")
    return folder


@pytest.mark.slow
def test_where_the_catalogue_looks_is_the_same_workflow(folder: Path) -> None:
    rules = set(ORDER) - {"export", "pdf"}
    assert planned(chain.ROOT / "workflow/Snakefile", folder, GOAL) == rules
    config = [chain.ROOT / name for name in ("config.yaml", "config/config.yaml")]
    assert config[0].samefile(config[1])


@pytest.mark.slow
def test_another_workflow_uses_it_as_a_module(folder: Path) -> None:
    other = folder / "Snakefile"
    other.write_text(
        f"""
module calibration:
    snakefile:
        "{chain.ROOT}/Snakefile"


use rule * from calibration exclude all as calibration_*


rule summary:
    default_target: True
    input:
        "data/derived/june/plan/manoeuvres.parquet",
    output:
        "rows.txt",
    run:
        import pyarrow.parquet

        Path(output[0]).write_text(str(pyarrow.parquet.read_metadata(input[0]).num_rows))
"""
    )
    done = snakemake(other, folder)
    assert done.returncode == 0, done.stderr
    assert (folder / "rows.txt").read_text() == "12"
    assert planned(other, folder, GOAL) == {
        f"calibration_{stage}" for stage in set(ORDER) - {"plan", "export", "pdf"}
    }


def test_no_stage_loads_what_takes_longer_than_it_runs() -> None:
    """scipy.signal loads scipy.stats, and one line in the physics had every stage load both."""
    modules = ", ".join(f"stages.{stage}.stage" for stage in ORDER)
    loaded = f"import sys, {modules}; print({{'scipy.stats', 'scipy.signal'}} & {{*sys.modules}})"
    done = subprocess.run([sys.executable, "-c", loaded], capture_output=True, cwd=chain.ROOT)
    assert done.stdout.decode().strip() == "set()", done.stderr.decode()


def test_the_citation_is_that_of_this_version() -> None:
    citation = YAML(typ="safe").load(chain.ROOT / "CITATION.cff")
    project = tomllib.loads((chain.ROOT / "pyproject.toml").read_text())["project"]
    assert citation["version"] == project["version"]
    assert {"cff-version", "message", "title", "authors"} <= set(citation)


def test_containers_install_the_lock_file_and_the_packages_of_make() -> None:
    makefile = (chain.ROOT / "Makefile").read_text()
    (packages,) = re.findall(r"^PANGO := (.*)$", makefile, re.MULTILINE)
    for name in ("Containerfile", "apptainer.def"):
        text = (chain.ROOT / "containers" / name).read_text()
        assert f"--no-install-recommends {packages}" in text
        assert re.search(r"--require-hashes -r \S+/requirements\.lock", text)
        assert "python:3.11-slim-bookworm" in text


def test_the_lock_file_names_the_extras_that_packages_ask_for() -> None:
    """Before 23.3 pip takes `coverage[toml]` for another package than the one that is pinned."""
    lock = (chain.ROOT / "requirements.lock").read_text()
    pinned = set(re.findall(r"^([\w.-]+)", lock, re.MULTILINE))
    wanted = {
        extras[0].lower()
        for package in pinned & {d.name.lower() for d in metadata.distributions()}
        for requirement in metadata.requires(package) or ()
        if "extra ==" not in requirement
        and (extras := re.match(r"[\w.-]+\[\w+\]", requirement))
        and "sys_platform" not in requirement
    }
    assert "coverage[toml]" in wanted
    assert wanted <= set(re.findall(r"^([\w.-]+\[\w+\])==", lock, re.MULTILINE))
