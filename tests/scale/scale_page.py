"""The page of costs, docs/scale.md."""

import os
import platform
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
from resumable import Outcome

from stages import ORDER

DOCS = Path(__file__).parents[2] / "docs"
TEMPLATE = Path(__file__).parent / "scale.md.jinja"
YEARS = (1_000, 10_000, 100_000, 1_000_000)  # campaigns a year
HOURS = 365.25 * 24
FAR = 1e8  # samples
INODES = 1e8  # of a file system
ROOM = 16e9  # byte of memory
LARGEST = 4  # stages that are named
PARTS = ("planned", "folder", "archive", "long", "kilohertz", "small")


def write(outcomes: list[Outcome]) -> str:
    """Write the page; where it is."""
    text = TEMPLATE.read_text(encoding="utf-8")
    page = jinja2.Template(text, keep_trailing_newline=True).render(_figures(outcomes))
    (DOCS / "scale.md").write_text(page, encoding="utf-8")
    return f"The page: {DOCS / 'scale.md'}\n"


def _figures(outcomes: list[Outcome]) -> dict[str, Any]:
    """What the template shows; a part that is not measured yet is None there."""
    of = {part: _by_size(outcomes, part) for part in PARTS}
    small, kilohertz = (next(iter(of[part].values()), None) for part in ("small", "kilohertz"))
    longs = list(of["long"].values())
    largest = max(of["planned"])
    plan = of["planned"][largest]["own"]["cpu"] / largest  # s for each campaign
    memory = _slope({n: one["own"]["memory"] for n, one in of["planned"].items()})
    folder = _slope({n: one["cpu"] for n, one in of["folder"].items()})
    many = {n: one["cpu"] for n, one in list(of["archive"].items())[-2:]}
    left = small or longs[0]
    files, metadata = sum(left["files"].values()), left["files"]["Snakemake"]
    runs = [*([small] if small else []), *longs]
    missing = {
        "many small campaigns": small,
        "a campaign of 1 kHz": kilohertz,
        "what 10⁸ samples take": longs[1:],
    }
    return {
        "code": outcomes[0]["code"],
        "missing": "; ".join(name for name, found in missing.items() if not found),
        "load": f"{os.getloadavg()[0]:.0f}",
        "machine": f"{platform.machine()} with Python {platform.python_version()}",
        "planned": list(_planned(of["planned"])),
        "folder": [(f"{n:,}", f"{one['cpu']:.1f}") for n, one in of["folder"].items()],
        "archive": [(f"{one['found']:,}", f"{one['cpu']:.1f}") for one in of["archive"].values()],
        "small": small and _of_small(small, plan),
        "stage_head": [
            *("stage", *(f"{one['samples']:,.0f} samples, s" for one in runs)),
            *(f"MB at {one['samples']:,.0f}" for one in runs),
        ],
        "stages": list(_stages(runs)),
        "kilohertz": kilohertz
        and {
            "minutes": f"{kilohertz['samples'] / 1000 / 60:.0f}",
            "cpu": f"{kilohertz['cpu']:.0f}",
            "seconds": f"{kilohertz['seconds']:.0f}",
        },
        "far": _far(longs[0], longs[-1]) if len(longs) > 1 else None,
        "largest": f"{largest:,}",
        "files": f"{files:.0f}",
        "metadata": f"{metadata:.0f}",
        "inodes": f"{INODES / files:,.0f}",
        "memory_each": f"{memory / 1e6:.1f}",
        "plan_ms": f"{1e3 * plan:.0f}",
        "dag_limit": f"{ROOM / memory:,.0f}",
        "folder_ms": f"{1e3 * folder:.1f}",
        "folder_far": f"{1e6 * folder / 60:.0f}",
        "archive_ms": f"{1e3 * _slope(many):.0f}",
        "archive_s": f"{min(many.values()):.0f}",
    }


def _of_small(small: Outcome, plan: float) -> dict[str, Any]:
    """Many small campaigns, and what a year of them takes; `plan`: s to plan one."""
    each = small["cpu"] / small["size"]  # s
    files, metadata = sum(small["files"].values()), small["files"]["Snakemake"]
    kept = sum(small["bytes"].values()) + small["logs"]
    return {
        "size": small["size"],
        "samples": f"{small['samples']:,.0f}",
        "logs": f"{small['logs'] / 1e6:.1f}",
        "cpu": f"{each:.0f}",
        "least": f"{min(one['cpu'] for one in small['stages'].values()) / small['size']:.1f}",
        "share": f"{100 * (1 - small['snakemake'] / small['cpu']):.0f}",
        "years": [
            (
                f"{year:,}",
                f"{year * each / 3600:,.0f}",
                f"{year * each / 3600 / HOURS:.2f}",
                f"{year * plan / 3600:,.1f}",
                f"{year * files:.1e}",
                f"{year * metadata:.1e}",
                f"{year * kept / 1e12:,.2f}",
            )
            for year in YEARS
        ],
        "far_processors": f"{YEARS[-1] * each / 3600 / HOURS:.1f}",
    }


def _far(short: Outcome, long: Outcome) -> dict[str, str]:
    """The two long campaigns, and a longer one by their difference."""
    sizes = long["samples"] - short["samples"]
    sample = (long["cpu"] - short["cpu"]) / sizes  # s
    by_stage = {
        stage: 1e6 * (took["cpu"] - short["stages"][stage]["cpu"]) / sizes
        for stage, took in long["stages"].items()
    }
    shares = sorted(by_stage, key=lambda stage: -by_stage[stage])[:LARGEST]
    return {
        "sizes": " and ".join(f"{one['samples']:,.0f}" for one in (short, long)),
        "cpu": f"{long['cpu'] + sample * (FAR - long['samples']):.0f}",
        "slope": f"{1e6 * sample:.1f}",
        "stages": ", ".join(f"{stage} ({by_stage[stage]:.1f})" for stage in shares),
        "memory": " and ".join(f"{one['together'] / 1e6:,.0f} MB" for one in (short, long)),
    }


def _by_size(outcomes: list[Outcome], part: str) -> dict[int, Outcome]:
    own = {int(one["size"]): one for one in outcomes if one["part"] == part}
    return dict(sorted(own.items()))


def _slope(values: Mapping[int, float]) -> float:
    """What one more costs, between the smallest and the largest size."""
    least, most = min(values), max(values)
    return (values[most] - values[least]) / (most - least)


def _planned(planned: Mapping[int, Outcome]) -> Iterator[tuple[str, ...]]:
    for number, one in planned.items():
        own, bare = one["own"], one["bare"]
        yield (
            *(f"{number:,}", f"{own['jobs']:,}", f"{own['cpu']:.1f}", f"{bare['cpu']:.1f}"),
            f"{own['cpu'] / bare['cpu']:.2f}",
            *(f"{each['memory'] / 1e6:,.0f}" for each in (own, bare)),
        )


def _stages(runs: Sequence[Outcome]) -> Iterator[tuple[str, ...]]:
    """Of each campaign of a run: its stages, Snakemake, and all together."""
    counts = [one["size"] if one["part"] == "small" else 1 for one in runs]
    for stage in ORDER:
        took = [one["stages"].get(stage) for one in runs]
        if all(took):
            cpu = [each["cpu"] / n for each, n in zip(took, counts, strict=True)]
            memory = [f"{each['memory'] / 1e6:.0f}" for each in took]
            yield stage, *(f"{each:.1f}" for each in cpu), *memory
    for name, key in (("Snakemake", "snakemake"), ("together", "cpu")):
        cpu = [one[key] / n for one, n in zip(runs, counts, strict=True)]
        memory = [f"{one['together'] / 1e6:.0f}" if key == "cpu" else "" for one in runs]
        yield name, *(f"{each:.1f}" for each in cpu), *memory
