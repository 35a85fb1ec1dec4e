"""What is drawn, in which plan and how large; each from its own name, so that it can be made again.

Gravity and sensors are drawn anew for each campaign: gravity as far from the stated one as its
sigma says, and where none is stated as far from the formula's as that of the formula says.
"""

import json
import zlib
from collections.abc import Callable, Collection, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cache
from typing import Any

import cases
import numpy as np
from campaigns import performed, tables_of
from cases import Cause, cause
from diagnosis_faults import BY_NAME, FAULTS, FORMULA_SIGMA, Place, Setting
from hidden_draws import COMMON, _hide
from hidden_elsewhere import ELSEWHERE
from hidden_plans import PLANS, sensors
from hidden_sizes import KEPT, code, reference, size
from hidden_ways import ABSORBED, WAYS, absorbed

from inertial.effects import CATALOGUE
from inertial.text.parameters import STAGES
from laboratory.site import normal_gravity

RATIOS = (15.0, 30.0)
SIGMAS = (2.0, 5.0, 20.0)
PAIRS, CLEAN, SILENT, REPORTED = 60, 300, 3, 5  # campaigns; the last two of each and plan
BETWEEN = (15.0, 40.0)  # the signal-to-noise ratio of an effect in what a fault leaves
LEFT = 0.5  # of its ratio that an effect keeps at least where the fault has spoiled the readings
STATED_SIGMA = 5e-5  # m/s², of the gravity that the demo states

Document = dict[str, Any]
Random = np.random.Generator
Told = Callable[[Random], Document]


@dataclass(frozen=True)
class Drawn:
    """One campaign: `changes` of the plan's document, and the rows that are right.

    `part`: effect, fault, absorbed, reported, pair or clean; `what`: in words; `size`: SNR or
    sigma; `ratio`: the signal-to-noise ratio of an effect.
    """

    name: str
    part: str
    plan: str
    what: str
    size: float | None
    changes: Document
    causes: tuple[Cause, ...] = ()
    ratio: float | None = None
    document: Document = field(default_factory=dict)


def names() -> Iterator[str]:
    """All draws, in the order in which they are run: the parts well mixed."""
    parts = [list(part) for part in (_effects(), _faults(), _absorbed(), _reported(), _pairs())]
    parts.append([f"clean|{COMMON[n % len(COMMON)]}||{n}" for n in range(CLEAN)])
    placed = [(i / len(part), name) for part in parts for i, name in enumerate(part)]
    return iter([name for _, name in sorted(placed)])


def _effects() -> Iterator[str]:
    for ratio in RATIOS:
        for name, way in WAYS.items():
            yield from (f"effect|{plan}|{name}|{ratio:g}" for plan in way.plans)


def _faults() -> Iterator[str]:
    for sigma in SIGMAS:
        for fault in FAULTS:
            yield from (f"fault|{plan}|{fault.name}|{sigma:g}" for plan in fault.plans)


def _absorbed() -> Iterator[str]:
    for number in range(SILENT):
        for name in filter(_absorbed_by_all, ABSORBED):
            plans = (plan for plan in PLANS if absorbed(name, plan))
            yield from (f"absorbed|{plan}|{name}|{number}" for plan in plans)


def _absorbed_by_all(name: str) -> bool:
    """Whether every calibration takes it up; the rest of the decoys are known too little."""
    return bool(CATALOGUE[name].absorbed_by)


def _reported() -> Iterator[str]:
    for number in range(REPORTED):
        yield from (f"reported|{plan}|{name}|{number}" for name, (plan, _) in WITHOUT_BAR.items())


def _pairs() -> Iterator[str]:
    plans = list(PLANS)
    yield from (f"pair|{plans[n % len(plans)]}||{n}" for n in range(PAIRS))


def _elsewhere(*hidden: str) -> tuple[str, Told]:
    """The plan and the draws of an effect that is sought elsewhere than in the blocks."""
    own = next(one for one in ELSEWHERE if one.hidden == hidden)
    return own.plan, lambda random: own.told(random)[0]


DEAD_BANDS = tuple(f"gyro_dead_band_{axis}" for axis in "xyz")
WITHOUT_BAR: Mapping[str, tuple[str, Told]] = {
    "gyro_dead_band": _elsewhere(*DEAD_BANDS),
    "gyro_saturation": _elsewhere("gyro_saturation"),
    "accel_saturation": _elsewhere("accel_saturation"),
}


def drawn(name: str) -> Drawn:
    """The draw of a name: `part|plan|what|size`."""
    part, plan, what, number = name.split("|")
    random = np.random.default_rng([2033, zlib.crc32(name.encode())])
    document = _document(plan, random)
    made = PARTS[part](plan, what, float(number), random, document)
    made.pop("spoiled", None)
    return Drawn(
        **made | {"name": name, "part": part, "plan": plan},
        document=cases.merged(document, made["changes"]),
    )


def _document(plan: str, random: Random) -> Document:
    """A clean campaign of a plan: sensors and gravity by chance, gravity stated or not."""
    document = PLANS[plan](seed=int(random.integers(2**31)))
    site = document["campaign"]["site"]
    document["truth"] = sensors(random)
    if random.random() < 0.5:
        height = random.normal(site["height_m"], 3.0)
        true = normal_gravity(np.radians(site["latitude_deg"]), height)
        true += random.normal(0, FORMULA_SIGMA)
        document["campaign"]["site"] = {key: site[key] for key in ("latitude_deg", "height_m")}
    else:
        true = site["gravity_m_s2"] + random.normal(0, STATED_SIGMA)
    document["truth"]["gravity_m_s2"] = float(true)
    return document


def _stated(document: Document) -> None:
    """The site of the demo, gravity stated: for faults of that statement."""
    site = PLANS["positions"]()["campaign"]["site"]
    document["campaign"]["site"] = site
    document["truth"]["gravity_m_s2"] = site["gravity_m_s2"]


def ratio_without(
    plan: str, name: str, at: float | None, values: Any, spoiled: Collection[str]
) -> float:
    """The signal-to-noise ratio of an effect in a plan of which some manoeuvres are spoiled."""
    known = reference(plan)
    family = known.campaign.candidates([CATALOGUE[name]])[name]
    effect = min(family, key=lambda one: abs((one.at or 0.0) - (at or 0.0)))
    kept = set(known.campaign.manoeuvres) - set(spoiled)
    squared = 0.0
    for system in known.campaign.systems([effect], 1.0, kept):
        if system is not None:
            squared += float(values @ system.effect_information().information @ values)
    return float(np.sqrt(max(squared, 0.0)))


def _effect(
    plan: str, what: str, ratio: float, random: Random, document: Document
) -> dict[str, Any]:
    hidden = _hide({what: ("ratio", ratio)}, plan, random, size)
    return {
        "what": what,
        "size": ratio,
        "ratio": ratio,
        "changes": cases.effect(**hidden["effects"]),
        "causes": (cause({what}),),
    }


def _fault(
    plan: str, what: str, sigma: float, random: Random, document: Document
) -> dict[str, Any]:
    fault = BY_NAME[what]
    if "gravity" in what:
        _stated(document)
    told = fault.hide(Setting(document, places(plan), sigmas(plan)), random, sigma)
    return {
        "what": what,
        "size": sigma if fault.sized else None,
        "changes": told.changes,
        "causes": (told.cause,),
        "spoiled": told.spoiled,
    }


def _silent(
    plan: str, what: str, number: float, random: Random, document: Document
) -> dict[str, Any]:
    much = float(random.choice([-1, 1]) * np.exp(random.uniform(np.log(0.3), np.log(3))))
    told = ABSORBED[what](much)
    return {"what": what, "size": much, "changes": cases.effect(**{what: told})}


def _without_bar(
    plan: str, what: str, number: float, random: Random, document: Document
) -> dict[str, Any]:
    told = WITHOUT_BAR[what][1](random)
    saturated = what.endswith("saturation")
    # Each gyro has a dead band of its own.
    each = [{what, "saturation"}] if saturated else [{name} for name in DEAD_BANDS]
    return {
        "what": what,
        "size": None,
        "changes": cases.effect(**told),
        "causes": tuple(map(cause, each)),
    }


def _pair(
    plan: str, what: str, number: float, random: Random, document: Document
) -> dict[str, Any]:
    shown = [name for name, way in WAYS.items() if plan in way.plans]
    faults = [fault.name for fault in FAULTS if plan in fault.plans]
    fault, ratio = str(random.choice(faults)), float(np.exp(random.uniform(*np.log(BETWEEN))))
    other = _fault(plan, fault, float(random.choice(SIGMAS[1:])), random, document)
    share = 0.0
    while share < LEFT:  # else the fault leaves too little to see the effect by
        effect = str(random.choice([o for o in shown if o not in other["causes"][0].names]))
        hidden = _hide({effect: ("ratio", ratio)}, plan, random, size)
        values = np.array(list(hidden["truth"][effect].values()))
        left = ratio_without(plan, effect, hidden["at"].get(effect), values, other["spoiled"])
        share = left / ratio
    way, extra = WAYS[effect], hidden["effects"][effect]
    told = extra | way.told(values / share)
    return {
        "what": f"{fault} + {effect}",
        "size": other["size"],
        "ratio": ratio,
        "changes": cases.effect(**{effect: told}) | other["changes"],
        "causes": (*other["causes"], cause({effect})),
    }


def _clean(
    plan: str, what: str, number: float, random: Random, document: Document
) -> dict[str, Any]:
    return {"what": "", "size": None, "changes": {}}


PARTS = {
    "effect": _effect,
    "fault": _fault,
    "absorbed": _silent,
    "reported": _without_bar,
    "pair": _pair,
    "clean": _clean,
}


@cache
def places(plan: str) -> tuple[Place, ...]:
    """Where each manoeuvre of a plan stands in its log; tumbles are left out."""
    document = PLANS[plan]()
    told = {one["id"]: one for one in document["campaign"]["plan"] if one["do"] != "tumble"}
    return tuple(
        Place(name, log, rows, told[name]["up"], told[name]["do"] == "turn")
        for log, truth in performed(document).truth.items()
        for name, rows in truth.rows.items()
        if name in told
    )


@cache
def sigmas(plan: str) -> dict[str, dict[str, float]]:
    """The sigmas of the 24 parameters of a clean campaign, kept on disk as the code is the same."""
    file = KEPT / f"sigmas-{plan}-{code()}.json"
    if not file.exists():
        tables = tables_of(PLANS[plan](), "gyroscope")
        found = {
            sensor: tables.parameters(stage)["sigma"].dropna().to_dict()
            for sensor, stage in STAGES.items()
        }
        KEPT.mkdir(parents=True, exist_ok=True)
        file.write_text(json.dumps(found), encoding="utf-8")
    kept: dict[str, dict[str, float]] = json.loads(file.read_text(encoding="utf-8"))
    return kept
