"""The command line `turntable-calibration`.

Exit status: 0 where all was done; 1 where a stage refused its input, or `check` or `trace` found
what spoils a result; 2 where the command cannot be carried out as it was given.
"""

import re
from ctypes.util import find_library
from pathlib import Path

import click
from click.shell_completion import CompletionItem, get_completion_class

from turntable_calibration.workflow_run import WORKFLOW, campaigns, command, part_of, snakemake

PROGRAM = "turntable-calibration"
NAME = re.compile("[a-z0-9][a-z0-9-]*")
EXPORTS = (
    *("calibration.json", "calibration.yaml", "calibration.h", "dcc.xml"),
    *("kalibr.yaml", "ros.yaml", "px4.params", "ardupilot.param"),
)
PLANS = sorted(path.stem for path in (WORKFLOW / "commands/plans").glob("*.yaml"))


class Campaign(click.ParamType[str]):
    """The name of a campaign of the folder; a shell completes it."""

    name = "campaign"

    def convert(self, value: str, param: click.Parameter | None, ctx: click.Context | None) -> str:
        """The name, where there is such a campaign."""
        if not NAME.fullmatch(value):
            self.fail(
                f"{value!r} is no name of a campaign: "
                "small letters a-z, digits and hyphens, a letter or digit first"
            )
        if value not in (known := campaigns(_folder(ctx))):
            there = (
                f"there are: {', '.join(known)}"
                if known
                else (
                    "there is none in this folder: draft one of its logs by "
                    "`turntable-calibration draft LOG…`, or change the folder by --folder"
                )
            )
            self.fail(f"there is no campaign {value}; {there}")
        return value

    def shell_complete(
        self, ctx: click.Context, param: click.Parameter, incomplete: str
    ) -> list[CompletionItem]:
        """Those that begin so."""
        return [CompletionItem(c) for c in campaigns(_folder(ctx)) if c.startswith(incomplete)]


def _folder(ctx: click.Context | None) -> Path:
    return Path(ctx.find_root().params.get("folder", ".")) if ctx is not None else Path()


@click.group(context_settings={"help_option_names": ["-h", "--help"]}, epilog=__doc__)
@click.option(
    "--folder",
    type=click.Path(exists=True, file_okay=False, path_type=Path),
    default=Path(),
    help="Holds data/raw/<campaign>/, and gets data/derived/ and reports/.",
)
@click.option(
    "--cores",
    type=click.IntRange(min=1),
    default=2,
    show_default=True,
    help="Processors that it may use.",
)
@click.version_option(package_name=PROGRAM)
@click.pass_context
def main(ctx: click.Context, folder: Path, cores: int) -> None:
    """Calibrate an IMU on a turntable or by hand, from raw log to certificate."""
    ctx.obj = (folder, cores)


@main.command()
@click.argument("campaign", nargs=-1, required=True, type=Campaign())
@click.pass_obj
def report(of: tuple[Path, int], campaign: tuple[str, ...]) -> int:
    """Make the reports of campaigns, and their calibrations for other programs.

    A campaign that is refused keeps none of the others from its report.
    """
    folder, cores = of
    goals = [goal for name in campaign for goal in _goals(name)]
    if status := snakemake(folder, cores, goals, keep_going=True):
        return status
    for name in campaign:
        summary = (folder / f"reports/{name}.txt").read_text(encoding="utf-8")
        click.echo(f"\n{summary.partition(chr(10) + 'Campaign:')[0]}")
        click.echo(f"For other programs: {' '.join(f'reports/{name}.{end}' for end in EXPORTS)}")
        click.echo(f"The report: {' '.join(_pages(name))}")
    return 0


def _pages(campaign: str) -> list[str]:
    """The report, as PDF where there is Pango."""
    kinds = ["html", "pdf"] if find_library("pango-1.0") else ["html"]
    return [f"reports/{campaign}.{kind}" for kind in kinds]


def _goals(campaign: str) -> list[str]:
    """The report and the calibration for other programs."""
    return [*_pages(campaign), f"reports/{campaign}.calibration.json"]


@main.command()
@click.argument("campaign", type=Campaign())
@click.pass_obj
def crate(of: tuple[Path, int], campaign: str) -> int:
    """Pack a campaign with all that made it as a Workflow Run RO-Crate."""
    folder, cores = of
    if status := snakemake(folder, cores, _goals(campaign)):
        return status
    return command("crate", ["--campaign", campaign], folder)


@main.command()
@click.argument("campaign", type=Campaign())
@click.pass_obj
def check(of: tuple[Path, int], campaign: str) -> int:
    """Find what is wrong with a recording, in a minute or, in a chamber, a few."""
    folder, cores = of
    if status := snakemake(folder, cores, [f"data/derived/{campaign}/diagnosis/verdict.parquet"]):
        return status
    click.echo()
    return command("check", ["--campaign", campaign], folder)


@main.command()
@click.argument("logs", nargs=-1, required=True, type=click.Path())
@click.option("--name", default="", help="Of the campaign; left out: of the first log.")
@click.option(
    "--rate",
    type=click.FloatRange(min=0, min_open=True),
    help="Samples per second, where no log states it.",
)
@click.pass_obj
def draft(of: tuple[Path, int], logs: tuple[str, ...], name: str, rate: float | None) -> int:
    """Write a first campaign file from the logs alone."""
    rates = [] if rate is None else ["--rate", str(rate)]
    return command("draft", [f"--name={name}", *rates, "--", *logs], of[0])


@main.command()
@click.argument("plan", type=click.Choice(PLANS))
@click.argument("name")
@click.pass_obj
def new(of: tuple[Path, int], plan: str, name: str) -> int:
    """Write a plan to record by, as the campaign NAME."""
    return command("new", ["--plan", plan, f"--name={name}"], of[0])


@main.command()
@click.argument("campaign", type=Campaign())
@click.argument("number")
@click.pass_obj
def trace(of: tuple[Path, int], campaign: str, number: str) -> int:
    """Follow NUMBER, such as diagnosis/gyroscope/bias_x, back to the lines of the logs."""
    return command("trace", ["--campaign", campaign, f"--id={number}"], of[0])


@main.command()
@click.option("--instrument", default="", help="From nothing: an entry of data/instruments.yaml.")
@click.option("--campaign", type=Campaign(), default=None, help="What to record next in it.")
@click.option("--table", required=True, help="An entry of data/tables.yaml.")
@click.option("--minutes", default="30", show_default=True, help="At the table, from nothing.")
@click.option("--criterion", default="A", show_default=True, help="A, D or worst.")
@click.option("--want", default="", help="Sigmas to reach, such as gyroscope/scale=5e-6.")
@click.option("--name", default="", help="Of the campaign file that is written.")
@click.pass_obj
def design(
    of: tuple[Path, int],
    instrument: str,
    campaign: str | None,
    table: str,
    minutes: str,
    criterion: str,
    want: str,
    name: str,
) -> int:
    """Design what to record: the best plan from nothing, or what to add to a campaign."""
    folder, cores = of
    if instrument:
        of_it = {"instrument": instrument, "minutes": minutes, "criterion": criterion}
    elif campaign:
        goal = f"data/derived/{campaign}/criticism/findings.parquet"
        if status := snakemake(folder, cores, [goal]):
            return status
        of_it = {"campaign": campaign, "want": want}
    else:
        raise click.UsageError("name an instrument or a campaign")
    of_it |= {"table": table, "name": name}
    return command("design", [f"--{option}={value}" for option, value in of_it.items()], folder)


@main.command()
@click.argument("first", type=Campaign())
@click.argument("second", type=Campaign())
@click.pass_obj
def compare(of: tuple[Path, int], first: str, second: str) -> int:
    """Put two campaigns beside each other."""
    folder, cores = of
    page = f"reports/compare-{first}-{second}"
    if status := snakemake(folder, cores, [f"{page}.html"]):
        return status
    click.echo(f"\n{(folder / f'{page}.txt').read_text(encoding='utf-8')}")
    click.echo(f"The comparison: {page}.html")
    return 0


@main.command()
@click.argument("selection")
@click.option("--name", default="", help="Of the page; left out: of the selection.")
@click.pass_obj
def fleet(of: tuple[Path, int], selection: str, name: str) -> int:
    """Put several campaigns together: by serial=, instrument= or table=, or their names."""
    folder, cores = of
    selections, errors = part_of("overviews.fleet.selection"), part_of("inertial.tables.errors")
    try:
        kept = selections.keep(selection, name, campaigns(folder), folder)
    except errors.Refusal as refusal:
        click.echo(f"fleet: {refusal}", err=True)
        return 2
    if status := snakemake(folder, cores, [f"reports/fleet-{kept}.html"]):
        return status
    click.echo(f"The fleet: reports/fleet-{kept}.html; its tables: data/derived/.fleets/{kept}/")
    return 0


@main.command()
@click.pass_obj
def index(of: tuple[Path, int]) -> int:
    """Make one page of all campaigns, and one of each IMU's history."""
    folder, cores = of
    for goal in ("histories", "reports/index.html"):
        # Where a campaign is refused now, a second run is without it.
        if snakemake(folder, cores, [goal]) and (status := snakemake(folder, cores, [goal])):
            return status
    click.echo("All campaigns: reports/index.html; each IMU: reports/history/")
    return 0


@main.command()
@click.argument("serial")
@click.pass_obj
def history(of: tuple[Path, int], serial: str) -> int:
    """Make the page of one IMU over its calibrations."""
    folder, cores = of
    page = f"reports/history/{serial}.html"
    status = snakemake(folder, cores, [page])
    if not status:
        click.echo(f"The history: {page}")
    return status


@main.command()
@click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
def completion(shell: str) -> int:
    """Print what lets a shell complete commands, options and campaigns.

    In ~/.bashrc: eval "$(turntable-calibration completion bash)"
    """
    of_shell = get_completion_class(shell)
    assert of_shell is not None
    click.echo(of_shell(main, {}, PROGRAM, "_TURNTABLE_CALIBRATION_COMPLETE").source())
    return 0


@main.result_callback()
@click.pass_context
def _exit(ctx: click.Context, /, status: int, **_options: object) -> None:
    ctx.exit(status)


if __name__ == "__main__":
    main(prog_name=PROGRAM)
