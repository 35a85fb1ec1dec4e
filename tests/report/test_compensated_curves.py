"""Pictures of a manoeuvre before and after compensation."""

from __future__ import annotations

from stages.report.sections import compensation
from tests.report import synthetic


def test_the_picture_of_a_rest_ends_where_the_rest_does() -> None:
    """A stretch of the log whose extremes are those of the turn after it is none of the rest."""
    tables = synthetic.campaign(logs=("x-up.asc",))
    traces, segments = tables["traces"], tables["segments"]
    last = traces.index[-1]
    own = segments["manoeuvre"] == "x-up"
    middle = int(traces.loc[last, ["from_record", "to_record"]].mean())
    segments.loc[own, "to_record"] = middle
    traces.loc[last, "most_gyro_z"] = tables["compensated_traces"].loc[last, "most_gyro_z"] = 0.7
    made = synthetic.tables_of(tables)
    [plan] = [row for row in made.rows("manoeuvres") if row["manoeuvre"] == "x-up"]
    drawn = compensation.curves_of(made, plan)
    assert drawn is not None
    assert drawn.curves["gyro_z"].most.max() < 0.01  # rad/s; noise
    assert len(drawn.x) > 100
