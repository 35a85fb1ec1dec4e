"""Where the workflow lies, and a run of it by Snakemake on the folder of a user."""

import fcntl
import importlib
import os
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import ModuleType
from typing import TextIO

import click

HERE = Path(__file__).parent
# A wheel ships the tree beside this file; in a checkout it is the checkout.
WORKFLOW = HERE / "workflow" if (HERE / "workflow").is_dir() else HERE.parent
LOCK = ".snakemake/turntable-calibration.lock"


def snakemake(folder: Path, cores: int, targets: Sequence[str], *, keep_going: bool = False) -> int:
    """Make the targets on a folder that holds data/; its exit status.

    `keep_going`: what does not rest on a job that fails is made all the same.
    Two runs on one folder wait for each other; in a checkout those of `make`, too, which lock the
    Snakefile. The kernel releases the lock when a run is killed; Snakemake's own would stay and
    stop the next run. What Snakemake started has it too.
    """
    with _lock_of(folder) as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            click.echo("Another run is at work here; this one waits for it.")
            fcntl.flock(file, fcntl.LOCK_EX)
        command = [
            *(sys.executable, "-m", "snakemake", "--nolock"),
            *("--snakefile", str(WORKFLOW / "Snakefile"), "--directory", str(folder)),
            *("--cores", str(cores), "--quiet", "host", "reason"),
            *(["--keep-going"] if keep_going else []),
            *("--", *targets),
        ]
        return subprocess.run(command, pass_fds=[file.fileno()], check=False).returncode


def _lock_of(folder: Path) -> TextIO:
    """The file that a run locks, open; refused where another user keeps the folder for himself."""
    lock = folder / "Snakefile"
    try:
        if not lock.exists():
            lock = folder / LOCK
            lock.parent.mkdir(parents=True, exist_ok=True)
        return lock.open("a")
    except PermissionError as error:
        raise click.ClickException(
            f"{error.filename} cannot be written: the folder belongs to another user.\n"
            "Who shares it needs a group, with leave to write: chgrp -R <group> and chmod -R g+ws, "
            "and umask 002 of each who runs it. Or copy its data/raw into a folder of your own."
        ) from None


def part_of(name: str) -> ModuleType:
    """A module of the workflow."""
    if str(WORKFLOW) not in sys.path:
        sys.path.insert(0, str(WORKFLOW))
    return importlib.import_module(name)


def command(module: str, arguments: Sequence[str], folder: Path) -> int:
    """What `python -m commands.<module>` does, on a folder that holds data/; its exit status."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy is loaded: matrices are small
    part = ".__main__" if (WORKFLOW / "commands" / module).is_dir() else ""
    main: Callable[[Sequence[str]], int] = part_of(f"commands.{module}{part}").main
    try:
        return main(["--data", str(folder / "data"), *arguments])
    except PermissionError as error:
        refusal = part_of("inertial.tables.errors").no_permission(error)
        raise click.ClickException(f"{module}: {refusal}") from None


def campaigns(folder: Path) -> list[str]:
    """The campaigns of a folder, recorded and simulated."""
    recorded = {path.parent.name for path in folder.glob("data/raw/*/campaign.yaml")}
    return sorted(recorded | {path.stem for path in folder.glob("data/simulated/*.yaml")})
