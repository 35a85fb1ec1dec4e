"""A new campaign: its folder, which must not be there yet, and the text of its file."""

import argparse
import json
import re
import sys
import textwrap
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from commands import run
from inertial.campaign.references import BY_HAND, NOT_NAMED
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import visible

NAME = re.compile(r"[a-z0-9][a-z0-9-]*")


def folder_of(name: str, data: Path) -> Path:
    """The folder of a campaign of this name.

    Raises
    ------
    Refusal
        where the name is none
    """
    if not NAME.fullmatch(name):
        raise Refusal(
            "NAME",
            "",
            repr(name),
            _("small letters a-z, digits and hyphens, a letter or digit first"),
            _("name the campaign: NAME=june"),
        )
    return data / "raw" / name


def free_folder(name: str, data: Path) -> Path:
    """The folder of a campaign that is not there yet.

    Raises
    ------
    Refusal
        where the name is none, or is taken
    """
    folder = folder_of(name, data)
    if folder.exists() or (data / "simulated" / f"{name}.yaml").exists():
        raise Refusal(
            str(folder),
            "",
            _("there is a campaign of this name"),
            _("a name that is free; nothing is overwritten"),
            _("give another: NAME=…"),
        )
    return folder


# ---- The text of a campaign file: comments, and values as YAML on one line

LINE_WIDTH = 100
GUESS = "# guessed:"
PLAIN = re.compile(r"^[A-Za-z][\w-]*$")
WORDS = {"true", "false", "null", "yes", "no", "on", "off", "y", "n"}


def comment(text: str, first: str = "# ") -> list[str]:
    """Lines of a comment, of which the first begins with a mark of its own."""
    indent = "#" + " " * (len(first) - 1)
    return textwrap.wrap(
        text, LINE_WIDTH, initial_indent=first, subsequent_indent=indent, break_on_hyphens=False
    )


def guess(why: str) -> str:
    """A comment behind what is a guess."""
    return f"  {GUESS} {why}"


def flow(**keys: Any) -> str:
    """Keys and values on one line, in braces."""
    return "{" + ", ".join(f"{key}: {in_flow(value)}" for key, value in keys.items()) + "}"


def in_flow(value: Any) -> str:
    """A value, however nested, on one line."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{scalar(k)}: {in_flow(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(scalar, value)) + "]"
    return scalar(value)


def scalar(value: Any) -> str:
    """Text, a number or nothing, in quotes where it would be read as something else."""
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        return f"{value:.10g}"
    if (
        isinstance(value, str)
        and not (
            (PLAIN.match(value) or re.fullmatch(r"[+-][xyz]", value)) and value.lower() not in WORDS
        )
        and value not in ("m/s2", "rad/s", "deg/s", BY_HAND, NOT_NAMED)
    ):
        return json.dumps(value, ensure_ascii=False)
    return str(value)


# ---- A plan to record by: a campaign file that says how long, why, and how well it must be known.
#
#     python -m commands.new --plan six-position --name june
#
# It copies commands/plans/<plan>.yaml to data/raw/<name>/campaign.yaml. It ends with 0, or with 2
# where there is no such plan or the name is taken.

PLANS = {path.stem: path for path in sorted((Path(__file__).parent / "plans").glob("*.yaml"))}


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the plan; the exit code."""
    parser = argparse.ArgumentParser(prog="new", description="a plan to record by")
    parser.add_argument("--plan", default="", help=", ".join(PLANS))
    parser.add_argument("--name", default="", help="of the campaign")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds raw/")
    options = parser.parse_args(arguments)
    try:
        if options.plan not in PLANS:
            raise Refusal(
                "PLAN",
                "",
                repr(options.plan),
                _("one of {plans}", plans=", ".join(PLANS)),
                _("name one: PLAN={plan}", plan=next(iter(PLANS))),
            )
        folder = free_folder(options.name, options.data)
    except Refusal as refusal:
        sys.stderr.write(visible(f"new: {refusal}\n"))
        return 2
    folder.mkdir(parents=True)
    text = PLANS[options.plan].read_text(encoding="utf-8")
    (folder / "campaign.yaml").write_text(text, encoding="utf-8")
    sys.stdout.write(
        visible(
            _(
                "Written: {path}\nFill in what it asks for, record by it, put the logs beside "
                "it; then make check CAMPAIGN={name}\n",
                path=folder / "campaign.yaml",
                name=options.name,
            )
        )
    )
    return 0


if __name__ == "__main__":
    run(main)
