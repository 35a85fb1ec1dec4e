"""Where a number comes from, as the page tells it: stage, settings, and the lines of the logs."""

import numpy as np
import pandas as pd

from stages.report.origins import origins
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
