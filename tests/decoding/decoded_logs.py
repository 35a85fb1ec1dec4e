"""Logs of a few samples, and what the stage decode makes of them, by log and column."""

import json
import math
import zlib
from pathlib import Path

import pyarrow as pa

from inertial.tables import ACCOUNTS, CHANNELS, CLOCKS, IMU_TYPES, LOGS, REFUSED, SAMPLES
from stages.decode.stage import decode

S0_FIRST = b"2283,42699.880;2283,42699.879998762,00000077,64188,-64,465,-16100,-2,873"
S0_SECOND = b"2283,42711.860;2283,42711.859998756,00000077,64186,-1,432,-16100,4,-1037"
SPAN_CPT = {
    "kind": "rawimus",
    "axes": {sensor: ["z", "-y", "x"] for sensor in ("accel", "gyro")},
    "gyro_count": 0.1 / (3600 * 256),  # rad
    "accelerometer_count": 0.05 / 2**15,  # m/s
}
DEGREE = math.pi / 180
G = 9.80665


def signed(text: bytes) -> bytes:
    text = b"RAWIMUSA," + text
    return b"%%%b*%08x\n" % (text, zlib.crc32(text, 0xFFFFFFFF) ^ 0xFFFFFFFF)


def at(week: int, seconds: float, counts: str = "0,0,0,0,0,0") -> bytes:
    return signed(f"{week},{seconds:.3f};{week},{seconds:.9f},00000077,{counts}".encode())


def decoded(*logs: tuple[str, Path, dict]) -> dict[str, dict[str, dict[str, list]]]:
    """Each table by log and column."""
    rows = [
        {"log": log, "file": path.name, "layout": json.dumps(layout)} for log, path, layout in logs
    ]
    half = len(rows) // 2  # a stream has more than one batch
    stream = [pa.RecordBatch.from_pylist(some, LOGS.schema) for some in (rows[:half], rows[half:])]
    tables = {
        "samples": SAMPLES,
        "refused": REFUSED,
        "accounts": ACCOUNTS,
        "clocks": CLOCKS,
        "imu_types": IMU_TYPES,
    }
    found = {
        name: {log: {column.name: [] for column in table.columns} for log, *_ in logs}
        for name, table in tables.items()
    }
    for name, batch in decode(stream, list({path for _, path, _ in logs})):
        assert batch.schema == tables[name].schema
        batch.validate(full=True)
        tables[name].arrow(batch)  # no gaps that the contract does not allow
        for row in batch.to_pylist():
            for column, value in row.items():
                found[name][row["log"]][column].append(value)
    for log, path, _ in logs:
        assert sum(found["accounts"][log]["bytes"]) == path.stat().st_size
    return found


def one(path: Path, layout: dict) -> dict[str, dict[str, list]]:
    """The tables of one log."""
    return {name: table["log"] for name, table in decoded(("log", path, layout)).items()}


def channels(samples: dict[str, list], row: int) -> list[float]:
    return [samples[channel][row] for channel in CHANNELS]
