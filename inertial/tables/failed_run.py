"""What the screen shows of a run that fails: what its stages said, last, and where the full log is.

How Snakemake called them, and where in the Snakefile, is in the full log.
"""

import logging
import os
from collections.abc import Iterator
from pathlib import Path

from inertial.text.messages import _
from inertial.text.numbers import visible

MAX_LINES = 30  # of a stage's log
RULE = "=" * 80
_FAILED = ("JOB_ERROR", "GROUP_ERROR")  # events of Snakemake
_CALL = "CalledProcessError"
_OTHERS = (
    "Exiting because",
    "Elapsed time",
    "At least one job did not complete",
    "Complete log(s)",
)
FULL_LOG = _("The full log: {path}")


class FailedRun(logging.Filter):
    """A filter of what Snakemake writes to the screen, which collects the logs of failed stages."""

    def __init__(self, logger: logging.Logger) -> None:
        super().__init__()
        self._logs: dict[str, str] = {}  # what Snakemake said of the call, by file of the log
        self._call = ""
        for handler in logger.handlers:
            if type(handler).__name__ == "ColorizingTextHandler":  # not that of the full log
                handler.addFilter(self)

    def filter(self, record: logging.LogRecord) -> bool:
        """Whether a record goes to the screen."""
        event = getattr(getattr(record, "event", None), "name", "")
        text = record.getMessage()
        if event in _FAILED:
            jobs = getattr(record, "job_error_info", None) or [vars(record)]
            self._logs |= {str(log): self._call for job in jobs for log in job["log"]}
            return False
        if _CALL in text:
            self._call = text.strip().splitlines()[-1]
            return False
        return not (self._logs and any(other in text for other in _OTHERS))

    def shown(self, full_log: str) -> str:
        """What each failed stage said, between two rules, and where the full log is.

        That is left to `make`, which ends with the content of the file that $ENDED names.
        """
        lines = [line for log in self._logs for line in self._box(log)]
        last = FULL_LOG.format(path=full_log)
        if lines and (ended := os.environ.get("ENDED")):
            Path(ended).write_text(last, encoding="utf-8")
        else:
            lines.append(last)
        return visible("\n".join(["", *lines, ""]))

    def _box(self, log: str) -> Iterator[str]:
        text = Path(log).read_text("utf-8", "replace") if Path(log).is_file() else ""
        lines = text.splitlines() or [self._ended(log)]
        yield log
        yield RULE
        yield from lines[-MAX_LINES:]
        yield RULE

    def _ended(self, log: str) -> str:
        status = self._logs[log].rpartition("' ")[2]
        if "137" in status or "SIGKILL" in status:
            return _("Killed without a word ({status}), as where memory is short.", status=status)
        return _("Ended without a word: {status}", status=status)
