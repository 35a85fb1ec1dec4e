"""The table's encoder beside the IMU: every sample gets the table's angle."""

import json
import math
from pathlib import Path

import pyarrow as pa
import pytest
from decoded_logs import SPAN_CPT, at

from inertial.tables import LOGS
from stages.decode.stage import decode

ENCODER = {
    "kind": "columns",
    "time": {"column": 1, "unit": "s"},
    "table_angle": {"column": 2, "unit": "deg"},
}


def with_encoder(layout: dict, readings: list[tuple[float, float]], folder: Path, **told) -> Path:
    """The layout of an IMU's log with the encoder's beside it, and that log."""
    path = folder / "table.txt"
    path.write_text("".join(f"{time:.6f} {angle:.6f}\n" for time, angle in readings))
    layout["encoder"] = {"file": path.name, "layout": ENCODER, "gps_week": None, "offset": 0.0}
    layout["encoder"] |= told
    return path


def turned(path: Path, layout: dict, table: Path) -> list[float | None]:
    """The table's angle at the samples, degrees."""
    rows = [{"log": "log", "file": path.name, "layout": json.dumps(layout)}]
    stream = [pa.RecordBatch.from_pylist(rows, LOGS.schema)]
    found, accounted = [], {}
    for name, batch in decode(stream, [path, table]):
        for row in batch.to_pylist():
            if name == "samples":
                angle = row["table_angle"]
                found.append(None if angle is None else math.degrees(angle))
            if name == "accounts":
                accounted[row["log"]] = accounted.get(row["log"], 0) + row["bytes"]
    assert accounted == {"log": path.stat().st_size, table.name: table.stat().st_size}
    return found


def test_the_encoder_s_angle_goes_on_over_a_turn_and_stops_in_its_gaps(tmp_path):
    path = tmp_path / "log.txt"
    path.write_text("".join(f"{100 + 0.05 * k:.2f} 0 0 1\n" for k in range(60)))
    layout = {
        "kind": "columns",
        "time": {"column": 1, "unit": "s"},
        "gyro": {"columns": [2, 3, 4], "unit": "deg/s"},
    }
    # At 200 °/s from 100.5 s on, modulo 360; without readings from 102.0 s to 102.4 s.
    times = [100.5 + 0.02 * k for k in range(110)]
    readings = [(t, 200 * (t - 100.5) % 360) for t in times if not 102.0 < t < 102.4]
    found = turned(path, layout, with_encoder(layout, readings, tmp_path))
    for k, angle in enumerate(found):
        time = 100 + 0.05 * k
        if time < 100.49 or 102.01 < time < 102.39 or time > times[-1]:
            assert angle is None
        elif time < 101.99 or time > 102.41:
            assert angle == pytest.approx(200 * (time - 100.5), abs=1e-3)


def test_the_encoder_beside_a_receiver_counts_seconds_of_a_gps_week(tmp_path):
    path = tmp_path / "log.asc"
    path.write_bytes(b"".join(at(2283, 42699 + 0.01 * k) for k in range(50)))
    layout = SPAN_CPT | {}
    readings = [(42698.5 + 0.1 * k, 10.0 * 0.1 * k) for k in range(20)]
    table = with_encoder(layout, readings, tmp_path, gps_week=2283, offset=0.25)
    found = turned(path, layout, table)
    assert found == pytest.approx([10 * (0.25 + 0.01 * k) for k in range(50)], abs=1e-5)
