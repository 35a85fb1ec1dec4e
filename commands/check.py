"""What is wrong with a recording, before the set-up is dismantled.

    python -m commands.check --campaign demo

It reads the findings of quality and segment, which `make check` lets the workflow make first. It
ends with 0 where nothing spoils a result, with 1 where something does, and with 2 where the tables
are missing.
"""

import argparse
import sys
import textwrap
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from inertial import tables
from inertial.campaign.records import Performed, Row, performed_of, rows_of
from inertial.tables.errors import Refusal
from inertial.text.cause_names import how_grave, in_words, tally
from inertial.text.messages import _
from inertial.text.numbers import counted, shortened, visible

LINE_WIDTH = 100
MAX_FULL_FINDINGS = 20  # of further ones only the causes are listed
SPOILS_A_RESULT = 3  # severity
LABELS = {"consequence": "Consequence", "action": _("What to do")}
INDENT = " " * 4


@dataclass(frozen=True)
class Recording:
    """Findings, the worst first; what was performed of each manoeuvre; refused lines by log."""

    findings: Sequence[Row]
    performed: Sequence[Performed]
    refused: dict[str, int]

    @property
    def spoiled(self) -> bool:
        """Whether a finding spoils a result."""
        return any(row["severity"] >= SPOILS_A_RESULT for row in self.findings)


def main(arguments: Sequence[str] | None = None) -> int:
    """Print what is wrong, the worst first; the exit code."""
    parser = argparse.ArgumentParser(prog="check", description="what is wrong with a recording")
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds derived/")
    options = parser.parse_args(arguments)
    try:
        recording = recording_of(options.data / "derived" / options.campaign)
    except Refusal as refusal:
        sys.stderr.write(visible(f"check: {refusal}\n"))
        return 2
    sys.stdout.write(visible(as_text(recording, options.campaign)))
    return 1 if recording.spoiled else 0


def recording_of(derived: Path) -> Recording:
    """From the tables of a campaign.

    Raises
    ------
    Refusal
        where one of them is missing, damaged, or of another version
    """
    findings = [
        row
        for stage in ("quality", "segment")
        for row in rows_of(tables.FINDINGS.read(derived / stage / "findings.parquet"))
    ]
    performed = performed_of(tables.PERFORMED.read(derived / "segment/performed.parquet"))
    refused = {
        row["log"]: row["lines"]
        for row in rows_of(tables.ACCOUNTS.read(derived / "decode/accounts.parquet"))
        if row["kind"] == "refused"
    }
    return Recording(sorted(findings, key=_worst_first), list(performed.values()), refused)


def _worst_first(row: Row) -> tuple[int, float, int, str]:
    """By severity, then the least likely by chance, then by count; as the report has them."""
    p_value = 1.0 if row["p_value"] is None else row["p_value"]
    return -row["severity"], p_value, -row["count"], row["id"]


def as_text(recording: Recording, campaign: str) -> str:
    """What was recorded, the findings, and their number in one line at the end."""
    paragraphs = [_recorded(recording, campaign)]
    paragraphs += [_finding(row) for row in recording.findings[:MAX_FULL_FINDINGS]]
    if others := recording.findings[MAX_FULL_FINDINGS:]:
        causes = Counter(in_words(row["cause"]) for row in others)
        listed = ", ".join(f"{cause} ({count})" for cause, count in causes.most_common())
        paragraphs.append(
            _wrapped(_("And {others} more: {listed}.", others=len(others), listed=listed))
        )
    paragraphs.append(_wrapped(_summary(recording)))
    return "\n\n".join(paragraphs) + "\n"


def _recorded(recording: Recording, campaign: str) -> str:
    planned = counted(len(recording.performed), "manoeuvre")
    found = sum(manoeuvre.found for manoeuvre in recording.performed)
    complete = sum(manoeuvre.found and manoeuvre.complete for manoeuvre in recording.performed)
    sentences = [
        _(
            "{campaign}: {found} of {planned} found, {complete} complete.",
            campaign=campaign,
            found=found,
            planned=planned,
            complete=complete,
        )
    ]
    sentences += [
        _(
            "{lines} of {log} cannot be read and {value} left out.",
            lines=counted(lines, "line"),
            log=log,
            value="is" if lines == 1 else "are",
        )
        for log, lines in recording.refused.items()
    ]
    return "\n".join(_wrapped(shortened(sentence, 300)) for sentence in sentences)


def _finding(row: Row) -> str:
    """Cause and place, the sentence, what it does to the result, what to do."""
    place = row["manoeuvre"] or row["log"]
    title = [how_grave(row["severity"]).upper(), in_words(row["cause"])]
    title += [shortened(place, 60)] if place else []
    return "\n".join([_wrapped(" · ".join(title)), *_details(row)])


def _details(row: Row) -> Iterator[str]:
    yield _wrapped(shortened(row["sentence"], 600), INDENT)
    for name, label in LABELS.items():
        if row[name]:
            yield _wrapped(f"{label}: {shortened(row[name], 600)}", INDENT)


def _summary(recording: Recording) -> str:
    if recording.findings:
        return tally([row["severity"] for row in recording.findings])
    if refused := sum(recording.refused.values()):
        return _("No finding, but {refused} cannot be read.", refused=counted(refused, "line"))
    return _("Nothing is wrong with this recording.")


def _wrapped(text: str, indent: str = "") -> str:
    """In lines; the narrow space within a number is no place to break one."""
    return textwrap.fill(
        text.replace("\n", " "),
        LINE_WIDTH,
        initial_indent=indent,
        subsequent_indent=indent,
        break_on_hyphens=False,
    )


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.stderr.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.exit(main())
