"""A first campaign file from the logs alone.

    python -m commands.draft --name june session.csv

It writes data/raw/<name>/campaign.yaml and copies the logs beside it; with --rate it replaces the
draft of the same logs without it, where nobody edited that. It ends with 0, or with 2 where a log
cannot be used or the name is taken.
"""

import argparse
import re
import shutil
import sys
from collections.abc import Sequence
from filecmp import cmp
from pathlib import Path

import numpy as np

from commands import run
from commands.draft.campaign_file import campaign_file
from commands.draft.header import names_of_logs, without_clock
from commands.draft.manoeuvres import plan_of
from commands.draft.raw_log import RawLog, raw_log
from commands.draft.sensors import Kind, kinds_of
from commands.new import folder_of, free_folder
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import significant, visible

FILE = "campaign.yaml"
LOG = re.compile(r"[\w+][\w+. -]*")


def main(arguments: Sequence[str] | None = None) -> int:
    """Write the campaign file; the exit code."""
    parser = argparse.ArgumentParser(prog="draft", description="a first campaign file")
    parser.add_argument("logs", nargs="*", type=Path, help="the logs of one recording session")
    parser.add_argument("--name", default="", help="of the campaign; left out: of the first log")
    parser.add_argument("--rate", type=float, help="samples per second, where no log states it")
    parser.add_argument("--data", type=Path, default=Path("data"), help="holds raw/")
    options = parser.parse_args(arguments)
    try:
        folder = draft(options.logs, options.name, options.data, options.rate)
    except Refusal as refusal:
        sys.stderr.write(visible(f"draft: {refusal}\n"))
        return 2
    text = (folder / FILE).read_text(encoding="utf-8")
    sys.stdout.write(visible("".join(f"{line}\n" for line in text.splitlines() if line[:1] == "#")))
    sys.stdout.write(_("\nWritten: {path}\n", path=folder / FILE))
    return 0


def draft(logs: Sequence[Path], name: str, data: Path, rate: float | None = None) -> Path:
    """Write the campaign file of these logs into its folder, which is returned.

    With a rate it replaces the draft of the same logs without one, while that is as it was written.

    Raises
    ------
    Refusal
        where a log is missing or cannot be used, or the name is taken
    """
    if not logs:
        raise Refusal("LOG", "", _("no log"), _("the logs of one session"), _('name them: LOG="…"'))
    name = name or re.sub(r"[^a-z0-9]+", "-", logs[0].stem.lower()).strip("-")
    again = rate is not None and _is_of(logs, folder_of(name, data))
    folder = folder_of(name, data) if again else free_folder(name, data)
    _check(logs, rate)
    raw = [raw_log(path) for path in logs]
    text = _text(raw, name, rate)
    if again and (folder / FILE).read_text(encoding="utf-8") != _text(raw, name):
        raise Refusal(
            str(folder / FILE),
            "",
            _("it is not, or no longer, the draft of these logs without a rate"),
            _("the draft as it was written, which one with a rate replaces"),
            _("give another: NAME=…; or remove its folder where nothing in it is needed"),
        )
    folder.mkdir(parents=True, exist_ok=True)
    for path in () if again else logs:
        shutil.copy(path, folder / path.name)  # a link would be the same bytes
    (folder / FILE).write_text(text, encoding="utf-8")
    return folder


def _is_of(logs: Sequence[Path], folder: Path) -> bool:
    """Whether a folder holds a campaign file, and each of these logs with the same bytes."""
    pairs = [(path, folder / path.name) for path in logs]
    there = (folder / FILE).is_file() and all(one.is_file() for pair in pairs for one in pair)
    return there and all(cmp(*pair, shallow=False) for pair in pairs)


def _text(raw: Sequence[RawLog], name: str, rate: float | None = None) -> str:
    """The campaign file of these logs."""
    kinds = kinds_of(raw, rate)
    plan = plan_of(kinds)
    if not plan:
        raise _nothing_done(kinds)
    return campaign_file(kinds, plan, name)


def _nothing_done(kinds: Sequence[Kind]) -> Refusal:
    """What to do where no log shows a manoeuvre: it may be the rate that is wrong."""
    names = ", ".join(names_of_logs(kind) for kind in kinds)
    expected = _("a rest of at least a second, or a turn about one axis")
    if assumed := [kind.timing.rate for kind in kinds if without_clock(kind.timing)]:
        return Refusal(
            names,
            "",
            _(
                "no column is a time, and at {rate} Hz, which is assumed, neither a static "
                "position nor a turn",
                rate=significant(assumed[0]),
            ),
            expected,
            _("state how many samples a second there are: RATE=…, or --rate"),
        )
    return Refusal(
        names,
        "",
        _("neither a static position nor a turn: all of it moves, about several axes"),
        expected,
        _("record one of the plans of `make new`"),
    )


def _check(logs: Sequence[Path], rate: float | None) -> None:
    """Whether the logs are there, with names that a plan can hold, and the rate can be one."""
    if rate is not None and not 0 < rate < np.inf:
        wanted = _("samples per second, above 0")
        raise Refusal("RATE", "", f"{rate:g}", wanted, _("correct it: RATE=…, or --rate"))
    for path in logs:
        if not path.is_file():
            found = _("a folder") if path.is_dir() else _("no such file")
            raise Refusal(str(path), "", found, _("a log"), _("correct its name: LOG=…"))
        same = [other for other in logs if other.name == path.name]
        if len(same) > 1 or not LOG.fullmatch(path.name) or path.name == FILE:
            raise Refusal(
                str(path),
                "",
                _("a name that is there twice")
                if len(same) > 1
                else _("a name that the plan cannot hold"),
                _("names of their own, of letters, digits, blanks and + - . _"),
                _("rename it"),
            )


if __name__ == "__main__":
    run(main)
