"""Faults are applied to empty logs first, to find those of logs and lines that do not exist."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from laboratory.checking import joined
from laboratory.errors import Complaint
from laboratory.faults.fault import ALL, Fault
from laboratory.records import Records


def rehearse(faults: Sequence[Fault], logs: Mapping[str, Records]) -> Iterator[Complaint]:
    """What is wrong with faults that are applied in order; `logs`: of the right lengths.

    A fault that is refused is not applied, so that those after it are still checked.
    """
    generators = {log: np.random.default_rng(0) for log in logs}  # their numbers do not matter
    lengths = {log: len(records) for log, records in logs.items()}
    for index, fault in enumerate(faults):
        place = f"faults[{index}].{fault.name}"
        wrong = list(unknown(fault, place, logs)) or list(out_of_reach(fault, place, logs, lengths))
        yield from wrong
        if not wrong:
            logs = fault.apply(logs, generators)


def unknown(fault: Fault, place: str, logs: Mapping[str, Records]) -> Iterator[Complaint]:
    """Logs that the plan does not have."""
    key = "log" if len(fault.logs) == 1 else "logs"
    for log in fault.logs:
        if log != ALL and log not in logs:
            expected = "a log of the plan: " + ", ".join(logs)
            yield Complaint(joined(place, key), log, expected)


def out_of_reach(
    fault: Fault, place: str, logs: Mapping[str, Records], before: Mapping[str, int]
) -> Iterator[Complaint]:
    """Lines that a log does not have; `before`: its number of lines before any fault."""
    for log, records in logs.items():
        if (log in fault.logs or ALL in fault.logs) and fault.last_line > len(records):
            then = "" if len(records) == before[log] else " after the faults before this one"
            expected = f"lines of {log}, which has {len(records)}{then}"
            yield Complaint(place, f"lines up to {fault.last_line}", expected)
