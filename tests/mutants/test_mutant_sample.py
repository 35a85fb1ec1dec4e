"""Some faults in the physics, put into a copy of the tree: a test sees each; all: make mutants."""

import pytest
from mutant_runs import ROOT, killed
from mutants_page import HERE
from mutations import mutations
from ruamel.yaml import YAML

SAMPLE = YAML(typ="safe").load(HERE / "sample.yaml")


@pytest.mark.parametrize("fault", SAMPLE, ids=lambda one: f"{one['file']} {one['before']}")
def test_a_test_sees_the_fault(fault):
    source = (ROOT / fault["file"]).read_bytes()
    (mutation, *_same) = (
        one
        for one in mutations(source)
        if (one.before, one.after) == (fault["before"], fault["after"])
    )
    seen = killed(fault["file"], mutation, [fault["test"]], 120)
    assert seen is not None and seen.startswith(fault["test"])
