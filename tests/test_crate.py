"""The Workflow Run RO-Crate of a campaign: what its profiles, version 0.5, demand (MUST).

roc-validator 0.13 fetches contexts from the network; what it found is held here.
"""

import hashlib
import json
import os
import shutil
import zipfile
from collections.abc import Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from test_rules import CAMPAIGN, DERIVED, RULES, writes

from commands.crate import main
from inertial.tables.parquet import provenance

START = 1_790_000_000  # s since 1970, of the first stage
LASTED, EACH = 2.5, 10  # s, of a stage, and from one to the next


@pytest.fixture(scope="module")
def packed(whole: Path, tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """The crate of a folder whose stages ended at times that are known."""
    folder = tmp_path_factory.mktemp("crate")
    shutil.copytree(whole, folder, dirs_exist_ok=True)
    for place, rule in enumerate(RULES):
        measured = folder / DERIVED / rule / "benchmark.tsv"
        measured.parent.mkdir(exist_ok=True)
        measured.write_text(f"s\th:m:s\n{LASTED}\t0:00:02\n")
        end = START + EACH * place + LASTED
        os.utime(measured, (end, end))
    assert main(["--campaign", CAMPAIGN, "--data", str(folder / "data")]) == 0
    assert not list(folder.rglob("*.part"))
    return zipfile.ZipFile(folder / f"reports/{CAMPAIGN}.crate.zip")


@pytest.fixture(scope="module")
def graph(packed: zipfile.ZipFile) -> dict[str, dict[str, Any]]:
    metadata = json.loads(packed.read("ro-crate-metadata.json"))
    assert metadata["@context"][0] == "https://w3id.org/ro/crate/1.1/context"
    return {entity["@id"]: entity for entity in metadata["@graph"]}


def ids(value: Any) -> list[str]:
    """What a property refers to."""
    return [one["@id"] for one in (value if isinstance(value, list) else [value])]


def of_type(graph: dict[str, dict[str, Any]], kind: str) -> Iterator[dict[str, Any]]:
    for entity in graph.values():
        if kind in ([of] if isinstance(of := entity["@type"], str) else of):
            yield entity


def test_root_and_workflow_are_as_ro_crate_has_them(graph: dict[str, dict[str, Any]]) -> None:
    descriptor, root = graph["ro-crate-metadata.json"], graph["./"]
    assert ids(descriptor["about"]) == ["./"]
    assert "https://w3id.org/ro/crate/1.1" in ids(descriptor["conformsTo"])
    for profile in ("process", "workflow", "provenance"):
        assert f"https://w3id.org/ro/wfrun/{profile}/0.5" in ids(root["conformsTo"])
    assert "https://w3id.org/workflowhub/workflow-ro-crate/1.0" in ids(root["conformsTo"])
    assert {"name", "description", "datePublished", "license"} <= set(root)
    (main_entity,) = ids(root["mainEntity"])
    workflow = graph[main_entity]
    assert {"File", "SoftwareSourceCode", "ComputationalWorkflow"} <= set(workflow["@type"])
    assert graph[ids(workflow["programmingLanguage"])[0]]["name"] == "Snakemake"


def test_what_is_referred_to_is_there(
    graph: dict[str, dict[str, Any]], packed: zipfile.ZipFile, whole: Path
) -> None:
    for entity in graph.values():
        for name, value in entity.items():
            for one in value if isinstance(value, list) else [value]:
                if isinstance(one, dict) and "://" not in one["@id"]:
                    assert one["@id"] in graph, (entity["@id"], name)
    files = {place for place in packed.namelist() if place != "ro-crate-metadata.json"}
    assert {entity["@id"] for entity in of_type(graph, "File")} == files
    assert set(ids(graph["./"]["hasPart"])) == files
    made = {place for rule in RULES for place in writes(rule)}
    raw = {str(path.relative_to(whole)) for path in (whole / "data/raw").rglob("*.*")}
    own = {"Snakefile", "config.yaml", "requirements.lock", "README.md"}
    assert files == made | raw | own
    for place in raw:
        content = packed.read(place)
        assert content == (whole / place).read_bytes()
        assert graph[place]["sha256"] == hashlib.sha256(content).hexdigest()
        assert int(graph[place]["contentSize"]) == len(content)


def test_the_run_takes_the_logs_and_gives_all_that_was_made(
    graph: dict[str, dict[str, Any]],
) -> None:
    (run,) = (
        one for one in of_type(graph, "CreateAction") if one["instrument"]["@id"] == "Snakefile"
    )
    assert set(ids(run["object"])) == {name for name in graph if name.startswith("data/raw/")}
    assert set(ids(run["result"])) == {place for rule in RULES for place in writes(rule)}
    workflow = graph["Snakefile"]
    for way, files in (("input", run["object"]), ("output", run["result"])):
        for name in ids(files):
            assert set(ids(graph[name]["exampleOfWork"])) <= set(ids(workflow[way]))
        for parameter in ids(workflow[way]):
            assert graph[parameter]["@type"] == "FormalParameter"
            assert graph[parameter]["additionalType"] == "File"
    assert {one["@id"] for one in of_type(graph, "CreateAction")} <= set(
        ids(graph["./"]["mentions"])
    )


def test_each_stage_is_a_step_with_its_tool_its_time_and_its_tables(
    graph: dict[str, dict[str, Any]], whole: Path
) -> None:
    workflow = graph["Snakefile"]
    (organised,) = of_type(graph, "OrganizeAction")
    assert graph[ids(organised["instrument"])[0]]["name"] == "Snakemake"
    assert ids(organised["result"]) == ["#action-run"]
    controls = {one["@id"]: one for one in of_type(graph, "ControlAction")}
    assert set(ids(organised["object"])) == set(controls)
    of_step = {ids(one["instrument"])[0]: ids(one["object"])[0] for one in controls.values()}
    steps = list(of_type(graph, "HowToStep"))
    assert [one["name"] for one in sorted(steps, key=lambda one: int(one["position"]))] == RULES
    assert {one["@id"] for one in steps} == set(ids(workflow["step"])) == set(of_step)
    for place, rule in enumerate(RULES):
        step = next(one for one in steps if one["name"] == rule)
        action, tool = graph[of_step[step["@id"]]], graph[ids(step["workExample"])[0]]
        assert ids(action["instrument"]) == [tool["@id"]]
        assert tool["@id"] in ids(workflow["hasPart"])
        assert set(ids(action["result"])) == set(writes(rule))
        start, end = (datetime.fromisoformat(action[f"{of}Time"]) for of in ("start", "end"))
        assert start == datetime.fromtimestamp(START + EACH * place, UTC)
        assert (end - start).total_seconds() == LASTED
        tables = [name for name in writes(rule) if name.endswith(".parquet")]
        if tables:  # which say themselves what they were made from
            made = provenance(whole / tables[0])
            assert tool["softwareVersion"] == made["code"]
            read = {"/".join(name.split("/")[-2:]) for name in ids(action["object"])}
            assert {name for name in made["inputs"] if not name.startswith("data/")} <= read


def test_without_tables_it_is_refused_by_name(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "data/derived/none").mkdir(parents=True)
    assert main(["--campaign", "none", "--data", str(tmp_path / "data")]) == 2
    assert "none/plan/campaign.parquet" in capsys.readouterr().err
