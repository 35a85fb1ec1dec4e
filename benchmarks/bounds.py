"""The joint fit against the Cramér–Rao bound: plans a to e of the design study.

150 campaigns of block statistics for each plan and noise, and three from bytes, through the whole
chain: rms error over the bound, and how often 95 % intervals contain the truth. The bound is
computed independently of the stages (tests/bounds).
"""

from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import chain
import numpy as np
import study_plans as plans
from block_statistics import GRAVITY
from drawn_campaigns import NAMES, least, solved
from numpy.typing import NDArray

import laboratory
from benchmarks.tables import Table
from inertial.arrays import Array

DRAWS, FROM_BYTES, CORES = 150, 3, 2
KINDS = {"bias": "b", "scale": "s", "cross": "N"}
SENSORS = {"accelerometer": "a", "gyroscope": "g"}
COLUMNS = [f"{kind}_{sensor}" for sensor in SENSORS.values() for kind in KINDS.values()]


def measured() -> list[Table]:
    """One table: a row for each plan and noise."""
    table = Table(
        f"Rms error of the joint fit over the Cramér–Rao bound, {DRAWS} campaigns each",
        ("plan, noise", *COLUMNS, "all", "within\n1.96 σ", "from\nbytes"),
    )
    every: list[Array] = []
    with ProcessPoolExecutor(CORES) as pool:
        for plan in plans.PLANS:
            for instrument in plans.NOISE:
                pair = (plan, instrument)
                results = list(pool.map(partial(solved, *pair), range(DRAWS), chunksize=5))
                errors, sigmas = (np.array(part) for part in zip(*results, strict=True))
                few = list(pool.map(partial(from_bytes, *pair), range(FROM_BYTES)))
                whole, _ = (np.array(part) for part in zip(*few, strict=True))
                determined = np.isfinite(sigmas).all(axis=0)
                bound = least(*pair)
                within = np.abs(errors / sigmas)[:, determined] < 1.96
                every.append(within.ravel())
                table.add(
                    f"{plan}, {instrument}",
                    *(_cell(errors / bound, determined, name) for name in COLUMNS),
                    f"{_rms((errors / bound)[:, determined]):.3f}",
                    f"{100 * within.mean():.1f} %",
                    f"{_rms((whole / bound)[:, determined]):.2f}",
                )
    pooled = np.concatenate(every)
    table.remarks += [
        f"All {len(pooled)} intervals together contain the truth in {100 * pooled.mean():.2f} %.",
        "A dash: the plan does not determine it, and no value is given.",
        "Plan e are tumbles: the estimate lets their rests share tilts, which the bound"
        " leaves out.",
        "b bias, s scale factor, N cross terms; a accelerometers, g gyros. An rms of 450 errors"
        " scatters by 3 %.",
    ]
    return [table]


def _cell(ratios: Array, determined: NDArray[np.bool_], column: str) -> str:
    kind, sensor = column.split("_")
    own = np.array(
        [
            KINDS[name.partition("/")[2].partition("_")[0]] == kind
            and SENSORS[name.partition("/")[0]] == sensor
            for name in NAMES
        ]
    )
    return f"{_rms(ratios[:, own & determined]):.3f}" if (own & determined).any() else "–"


def _rms(ratios: Array) -> float:
    return float(np.sqrt(np.mean(ratios**2)))


def from_bytes(plan: str, instrument: str, seed: int) -> tuple[Array, Array]:
    """The same from the logs of the simulated laboratory."""
    document = _document(plan, instrument, seed)
    with TemporaryDirectory() as name:
        folder = Path(name)
        laboratory.write(laboratory.perform(laboratory.specify(document)), folder / "raw")
        results = chain.run(folder / "raw", folder / "derived")
        pairs = [name.split("/") for name in NAMES]
        rows = [results.parameters(stage).loc[parameter] for stage, parameter in pairs]
    values, sigmas = (np.array([row[c] for row in rows], np.float64) for c in ("value", "sigma"))
    return values - np.array(list(_truth(document))), sigmas


def _document(plan: str, instrument: str, seed: int) -> dict[str, Any]:
    gyro, accelerometer = plans.NOISE[instrument]
    demo = chain.demo(seed=seed)
    determined = plans.campaign(plan)
    return {
        **demo,
        "campaign": determined | {"site": determined["site"] | {"gravity_m_s2": GRAVITY}},
        "handling": {
            "still_s": 2,
            "change_s": 8,
            "step": {"rate_deg_s": 20, "accel_deg_s2": 40},
        },
        "noise": {
            "angle_random_walk_deg_sqrt_h": gyro,
            "velocity_random_walk_m_s_sqrt_h": accelerometer,
            "gyro_rate_random_walk_deg_h_sqrt_h": 0,
            "accelerometer_random_walk_m_s2_sqrt_h": 0,
        },
    }


def _truth(document: dict[str, Any]) -> Iterator[float]:
    for sensor, bias in (("accelerometer", "bias_m_s2"), ("gyro", "bias_rad_s")):
        true = document["truth"][sensor]
        yield from (np.array(true["matrix"]) - np.eye(3)).ravel()
        yield from true[bias]
