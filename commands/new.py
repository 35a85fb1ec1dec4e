"""A plan to record by: a campaign file that says how long, why, and how well it must be known.

    python -m commands.new --plan six-position --name june

It copies commands/plans/<plan>.yaml to data/raw/<name>/campaign.yaml. It ends with 0, or with 2
where there is no such plan or the name is taken.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from commands.new_campaign import free_folder
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.numbers import visible

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
    sys.stdout.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.stderr.reconfigure(errors="backslashreplace")  # type: ignore[union-attr]
    sys.exit(main())
