"""From which lines of the logs was a number of the report computed?

    python -m commands.trace --campaign demo --id diagnosis/gyroscope/bias_x

It ends with 0 where every link of the chain is intact, and with 1 where one is broken or where
there is no such number.
"""

import argparse
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

from commands import run
from commands.trace.provenance import Campaign
from commands.trace.steps import Trace, trace
from inertial.tables.code import ROOT
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the steps from a number to its lines; the exit code."""
    parser = argparse.ArgumentParser(prog="trace", description="where a number comes from")
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--id", required=True, help="such as diagnosis/gyroscope/bias_x")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds raw/ and derived/")
    parser.add_argument("--config", type=Path, default=ROOT / "config.yaml", help="the settings")
    options = parser.parse_args(arguments)
    try:
        settings = YamlFile(options.config).content
        traced = trace(Campaign(options.data, options.campaign), options.id, settings)
    except Refusal as refusal:
        sys.stderr.write(_printable(f"trace: {refusal}\n"))
        return 1
    sys.stdout.write(_printable(as_text(traced, options.campaign)))
    return 1 if traced.broken else 0


def as_text(traced: Trace, campaign: str) -> str:
    """The steps as paragraphs, and at the end whether every link is intact."""
    paragraphs = [
        step.title + "\n" + textwrap.indent("\n".join(step.lines), "    ") for step in traced.steps
    ]
    if traced.broken:
        paragraphs.append(
            _("THE CHAIN IS BROKEN\n")
            + textwrap.indent("\n".join(dict.fromkeys(traced.broken)), "    ")
            + _(
                "\nDelete the tables that have changed; then make report CAMPAIGN={campaign} "
                "makes everything that depends on them again.",
                campaign=campaign,
            )
        )
    else:
        paragraphs.append(
            _("Every link is intact: files, tables, settings and code are those it was made from.")
        )
    return "\n\n".join(paragraphs) + "\n"


def _printable(text: str) -> str:
    """Control characters from a log, escaped, so that they do not act on the terminal."""
    return "".join(c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)


if __name__ == "__main__":
    run(main)
