"""The page of clusters and costs, docs/scale.md."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import jinja2
import pandas as pd
import pyarrow.parquet as pq
from on_slurm import Outcome, benchmarks

from stages import ORDER

DOCS = Path(__file__).parents[2] / "docs"
TEMPLATE = Path(__file__).parent / "scale.md.jinja"
YEARS = (1_000, 10_000, 100_000, 1_000_000)  # campaigns a year
HOURS = 365.25 * 24


@dataclass(frozen=True)
class Long:
    """A campaign that was run: samples, MB of its logs, its benchmarks, and its folder."""

    samples: int
    logs_mb: float
    benchmarks: pd.DataFrame
    folder: Path

    @classmethod
    def of(cls, folder: Path, campaign: str) -> Self:
        """One of several campaigns of a folder."""
        every = benchmarks(folder)
        derived = folder / "data/derived" / campaign
        logs = (folder / "data/raw" / campaign).glob("*.asc")
        return cls(
            pq.read_metadata(derived / "decode/samples.parquet").num_rows,
            sum(log.stat().st_size for log in logs) / 1e6,
            every[every["campaign"] == campaign],
            folder,
        )

    @property
    def cpu(self) -> float:
        """Processor time of all stages, s."""
        return float(self.benchmarks["cpu_time"].sum())

    def kept(self) -> tuple[int, float]:
        """Files, and MB, of what was made of one campaign."""
        campaigns = self.benchmarks["campaign"].unique()
        sizes = [
            path.stat().st_size
            for campaign in campaigns
            for place in (f"data/derived/{campaign}/*/*", f"reports/{campaign}.*")
            for path in self.folder.glob(place)
        ]
        return len(sizes), sum(sizes) / 1e6


def write(
    outcome: Outcome, short: Long, long: Long, plans: Mapping[int, tuple[float, float, int]]
) -> str:
    """Write the page; the outcome as text for the terminal."""
    sample = (long.cpu - short.cpu) / (long.samples - short.samples)  # s
    fixed = short.cpu - sample * short.samples  # s
    largest = max(plans)
    plan = plans[largest][0] / largest  # s for each campaign
    files, mb = short.kept()
    figures = {
        "outcome": outcome,
        "minutes": f"{outcome.seconds / 60:.0f}",
        "share": f"{100 * outcome.share:.0f}",
        "stages": list(_stages(short, long)),
        "short": short,
        "long": long,
        "fixed": f"{fixed:.1f}",
        "microseconds": f"{1e6 * sample:.1f}",
        "plans": [
            (f"{n:,}", f"{jobs:,}", f"{own:.1f}", f"{bare:.1f}", f"{own / bare:.2f}")
            for n, (own, bare, jobs) in plans.items()
        ],
        "plan_ms": f"{1e3 * plan:.0f}",
        "files": files,
        "mb": f"{mb:.0f}",
        "years": [
            (
                f"{year:,}",
                f"{year * short.cpu / outcome.share / 3600:,.0f}",
                f"{year * short.cpu / outcome.share / 3600 / HOURS:.2f}",
                f"{year * long.cpu / outcome.share / 3600 / HOURS:.2f}",
                f"{year * plan / 3600:,.2f}",
                f"{year * (mb + short.logs_mb) / 1e6:,.2f}",
                f"{year * files:.1e}",
            )
            for year in YEARS
        ],
    }
    text = TEMPLATE.read_text(encoding="utf-8")
    page = jinja2.Template(text, keep_trailing_newline=True).render(figures)
    (DOCS / "scale.md").write_text(page, "utf-8")
    lost = "nothing is lost" if outcome.lossless else f"LOST: {outcome.different or outcome.again}"
    return (
        f"{outcome.campaigns} campaigns in {outcome.seconds:.0f} s, {outcome.requeued} begun again,"
        f" {outcome.over_memory} over their memory: {lost}\nThe page: {DOCS / 'scale.md'}\n"
    )


def _stages(short: Long, long: Long) -> Iterator[tuple[str, ...]]:
    for stage in ORDER:
        rows = [of.benchmarks[of.benchmarks["stage"] == stage] for of in (short, long)]
        if all(len(row) for row in rows):
            cpu = [f"{row['cpu_time'].mean():.1f}" for row in rows]
            yield stage, *cpu, *(f"{row['max_rss'].max():.0f}" for row in rows)
