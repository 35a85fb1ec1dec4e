"""A campaign with a hidden law, drawn by number, and what the stages say of it."""

from functools import cache
from typing import Any

import chain
import numpy as np
from hidden_plans import sensors
from law_bayes import chosen
from law_families import FAMILIES, Family, Random, plan_document
from law_reference import captured, clean, course, equations_of, remaining
from resumable import code_of_outcomes

from inertial.campaign.equations import Campaign
from inertial.effects import CATALOGUE, LAWS
from inertial.effects.law import Law
from inertial.physics.effect import Effect

SEED = 301_126  # of all draws; none of it was looked at while the search was written
RATIOS = (12.0, 20.0, 30.0)  # signal-to-noise ratio beside the best effect of the catalogue
DRAWN_BY = ("bayes", "draws", "families", "reference")
BESIDE = ("studies", "comparison", "compensation")
CLEAR = ("found", "one_of_class")
MIN_CAPTURED = 0.90  # of each other: one class of form
SINGLE = 0.75  # share of the draws in one axis alone


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    own = [chain.ROOT / f"tests/laws/law_{name}.py" for name in DRAWN_BY]
    return code_of_outcomes(chain.up_to("extension"), own)


def direction(random: Random) -> np.ndarray:
    """One axis in most draws, else all of them."""
    if random.random() < SINGLE:
        return np.eye(3)[random.integers(3)] * random.choice([-1.0, 1.0])
    every = random.normal(size=3)
    return every / np.linalg.norm(every)


def outcome(number: int) -> dict[str, Any]:
    """Of a draw; an error is counted, and the others go on."""
    made = {"number": number, "code": code()}
    try:
        return made | hidden(number)
    except Exception as error:
        return made | {"error": f"{type(error).__name__}: {error}"}


def hidden(number: int) -> dict[str, Any]:
    """Whether the form of a hidden law is found, and what is gained."""
    turn, place = divmod(number, len(FAMILIES))
    family, ratio = FAMILIES[place], RATIOS[turn % len(RATIOS)]
    plan = family.plans[(turn // len(RATIOS) + turn) % len(family.plans)]
    random = np.random.default_rng([SEED, number])
    numbers, axes = random.random(2), direction(random)
    unit = remaining(clean(plan)[0], course(family, numbers, plan, axes, number))
    sizes = axes * ratio / unit
    told = family.told(numbers, plan, sizes)
    document = plan_document(plan, effects=told, seed=number)
    document["truth"] = sensors(random)
    results = chain.in_memory_of(document, "extension", BESIDE)
    campaign, known = equations_of(results), course(family, numbers, plan, sizes, number)
    guess = chosen(campaign, family.sensor, plan)
    return {
        "plan": plan,
        "family": family.title,
        "ratio": ratio,
        "axes": int(np.sum(axes != 0)),
        "bayes": guess.title,
        "bayes_right": captured(campaign, known, guess.course, guess.sizes) >= MIN_CAPTURED,
    } | said(results, campaign, family, known)


def said(
    results: chain.Results, campaign: Campaign, family: Family, known: Effect
) -> dict[str, Any]:
    """The names, whether the law has the form of the course, and the gain."""
    findings = results["criticism/findings"].to_dict("records")
    named = [{"cause": row["cause"], "verdict": row["verdict"]} for row in findings]
    clear = [row["cause"] for row in findings if row["verdict"] in CLEAR]
    wrong = [cause for cause in clear if cause in CATALOGUE and "random_walk" not in cause]
    found = laws_of(results)
    beside = [effect for effect, _values in effects_of(results, CATALOGUE)]
    shares = [captured(campaign, known, law, sizes, beside) for law, sizes in found]
    gain = results["extension/gain"]
    held = gain[gain["axis"].isna() & (gain["scope"] == "held-out")]
    held = held[held["sensor"] == family.sensor]
    return {
        "named": named,
        "laws": [law.label for law, _sizes in found],
        "captured": max(shares, default=0.0),
        "right": max(shares, default=0.0) >= MIN_CAPTURED,
        "wrong": wrong if not found else [],
        "wrong_beside": wrong if found else [],
        "gain": [
            [float(row["drop"]), float(row["snr_squared"])]
            for row in held.to_dict("records")
            if found
        ],
    }


def laws_of(results: chain.Results) -> list[tuple[Law, np.ndarray]]:
    """The named laws with their sizes."""
    return [(law, values) for law, values in effects_of(results, LAWS) if isinstance(law, Law)]


def effects_of(results: chain.Results, among: Any) -> list[tuple[Effect, np.ndarray]]:
    """The named effects among some, with their sizes."""
    findings = results["criticism/findings"]
    table = results["criticism/effects"]
    made = []
    for row in findings.itertuples():
        if row.cause not in among or row.verdict not in (*CLEAR, "law"):
            continue
        own = table[(table["finding"] == row.id) & (table["effect"] == row.cause)]
        values = dict(zip(own["parameter"], own["value"], strict=True))
        effect = among[row.cause].as_named(values)
        if effect.sought_in == "blocks" and all(p.name in values for p in effect.parameters):
            made.append((effect, np.array([values[p.name] for p in effect.parameters], float)))
    return made
