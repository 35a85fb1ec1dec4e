"""A range of records in words: blocks, lines and bytes of the log, time, first and last line."""

from math import isnan
from pathlib import Path

from inertial.campaign.log_lines import LogLines, UsedPhase
from inertial.campaign.records import Row
from inertial.text.messages import _
from inertial.text.numbers import visible

GPS_WEEK = 604_800  # s
MAX_SHOWN_BYTES = 100  # of a line


def in_blocks(phase: UsedPhase) -> str:
    """Its blocks, samples and records, and what masks some of them."""
    masked = (
        _(", some masked by {findings}", findings=", ".join(phase.findings))
        if phase.findings
        else ""
    )
    return _(
        "{phase}: {blocks} blocks, {samples:g} samples, records {first} to {after}{masked}",
        phase=phase.phase,
        blocks=phase.blocks,
        samples=phase.samples,
        first=phase.records.first,
        after=phase.records.after - 1,
        masked=masked,
    )


def in_lines(log: Path, where: LogLines) -> str:
    """The lines and bytes of the log; rows where it is no text."""
    if not where.of_text:
        return _(
            "  {log}, rows {from_line} to {to_line}, {decoded} of them decoded",
            log=log,
            from_line=where.from_line,
            to_line=where.to_line,
            decoded=where.decoded,
        )
    return _(
        "  {log}, line {from_line} (from byte {from_byte}) to line {to_line} (from byte "
        "{to_byte}), {decoded} of them decoded",
        log=log,
        from_line=where.from_line,
        from_byte=where.from_byte,
        to_line=where.to_line,
        to_byte=where.to_byte,
        decoded=where.decoded,
    )


def in_time(where: LogLines, clock: Row) -> str:
    """The time span; for GPS also as week and seconds, as the lines state it."""
    if isnan(where.from_s):
        return _("  without time")
    epoch = clock.get("epoch_gps")
    origin = _("the log's first sample") if epoch is None else _("the campaign's first sample")
    span = _(
        "  {from_s:.3f} s to {to_s:.3f} s since {origin}",
        from_s=where.from_s,
        to_s=where.to_s,
        origin=origin,
    )
    if epoch is not None:
        week, start = divmod(epoch + where.from_s, GPS_WEEK)
        span += _(
            "; GPS week {week:.0f}, {start:.3f} s to {start_2:.3f} s",
            week=week,
            start=start,
            start_2=start + where.to_s - where.from_s,
        )
    return span


def first_and_last(log: Path, where: LogLines) -> list[str]:
    """The first and the last line, as they stand in the log."""
    ends = {where.from_line: where.from_byte, where.to_line: where.to_byte}
    if not log.is_file() or not where.of_text:
        return []
    texts = []
    with log.open("rb") as file:
        for line, byte in ends.items():
            file.seek(byte)
            text = file.readline(MAX_SHOWN_BYTES).decode("utf-8", "backslashreplace")
            texts.append(f"  line {line}: " + visible(text.rstrip("\r\n")))
    return texts
