"""Where a number comes from, as the page tells it: stage, settings, and the lines of the logs."""

from types import SimpleNamespace

import numpy as np
import pandas as pd

from inertial.text.statements import NO_TABLE
from stages.report.results import origins
from stages.report.sections.basis import known_parts
from tests.report import synthetic
from tests.report.synthetic_values import Held


def test_the_lines_of_a_turn_are_those_of_its_samples():
    """Five lines of header: record 10 stands in line 16. Line 20 was refused."""
    made = synthetic.brief()
    block = {"log": "x-forward.asc", "manoeuvre": "x-forward", "phase": "steady", "count": 10.0}
    made["blocks"] = pd.DataFrame(
        [block | {"from_record": first, "to_record": first + 10} for first in (10, 20)]
    )
    lines = np.delete(np.arange(6, 46), 14)
    made["samples"] = Held(
        pd.DataFrame(
            {
                "log": "x-forward.asc",
                "record": lines - 6,
                "line": lines,
                "offset": 100 * (lines - 1),
                "time": lines / 100,
            }
        )
    )
    said = " ".join(origins(synthetic.tables_of(made))["accelerometer/joint"])
    assert "x-forward: x-forward.asc, lines 16–35" in said
    assert "Estimated by stage accelerometer" in said


def test_a_quantity_that_the_plan_does_not_use_is_not_listed():
    """By hand no table has a rate, and nothing turns by a set angle."""
    rows = [
        {"quantity": "gravity", "value": 9.8, "sigma": 0.03, "unit": "m/s²", "origin": "stated"},
        {"quantity": "turn_rate", "value": 0.0, "sigma": 1e-3, "unit": "1", "origin": NO_TABLE},
    ]
    (table,) = known_parts(SimpleNamespace(rows=lambda _: [row | {"assumed": 0} for row in rows]))
    assert [row.cells[0] for row in table.rows] == ["gravity"]
