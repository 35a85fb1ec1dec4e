"""The verdict on a recording as plain text, no wider than a terminal."""

from __future__ import annotations

import textwrap
from collections import Counter
from collections.abc import Iterator

from inertial.campaign.records import Row
from inertial.text.cause_names import how_grave, in_words, tally
from inertial.text.numbers import counted, shortened
from stages.checking.recording import Recording

WIDTH = 100
IN_FULL = 20  # findings; of further ones only the causes are told
SPOILS = 3  # the severity that spoils a result
LABELS = {"consequence": "Consequence", "action": "What to do"}
INDENT = " " * 4


def spoiled(found: Recording) -> bool:
    """Whether anything spoils a result."""
    return any(row["severity"] >= SPOILS for row in found.findings)


def as_text(found: Recording, campaign: str) -> str:
    """What was recorded, what is wrong with it, and how much in one line at the end."""
    parts = [_recorded(found, campaign)]
    parts += [_finding(row) for row in found.findings[:IN_FULL]]
    if rest := found.findings[IN_FULL:]:
        causes = Counter(in_words(row["cause"]) for row in rest)
        listed = ", ".join(f"{cause} ({count})" for cause, count in causes.most_common())
        parts.append(_wrapped(f"And {len(rest)} more: {listed}."))
    parts.append(_wrapped(_end(found)))
    return "\n\n".join(parts) + "\n"


def _recorded(found: Recording, campaign: str) -> str:
    planned = len(found.performed)
    there = sum(done.found for done in found.performed)
    whole = sum(done.found and done.complete for done in found.performed)
    said = [f"{campaign}: {there} of {counted(planned, 'manoeuvre')} found, {whole} complete."]
    said += [
        f"{counted(lines, 'line')} of {log} cannot be read and {_is(lines)} left out."
        for log, lines in found.refused.items()
    ]
    return "\n".join(_wrapped(shortened(sentence, 300)) for sentence in said)


def _is(number: int) -> str:
    return "is" if number == 1 else "are"


def _finding(row: Row) -> str:
    """Cause and place, the sentence, what it does to the result, what to do."""
    where = row["manoeuvre"] or row["log"]
    title = [how_grave(row["severity"]).upper(), in_words(row["cause"])]
    title += [shortened(where, 60)] if where else []
    return "\n".join([_wrapped(" · ".join(title)), *_lines(row)])


def _lines(row: Row) -> Iterator[str]:
    yield _wrapped(shortened(row["sentence"], 600), INDENT)
    for name, label in LABELS.items():
        if row[name]:
            yield _wrapped(f"{label}: {shortened(row[name], 600)}", INDENT)


def _end(found: Recording) -> str:
    if found.findings:
        return tally([row["severity"] for row in found.findings])
    if refused := sum(found.refused.values()):
        return f"No finding, but {counted(refused, 'line')} cannot be read."
    return "Nothing is wrong with this recording."


def _wrapped(text: str, indent: str = "") -> str:
    """In lines; the narrow space within a number is no place to break one."""
    return textwrap.fill(
        text.replace("\n", " "),
        WIDTH,
        initial_indent=indent,
        subsequent_indent=indent,
        break_on_hyphens=False,
    )
