"""Times on a shared machine: several runs, of which the best and the median are given."""

import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from statistics import median
from typing import Any, Self


@dataclass(frozen=True)
class Seconds:
    """Elapsed times of the runs of the same work, s, and their processor times."""

    runs: Sequence[float]
    cpu: Sequence[float]

    @classmethod
    def answered(cls, answers: Iterable[Mapping[str, Any]]) -> Self:
        """The runs in the answers of some processes."""
        together = list(answers)
        runs = [run for one in together for run in one["seconds"]]
        return cls(runs, [run for one in together for run in one["cpu"]])

    @classmethod
    def together(cls, some: Iterable[Self]) -> Self:
        """All runs as one."""
        every = list(some)
        runs = [run for one in every for run in one.runs]
        return cls(runs, [run for one in every for run in one.cpu])

    @property
    def best(self) -> float:
        """The shortest run: the time of the undisturbed work."""
        return min(self.runs)

    def cells(self) -> tuple[str, str]:
        """Best, median and longest run; shortest time of the processors."""
        times = (self.best, median(self.runs), max(self.runs))
        return " / ".join(_digits(run) for run in times), _digits(min(self.cpu))


HEADS = ("time\ns", "processor\ns")
REMARK = "Time: best / median / longest run; processor: least of all runs, of all its threads."


def timed(work: Callable[[], object], runs: int) -> Seconds:
    """Do some work a number of times."""
    seconds, cpu = [], []
    for _ in range(runs):
        start, worked = time.perf_counter(), time.process_time()
        work()
        cpu.append(time.process_time() - worked)
        seconds.append(time.perf_counter() - start)
    return Seconds(seconds, cpu)


def _digits(seconds: float) -> str:
    return f"{seconds:.4f}" if seconds < 0.1 else f"{seconds:.2f}"
