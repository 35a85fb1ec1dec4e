"""The logs become samples in SI units, body axes and one clock; no byte is left unaccounted for.

Nothing is repaired here. A line that cannot be trusted is refused with the reason; what the samples
themselves are worth is the business of `quality`.
"""

import json
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import pyarrow as pa

from inertial.formats.account import Account
from inertial.formats.arrow_arrays import batch_of_rows
from inertial.tables import CLOCKS, IMU_TYPES
from inertial.tables.parquet import BATCH_ROWS
from inertial.tables.stage import Stage
from stages.decode.column_log import ColumnLog
from stages.decode.declared import DECLARED
from stages.decode.decoded import (
    Decoded,
    Pieces,
    TableAngle,
    account_of,
    mean_sigma_rows,
    path_of,
    prefetched,
    refuse_grown,
    refused_rows,
    sample_rows,
)
from stages.decode.joined_log import JoinedLog, of_both_sensors
from stages.decode.no_samples import no_samples
from stages.decode.receiver_log import NO_EPOCH, ReceiverLog

AnyLog = ReceiverLog | ColumnLog | JoinedLog


def decode(logs: Iterable[pa.RecordBatch], raw: list[Path]) -> Pieces:
    """The tables that the stage declares in pieces, log after log.

    Time is GPS time since the first sample of the campaign for the logs of a receiver; for a log of
    columns it is the time since its own first sample, by a regular clock where the stamps are those
    of arrival. Increments become rates with the log's own
    sample interval; a log that has too few samples for one has no rates.

    Accelerometers and gyros with a log each are joined: `joined_log` says how.

    Raises
    ------
    Refusal
        where a log is missing, has not the columns that its layout names, or gives no sample
    """
    rows = [row for batch in logs for row in batch.to_pylist()]
    opened = [_open(row, raw) for row in rows]
    table = TableAngle.of_logs(rows, raw)
    stamps = [log.first for log in opened if isinstance(log, ReceiverLog) and log.first is not None]
    origin = min(stamps, default=0)
    of_gyros: dict[str, JoinedLog] = {}
    for log, row in zip(opened, rows, strict=True):
        size = log.path.stat().st_size
        yield from _pieces_of(log, row, origin, table)
        refuse_grown(log.path, size)
        if isinstance(log, JoinedLog) and log.gyro_path != log.path:
            of_gyros[log.gyro_path.name] = log
    for name, joined in of_gyros.items():
        yield from account_of(name, joined.gyros.account, joined.gyros.refused)
    if table is not None:
        yield from account_of(table.file, table.encoder.account, table.encoder.refused)


def _open(row: Mapping[str, str], raw: list[Path]) -> AnyLog:
    """The log of one row of the table logs."""
    layout, path = json.loads(row["layout"]), path_of(row["file"], raw)
    layout = of_both_sensors(layout, row["file"]) or layout
    if "gyro_log" in layout:
        return JoinedLog(row["log"], path, layout, path_of(layout["gyro_log"]["file"], raw))
    return (ReceiverLog if layout["kind"] == "rawimus" else ColumnLog)(row["log"], path, layout)


def _pieces_of(
    log: AnyLog, row: Mapping[str, str], origin: int, table: TableAngle | None
) -> Pieces:
    """All tables of one log."""
    account, first_refused = Account(), None
    records, to_record = 0, 0
    ends: list[float | None] = []
    imu_types: frozenset[int] = frozenset()
    for decoded, samples in prefetched(_decoded(log, origin, table)):
        account.add_account(decoded.account)
        imu_types |= decoded.imu_types
        first_refused = first_refused or next(iter(decoded.refused), None)
        yield from refused_rows(log.name, decoded.refused)
        yield from mean_sigma_rows(log.name, decoded)
        for start in range(0, len(samples), BATCH_ROWS):
            yield "samples", samples.slice(start, BATCH_ROWS)
        if len(samples):
            records += len(samples)
            to_record = samples["record"][-1].as_py() + 1
            ends = [*ends[:1], samples["time"][0].as_py(), samples["time"][-1].as_py()]
    if not records:
        raise no_samples(row["file"], json.loads(row["layout"]), account, first_refused)
    yield from account_of(log.name, account, [])
    clock = {
        "log": log.name,
        "clock": log.clock,
        **(log.epoch(origin) if isinstance(log, ReceiverLog) else NO_EPOCH),
        "began": log.began(origin, absolute=False) if log.clock == "own" else None,
        "from_s": ends[0] if ends else None,
        "to_s": ends[-1] if ends else None,
        "records": records,
        "to_record": to_record,
        "interval": log.interval,
        "interval_sigma": log.arrival and log.arrival.clock.interval_sigma,
        "stamp_scatter": log.arrival and log.arrival.clock.scatter,
        "shortest_gap": log.arrival and log.arrival.clock.shortest_gap,
    }
    yield "clocks", batch_of_rows([clock], CLOCKS.schema)
    types = [{"log": log.name, "imu_type": number} for number in sorted(imu_types)]
    yield "imu_types", batch_of_rows(types, IMU_TYPES.schema)


def _decoded(
    log: AnyLog, origin: int, table: TableAngle | None
) -> Iterator[tuple[Decoded, pa.RecordBatch]]:
    """A log, piece by piece, and the rows of the table samples."""
    for decoded in log.decoded(origin):
        if table is not None and "time" in decoded.samples:
            began = log.began(origin, absolute=table.absolute)
            decoded.samples["table_angle"] = table.at(decoded.samples["time"] + began)
        yield decoded, sample_rows(log.name, decoded.samples)


STAGE = Stage(decode, DECLARED)
