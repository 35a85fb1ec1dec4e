"""docs/design.md: what was foreseen, what the simulated laboratory gave, and the plans compared."""

from collections.abc import Sequence
from pathlib import Path

import chain
import numpy as np
from design_draws import (
    CLASSES,
    CRITERION,
    INSTRUMENT,
    PARTS,
    PULLS,
    TABLE,
    code,
    instrument,
    plans,
    turntable,
)
from jinja2 import Environment, FileSystemLoader, StrictUndefined
from resumable import Outcome

from commands.design.for_campaign import RIGHT
from commands.design.from_nothing import best
from commands.design.printed import detection_limits, limit_rows, sigma_rows
from inertial.estimation.optimal_design import WORST
from inertial.text.cause_names import in_words

PAGE = chain.ROOT / "docs/design.md"
LOWEST, HIGHEST = 0.95, 1.05  # of foreseen over realised sigma
MAX_SHARE = 0.5  # of the time of the campaign, to split a class


def write(outcomes: Sequence[Outcome]) -> str:
    """Write the page of the outcomes; its text."""
    folder = FileSystemLoader(Path(__file__).parent)
    environment = Environment(
        loader=folder, undefined=StrictUndefined, trim_blocks=True, keep_trailing_newline=True
    )
    text = environment.get_template("design.md.jinja").render(
        code=code(),
        instrument=INSTRUMENT,
        at=TABLE,
        criterion=CRITERION,
        ratios=[ratio(part, outcomes) for part in PULLS],
        classes=[split(part, outcomes) for part in CLASSES],
        together=pooled(outcomes),
        **compared(),
    )
    PAGE.write_text(text, encoding="utf-8")
    return text


def ratio(part: str, outcomes: Sequence[Outcome]) -> list[str]:
    """Plan, campaigns, foreseen over realised and over stated sigma, with their uncertainties."""
    own = [one for one in outcomes if one["part"] == part]
    if not own:
        return [part, f"0 of {PARTS[part]}", "–", "–", "–", "–"]
    pulls = np.array([one["pulls"] for one in own])
    stated = np.array([one["stated"] for one in own])
    # Squares of the 24 pulls of a campaign hang together a little, so campaigns are the unit.
    squares = (pulls**2).mean(axis=1)
    realised = float(np.sqrt(squares.mean()))
    sigma = float(squares.std(ddof=1) / np.sqrt(len(own)) / (2 * realised)) if own[1:] else np.nan
    each = 1 / np.sqrt((pulls**2).mean(axis=0))
    accelerometer, gyro = (float(np.sqrt((p**2).mean())) for p in np.split(pulls, 2, axis=1))
    return [
        part,
        f"{len(own)} of {PARTS[part]}",
        f"{1 / realised:.3f} ± {sigma / realised**2:.3f}",
        f"{1 / accelerometer:.3f}, {1 / gyro:.3f}",
        f"{each.min():.2f} to {each.max():.2f}",
        f"{1 / stated.mean():.3f}",
    ]


def split(part: str, outcomes: Sequence[Outcome]) -> list[str]:
    """Effect, draws, of which in a class, right now and foreseen, time, alone in its class."""
    plan, effect, _parameter, _size = CLASSES[part]
    own = [one for one in outcomes if one["part"] == part]
    inside = [one for one in own if one["class"]]
    row = [in_words(effect), plan, f"{len(own)} of {PARTS[part]}", str(len(inside))]
    if not inside:
        return [*row, "–", "–", "–", "–", "–"]
    members = sorted({name for one in inside for name in one["class"]} - {effect})
    share = [100 * one["share"] for one in inside]
    return [
        *row,
        ", ".join(in_words(name) for name in members),
        f"{np.median(share):.0f} % (at most {max(share):.0f} %)",
        f"{np.mean([one['after'] for one in inside]):.3f}",
        f"{sum(one['right'] for one in inside)}",
        f"{sum(one['alone'] for one in inside)}",
    ]


def pooled(outcomes: Sequence[Outcome]) -> dict[str, str]:
    """Of all classes together."""
    inside = [one for one in outcomes if one["part"] in CLASSES and one["class"]]
    able = [one for one in inside if one["after"] >= RIGHT]
    if not able:
        return {"inside": str(len(inside)), "able": "0", "right": "–", "share": "–"}
    right = float(np.mean([one["right"] for one in able]))
    return {
        "inside": str(len(inside)),
        "able": str(len(able)),
        "right": f"{right:.3f} ± {np.sqrt(max(right * (1 - right), 0.02) / len(able)):.3f}",
        "share": f"{100 * max(one['share'] for one in able):.0f}",
    }


def compared() -> dict[str, object]:
    """The designed plans beside those of the sources: time, sigmas, detection limits."""
    own = plans()
    imu, table = instrument(INSTRUMENT, chain.ROOT / "data"), turntable(TABLE, chain.ROOT / "data")
    s3 = own["S3"]
    even = best(imu, table, s3.seconds / 60, WORST, s3.sigmas)
    half = best(imu, table, s3.seconds / 120, CRITERION, s3.sigmas)
    every = {"designed": own["designed"], "worst": even, "half": half, "S0": own["S0"], "S3": s3}
    rows = list(sigma_rows([plan.sigmas for plan in every.values()]))
    # The worst of a kind, for the three axes are alike.
    kinds: dict[str, list[str]] = {}
    for row in rows:
        kinds.setdefault(row[0].rpartition("_")[0], []).append(row[0])
    index = {row[0]: i for i, row in enumerate(rows)}
    worst = []
    for kind, names in kinds.items():
        places = [index[name] for name in names]
        texts = []
        for number, plan in enumerate(every.values()):
            place = places[int(np.argmax(plan.sigmas[places]))]
            texts.append(rows[place][2 + number])
        most = [float(plan.sigmas[places].max()) for plan in every.values()]
        worst.append([kind, rows[places[0]][1], *texts, f"{most[-1] / most[0]:.2f}"])
    assert even.search is not None and own["designed"].search is not None
    nine = 2 * 3 + 3  # parameters that S3's plan determines as well as any: two biases, a scale
    return {
        "times": [[name, f"{p.seconds / 60:.1f}", str(len(p.items))] for name, p in every.items()],
        "sigmas": worst,
        "efficiency": f"{own['designed'].search.efficiency:.3f}",
        "rms": f"{np.sqrt(np.mean((own['designed'].sigmas / s3.sigmas) ** 2)):.2f}",
        "largest": f"{np.max(own['designed'].sigmas / s3.sigmas):.2f}",
        "even": f"{np.max(even.sigmas / s3.sigmas):.2f}",
        "least": f"{(even.search.bound * (24 / nine) ** 0.125) ** 0.5:.3f}",
        "limits": list(limit_rows([detection_limits(p.data) for p in every.values()])),
    }
