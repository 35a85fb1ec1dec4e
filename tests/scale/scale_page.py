"""The page of costs, docs/scale.md."""

import os
import platform
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import jinja2
import numpy as np
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


def write(outcomes: list[Outcome]) -> str:
    """Write the page; where it is."""
    text = TEMPLATE.read_text(encoding="utf-8")
    page = jinja2.Template(text, keep_trailing_newline=True).render(_figures(outcomes))
    (DOCS / "scale.md").write_text(page, encoding="utf-8")
    return f"The page: {DOCS / 'scale.md'}\n"


def _figures(outcomes: list[Outcome]) -> dict[str, Any]:
    of = {part: _by_size(outcomes, part) for part in {one["part"] for one in outcomes}}
    (small,), (kilohertz,) = of["small"].values(), of["kilohertz"].values()
    longs = list(of["long"].values())
    first, last = longs[0], longs[-1]
    largest = max(of["planned"])
    plan = of["planned"][largest]["own"]["cpu"] / largest  # s for each campaign
    memory = _slope({n: one["own"]["memory"] for n, one in of["planned"].items()})
    folder = _slope({n: one["cpu"] for n, one in of["folder"].items()})
    many = {n: one["cpu"] for n, one in list(of["archive"].items())[-2:]}
    each = small["cpu"] / small["size"]  # s
    files, metadata = sum(small["files"].values()), small["files"]["Snakemake"]
    kept = sum(small["bytes"].values()) + small["logs"]
    sample = _per_sample(first["cpu"], last["cpu"], first, last)
    by_stage = {
        stage: _per_sample(*(one["stages"][stage]["cpu"] for one in (first, last)), first, last)
        for stage in ORDER
        if stage in first["stages"]
    }
    shares = sorted(by_stage, key=lambda stage: -by_stage[stage])[:LARGEST]
    return {
        "code": outcomes[0]["code"],
        "load": f"{os.getloadavg()[0]:.0f}",
        "machine": f"{platform.machine()} with Python {platform.python_version()}",
        "planned": list(_planned(of["planned"])),
        "folder": [(f"{n:,}", f"{one['cpu']:.1f}") for n, one in of["folder"].items()],
        "archive": [(f"{one['found']:,}", f"{one['cpu']:.1f}") for one in of["archive"].values()],
        "small": {
            "size": small["size"],
            "samples": f"{small['samples']:,.0f}",
            "logs": f"{small['logs'] / 1e6:.1f}",
            "cpu": f"{each:.0f}",
            "least": f"{min(one['cpu'] for one in small['stages'].values()) / small['size']:.1f}",
            "share": f"{100 * (1 - small['snakemake'] / small['cpu']):.0f}",
            "files": f"{files:.0f}",
            "metadata": f"{metadata:.0f}",
        },
        "stage_head": [
            *("stage", f"{small['samples']:,.0f} samples, s"),
            *(f"{one['samples']:,.0f}, s" for one in longs),
            "each sample, µs",
            *(f"MB at {one['samples']:,.0f}" for one in (small, *longs)),
        ],
        "stages": list(_stages(small, longs, by_stage)),
        "kilohertz": {
            "minutes": f"{kilohertz['samples'] / 1000 / 60:.0f}",
            "cpu": f"{kilohertz['cpu']:.0f}",
            "seconds": f"{kilohertz['seconds']:.0f}",
        },
        "long_sizes": " and ".join(f"{one['samples']:,.0f}" for one in longs),
        "far": {
            "cpu": f"{last['cpu'] + sample * (FAR - last['samples']):.0f}",
            "slope": f"{1e6 * sample:.1f}",
            "stages": ", ".join(f"{stage} ({1e6 * by_stage[stage]:.1f})" for stage in shares),
            "memory": " and ".join(f"{one['together'] / 1e6:,.0f} MB" for one in longs),
        },
        "ratio": f"{last['cpu'] / each:.1f}",
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
        "largest": f"{largest:,}",
        "inodes": f"{INODES / files:,.0f}",
        "memory_each": f"{memory / 1e6:.1f}",
        "plan_ms": f"{1e3 * plan:.0f}",
        "dag_limit": f"{ROOM / memory:,.0f}",
        "folder_ms": f"{1e3 * folder:.1f}",
        "folder_far": f"{1e6 * folder / 60:.0f}",
        "archive_ms": f"{1e3 * _slope(many):.0f}",
        "archive_s": f"{min(many.values()):.0f}",
        "far_processors": f"{YEARS[-1] * each / 3600 / HOURS:.1f}",
    }


def _by_size(outcomes: list[Outcome], part: str) -> dict[int, Outcome]:
    own = {int(one["size"]): one for one in outcomes if one["part"] == part}
    return dict(sorted(own.items()))


def _slope(values: Mapping[int, float]) -> float:
    """What one more costs, between the smallest and the largest size."""
    least, most = min(values), max(values)
    return float(np.diff([values[least], values[most]])[0]) / (most - least)


def _per_sample(first: float, last: float, short: Outcome, long: Outcome) -> float:
    return (last - first) / float(long["samples"] - short["samples"])


def _planned(planned: Mapping[int, Outcome]) -> Iterator[tuple[str, ...]]:
    for number, one in planned.items():
        own, bare = one["own"], one["bare"]
        yield (
            *(f"{number:,}", f"{own['jobs']:,}", f"{own['cpu']:.1f}", f"{bare['cpu']:.1f}"),
            f"{own['cpu'] / bare['cpu']:.2f}",
            *(f"{each['memory'] / 1e6:,.0f}" for each in (own, bare)),
        )


def _stages(
    small: Outcome, longs: Sequence[Outcome], by_stage: Mapping[str, float]
) -> Iterator[tuple[str, ...]]:
    runs = (small, *longs)
    for stage, slope in by_stage.items():
        took = [one["stages"].get(stage) for one in runs]
        if all(took):
            counts = (small["size"], *(1 for _ in longs))
            yield (
                stage,
                *(f"{each['cpu'] / n:.1f}" for each, n in zip(took, counts, strict=True)),
                f"{1e6 * slope:.2f}",
                *(f"{each['memory'] / 1e6:.0f}" for each in took),
            )
    others = [one["snakemake"] / n for one, n in zip(runs, (small["size"], 1, 1), strict=True)]
    yield "Snakemake", *(f"{each:.1f}" for each in others), "", *("" for _ in runs)
    whole = [one["cpu"] / n for one, n in zip(runs, (small["size"], 1, 1), strict=True)]
    total = _per_sample(longs[0]["cpu"], longs[-1]["cpu"], longs[0], longs[-1])
    yield (
        *("together", *(f"{each:.1f}" for each in whole), f"{1e6 * total:.2f}"),
        *(f"{one['together'] / 1e6:.0f}" for one in runs),
    )
