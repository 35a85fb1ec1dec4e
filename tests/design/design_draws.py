"""Designs recorded by the simulated laboratory: errors in foreseen sigmas, and classes split.

`designed` and `S3`: the plan in the time of S3's, and S3's own, of an instrument on a table, M,
biases, position errors and noise by chance. Every draw gives 24 errors, each over the sigma that
was foreseen before anything was recorded. `logs`: the simulated laboratory records logs, which all
stages take; `blocks`: means of blocks by the physics of tests/bounds, of which there are many more.

`class`: an effect is hidden in a campaign, so large that it is found but in a class; what to record
next is designed, recorded with the campaign, and judged again.
"""

import sys
from dataclasses import replace
from functools import cache
from hashlib import sha256
from pathlib import Path
from typing import Any

import chain
import numpy as np
from drawn_campaigns import planned_as, solved_as
from hidden_plans import PLANS, sensors
from resumable import Outcome
from ruamel.yaml import YAML

from commands.design import for_campaign
from commands.design.__main__ import SHARE, source_plans
from commands.design.for_campaign import Splitting, classes_of
from commands.design.from_nothing import Designed, best, foreseen_of
from commands.design.printed import new_campaign
from commands.design.turntable import instrument, turntable
from commands.design.visits import possible
from inertial.campaign.foreseen import session_seconds
from inertial.estimation.triad import linear_names

INSTRUMENT, TABLE = "imar-fsas", "three-axis"
CRITERION = "A"
DATA = chain.ROOT / "data"
PULLS = ("designed, blocks", "S3, blocks", "designed, logs", "S3, logs")
RATE_HZ = 100  # of the logs
STILL = 3.0  # s, of which 2 s are used, as the blocks have it
# Plan, effect and its parameter in the laboratory, and a size that is found, but in a class.
CLASSES: dict[str, tuple[str, str, str, float]] = {
    "quadratic": ("stops", "gyro_scale_quadratic", "k2_ppm_per_deg_s", 2.0),
    "cubic": ("stops", "gyro_scale_cubic", "k3_ppm_per_deg_s_2", 0.06),
    "acceleration": ("stops", "gyro_scale_g_dependence", "k_ppm_g", 20.0),
    "K2": ("positions", "accel_quadratic", "k2_micro_g_g2", 60.0),
    "asymmetry": ("positions", "accel_scale_asymmetry", "asymmetry_micro_g_g", 60.0),
}
DESIGNING = ("turntable", "visits", "from_nothing", "for_campaign")  # commands/design
SCATTER = 0.2  # of the size, about it
PARTS = {**dict(zip(PULLS, (40, 40, 20, 20), strict=True)), **dict.fromkeys(CLASSES, 12)}


@cache
def code() -> str:
    """Hash of what the outcomes rest on: the designs, and how they are drawn."""
    names = ("estimation/optimal_design.py", "model_selection/splitting.py", "campaign/foreseen.py")
    files = [chain.ROOT / "inertial" / name for name in names]
    files += [DATA / "tables.yaml", Path(__file__)]
    files += [chain.ROOT / f"commands/design/{name}.py" for name in DESIGNING]
    return sha256(b"".join(file.read_bytes() for file in files)).hexdigest()[:16]


@cache
def plans() -> dict[str, Designed]:
    """The designed plan, of the time of S3's, and those of S0 and S3, with their sigmas."""
    imu, table = instrument(INSTRUMENT, DATA), turntable(TABLE, DATA)
    beside = source_plans(imu, table)
    s3 = beside["S3"]
    return {"designed": best(imu, table, s3.seconds / 60, CRITERION, s3.sigmas), **beside}


def outcome(part: str, number: int) -> Outcome:
    """One draw of a part."""
    random = np.random.default_rng([number, *map(ord, part)])
    name, _comma, kind = part.partition(", ")
    if part in CLASSES:
        made = _split(part, random)
    else:
        made = (_by_blocks if kind == "blocks" else _by_logs)(name, random)
    return {"part": part, "number": number, "code": code()} | made


def _by_blocks(name: str, random: np.random.Generator) -> Outcome:
    """Errors of the 24 parameters in foreseen sigmas, and the stated sigmas over those."""
    table, plan, imu = turntable(TABLE, DATA), plans()[name], instrument(INSTRUMENT, DATA)
    paced = replace(table, entry=table.entry | {"still_s": STILL})
    sigmas = foreseen_of(plan.items, paced, imu.noise).sigmas
    content = YAML(typ="safe").load(new_campaign("drawn", imu, table, plan.items, 0.0))
    white = [imu.noise.of("", "rest", [f"{s}_{axis}" for axis in "xyz"]) for s in ("accel", "gyro")]
    errors, stated = solved_as(planned_as(content), np.concatenate(white), random)
    return {"pulls": (errors / sigmas).tolist(), "stated": (stated / sigmas).tolist()}


def _by_logs(part: str, random: np.random.Generator) -> Outcome:
    """The same by the simulated laboratory."""
    table, plan = turntable(TABLE, DATA), plans()[part]
    imu = instrument(INSTRUMENT, DATA)
    text = new_campaign(part.lower(), imu, table, plan.items, plan.seconds / 60)
    truth = sensors(random)
    gyro, force = imu.entry["gyro"], imu.entry["accelerometer"]
    document = chain.demo(truth=truth, seed=int(random.integers(2**31)))
    document["campaign"] = YAML(typ="safe").load(text) | {"date": "2026-11-02"}
    document["campaign"]["instrument"] = imu.entry | {"rate_hz": RATE_HZ}
    document["receiver"] |= {
        "rate_hz": RATE_HZ,
        "gyro_count_rad": gyro["count_rad"],
        "accelerometer_count_m_s": force["count_m_s"],
    }
    document["noise"] |= {
        "angle_random_walk_deg_sqrt_h": gyro["angle_random_walk_deg_sqrt_h"],
        "velocity_random_walk_m_s_sqrt_h": force["velocity_random_walk_m_s_sqrt_h"],
    }
    document["handling"] = {"still_s": table.pace.still, "change_s": table.pace.change}
    found = chain.in_memory_of(document, "gyroscope", without=chain.BESIDE)
    errors, stated = [], []
    for stage, key, bias in (
        ("accelerometer", "accelerometer", "bias_m_s2"),
        ("gyroscope", "gyro", "bias_rad_s"),
    ):
        rows = found.parameters(stage)
        true = np.append(np.array(truth[key]["matrix"]) - np.eye(3), truth[key][bias])
        errors.append(rows.loc[list(linear_names()), "value"].to_numpy(float) - true)
        stated.append(rows.loc[list(linear_names()), "sigma"].to_numpy(float))
    pulls = np.concatenate(errors) / plan.sigmas
    return {"pulls": pulls.tolist(), "stated": (np.concatenate(stated) / plan.sigmas).tolist()}


def _split(part: str, random: np.random.Generator) -> Outcome:
    """Whether the hidden effect is the likeliest of its class, before and after the design."""
    plan, effect, parameter, size = CLASSES[part]
    seed = int(random.integers(2**31))
    sizes = size * (1 + SCATTER * random.normal(size=3)) * random.choice([-1, 1], 3)
    hidden = {effect: {parameter: sizes.tolist()}}
    document = PLANS[plan](effects=hidden, truth=sensors(random), seed=seed)
    first = chain.in_memory_of(document, "criticism", without=chain.BESIDE)
    names = ("findings", "members", "scores")
    classes = classes_of(*(first[f"criticism/{name}"] for name in names))
    mine = [each for each in classes if effect in each.members]
    if not mine:
        return {"class": []}
    (data,) = chain.mounts(first)
    table = replace(turntable(TABLE, DATA), known=data.known)
    own = session_seconds(data.plan, table.pace)
    visits = possible(
        table,
        instrument("span-cpt", DATA).max_rate,
        for_campaign.RESTS,
        for_campaign.RATE_SHARES,
        for_campaign.TURNING,
        both=False,
        single=True,
    )
    added = Splitting(data, mine[0], table).best(visits, SHARE * own)
    made: Outcome = {"class": list(mine[0].members), "before": added.before, "after": added.after}
    made |= {"share": added.seconds / own, "seconds": added.seconds}
    return made | _again(document, added.items, effect, seed)


def _again(document: dict[str, Any], items: list[Any], effect: str, seed: int) -> Outcome:
    """The campaign with what is added, recorded anew: what is named, and how surely."""
    plan = document["campaign"]["plan"]
    suffix = Path(plan[0].get("log", document["campaign"].get("log"))).suffix
    document["campaign"]["plan"] = [*plan, *(item | {"log": f"next{suffix}"} for item in items)]
    document["handling"] |= {"change_s": turntable(TABLE, DATA).pace.change}
    document["seed"] = seed + 1
    second = chain.in_memory_of(document, "criticism", without=chain.BESIDE)
    members, findings = second["criticism/members"], second["criticism/findings"]
    own = members[(members["effect"] == effect)]
    best_ranked = [str(name) for name in members.loc[members["rank"] == 1, "effect"]]
    classes = [
        members.loc[members["finding"] == finding, "effect"].tolist() for finding in own["finding"]
    ]
    return {
        "right": effect in best_ranked,
        "alone": [effect] in classes,
        "named": findings["cause"].tolist(),
    }


if __name__ == "__main__":
    sys.stdout.write(f"{outcome(sys.argv[1], int(sys.argv[2]))}\n")
