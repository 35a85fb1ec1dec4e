"""Where does a number of the report come from?

    python -m stages.tracing --campaign demo --id gyroscope/joint/bias_x

It ends with 0 where every link of the chain holds, and with 1 where one does not or where there is
no such number.
"""

import argparse
import sys
import textwrap
from collections.abc import Sequence
from pathlib import Path

from inertial.tables.code import ROOT
from inertial.tables.errors import Refusal
from inertial.tables.yaml_file import YamlFile
from stages.tracing.origins import Campaign
from stages.tracing.walk import Walk, walk


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the way from a number to its lines; the exit code."""
    parser = argparse.ArgumentParser(prog="trace", description="where a number comes from")
    parser.add_argument("--campaign", required=True, help="name of the campaign")
    parser.add_argument("--id", required=True, help="such as gyroscope/joint/bias_x")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds raw/ and derived/")
    parser.add_argument("--config", type=Path, default=ROOT / "config.yaml", help="the settings")
    given = parser.parse_args(arguments)
    try:
        settings = YamlFile(given.config).content
        found = walk(Campaign(given.data, given.campaign), given.id, settings)
    except Refusal as refusal:
        sys.stderr.write(_shown(f"trace: {refusal}\n"))
        return 1
    sys.stdout.write(_shown(as_text(found, given.campaign)))
    return 1 if found.broken else 0


def as_text(found: Walk, campaign: str) -> str:
    """The steps as paragraphs, and at the end whether every link holds."""
    parts = [
        step.title + "\n" + textwrap.indent("\n".join(step.lines), "    ") for step in found.steps
    ]
    if found.broken:
        parts.append(
            "THE CHAIN DOES NOT HOLD\n"
            + textwrap.indent("\n".join(dict.fromkeys(found.broken)), "    ")
            + f"\nDelete the tables that have changed; then make report CAMPAIGN={campaign} makes"
            " again what rests on what has changed."
        )
    else:
        parts.append("Every link holds: files, tables, settings and code are those it was made by.")
    return "\n\n".join(parts) + "\n"


def _shown(text: str) -> str:
    """A log may hold anything; nothing of it shall act on the terminal."""
    kept = (c if c.isprintable() or c == "\n" else ascii(c)[1:-1] for c in text)
    return "".join(kept)


if __name__ == "__main__":
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.stderr.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.exit(main())
