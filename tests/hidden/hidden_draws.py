"""What is hidden in a campaign: drawn by number, so that every draw can be made again.

A quarter is clean, and hard to be silent on. A third hides one effect: most in a random
direction, as large as a signal-to-noise ratio says; some of a physical size; some that are not
sought in blocks. Decoys hide what every calibration takes up, or one of several that are alike.
Others hide two or three effects, or what is in no catalogue. Beside these every effect has
campaigns of its own, all of which are written and read.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from hidden_courses import scanned
from hidden_elsewhere import ELSEWHERE, HARD, Random
from hidden_outside import OUTSIDE, course_size, recorded
from hidden_plans import PLANS, SPANS, sensors
from hidden_ways import ABSORBED, MATES, POSITIVE, REMEMBERING, WAYS, absorbed

from inertial.effects import CATALOGUE

SEED = 2113  # of all draws; no draw of it was looked at while the pipeline was written
RATIOS = (5.0, 6.0, 8.0, 10.0, 15.0)
BANDS = {"6 to 12": (6.0, 12.0), "12 to 40": (12.0, 40.0)}
# A quarter clean, 35 % singles, 15 % decoys, 15 % several, 10 % outside, well mixed.
KINDS = tuple(
    {"c": "clean", "s": "single", "d": "decoy", "m": "several", "o": "outside"}[letter]
    for letter in "cscsmdsocsmdscsmdsco"
)
CYCLE = len(KINDS)
EACH, EACH_FROM = 20, 1_000_000  # campaigns of every effect, and the number of the first
EACH_RATIOS = (5.0, 6.0, 8.0)  # in turn
COMMON = ("positions", "rates", "positions", "stops", "positions", "positions")  # in turn

Size = Callable[[str, str, float | None, Any], float]


@dataclass(frozen=True)
class Draw:
    """One campaign: its plan, what is hidden in it, in the laboratory's words, and how clearly.

    `sort`: what sort of its kind; `hidden`: the effects that may be named; `truth`: for each
    effect its parameters in the model's units; `at`: what is scanned; `ratios`: the
    signal-to-noise ratio of each; `grade`: of the sensor, the table or the site, whose typical size
    it has; `noise`: changes of it; `twin`: whether the 24 parameters are
    compared with those of the same campaign without the effects; `on_disk`: written and read.
    """

    number: int
    plan: str
    kind: str
    sort: str
    hidden: tuple[str, ...] = ()
    effects: dict[str, Any] = field(default_factory=dict)
    truth: dict[str, dict[str, float]] = field(default_factory=dict)
    at: dict[str, float] = field(default_factory=dict)
    ratios: dict[str, float] = field(default_factory=dict)
    grade: str = ""
    noise: dict[str, Any] = field(default_factory=dict)
    twin: bool = False
    on_disk: bool = False

    def document(self, **changes: Any) -> dict[str, Any]:
        """What the laboratory is told."""
        document = PLANS[self.plan](
            **{"seed": 100_000 * SEED + self.number, "effects": self.effects}
        )
        document["noise"] = {**document["noise"], **self.noise}
        document["truth"] = sensors(np.random.default_rng([SEED + 1, self.number]))
        return document | changes


def draw(number: int, size: Size) -> Draw:
    """The draw of a number.

    `size`: the signal-to-noise ratio that values of an effect have, by plan, name of the effect,
    and the value of what is scanned.
    """
    random = np.random.default_rng([SEED, number])
    if number >= EACH_FROM:
        made = _each(number - EACH_FROM, random, size)
        return _as_moved(Draw(number=number, kind="single", on_disk=True, **made))
    round_, place = divmod(number, CYCLE)
    kind = KINDS[place]
    turn = round_ * KINDS.count(kind) + KINDS[:place].count(kind)  # how many of its kind before
    made = {
        "clean": _clean,
        "single": _single,
        "decoy": _decoy,
        "several": _several,
        "outside": _outside,
    }[kind](turn, random, size, number)
    return _as_moved(Draw(number=number, kind=kind, on_disk=place == round_ % CYCLE, **made))


def _clean(turn: int, random: Random, size: Size, number: int) -> dict[str, Any]:
    hard = HARD[turn % len(HARD)]
    plan = COMMON[turn // len(HARD) % len(COMMON)]
    effects, noise = hard.told(random)
    return {
        "plan": plan,
        "sort": hard.name,
        "hidden": hard.hidden,
        "effects": effects,
        "noise": noise,
        "twin": hard.twin,
    }


def _single(turn: int, random: Random, size: Size, number: int) -> dict[str, Any]:
    turn, place = divmod(turn, 7)
    if place == 6:  # of seven one is sought elsewhere, one has a physical size
        one = ELSEWHERE[turn % len(ELSEWHERE)]
        effects, noise = one.told(random)
        return {
            "plan": one.plan,
            "sort": "elsewhere",
            "hidden": one.hidden,
            "effects": effects,
            "noise": noise,
        }
    names = list(WAYS)
    if place == 5:
        name = names[turn % len(names)]
        plan = _plan_of(name, turn, random)
        sizes = CATALOGUE[name].sizes
        grade = list(sizes)[turn // len(names) % len(sizes)]
        return {"plan": plan, "sort": "physical", "grade": grade} | _hide(
            {name: ("size", sizes[grade])}, plan, random, size
        )
    count = turn * 5 + place
    name = names[count % len(names)]
    ratio = RATIOS[(count // len(names) + count) % len(RATIOS)]
    plan = _plan_of(name, count, random)
    return {"plan": plan, "sort": "ratio"} | _hide({name: ("ratio", ratio)}, plan, random, size)


def numbers_of_each() -> range:
    """Of the campaigns that every effect has of its own, one effect after the other."""
    return range(EACH_FROM, EACH_FROM + EACH * len(WAYS))


def _each(turn: int, random: Random, size: Size) -> dict[str, Any]:
    round_, place = divmod(turn, len(WAYS))
    name, ratio = list(WAYS)[place], EACH_RATIOS[round_ % len(EACH_RATIOS)]
    plan = WAYS[name].plans[(round_ // len(EACH_RATIOS)) % len(WAYS[name].plans)]
    return {"plan": plan, "sort": "ratio"} | _hide({name: ("ratio", ratio)}, plan, random, size)


def _decoy(turn: int, random: Random, size: Size, number: int) -> dict[str, Any]:
    half, mates = divmod(turn, 2)
    if mates:
        plan, name = MATES[half % len(MATES)]
        ratio = float(np.exp(random.uniform(np.log(8), np.log(20))))
        return {"plan": plan, "sort": "mates"} | _hide({name: ("ratio", ratio)}, plan, random, size)
    names = list(ABSORBED)
    name = names[half % len(names)]
    plans = [plan for plan in COMMON if absorbed(name, plan)]
    plan = plans[half // len(names) % len(plans)]
    much = float(random.choice([-1, 1]) * np.exp(random.uniform(np.log(0.3), np.log(3))))
    effects = {name: ABSORBED[name](much)}
    return {"plan": plan, "sort": "absorbed", "hidden": (name,), "effects": effects}


def _several(turn: int, random: Random, size: Size, number: int) -> dict[str, Any]:
    count = 2 + turn % 2
    band = list(BANDS)[turn // 2 % 2]
    plan = COMMON[turn // 4 % len(COMMON)]
    shown = [name for name, way in WAYS.items() if plan in way.plans]
    chosen = [str(name) for name in random.choice(shown, count, replace=False)]
    wanted = {
        name: ("ratio", float(np.exp(random.uniform(*np.log(BANDS[band]))))) for name in chosen
    }
    return {"plan": plan, "sort": f"{count} at {band}"} | _hide(wanted, plan, random, size)


def _outside(turn: int, random: Random, size: Size, number: int) -> dict[str, Any]:
    one = OUTSIDE[turn % len(OUTSIDE)]
    plan = COMMON[turn // len(OUTSIDE) % len(COMMON)]
    effects = one.told(random, 1.0, SPANS[plan])
    ratios = {}
    if one.scales:
        ratio = float(np.exp(random.uniform(np.log(12), np.log(40))))
        unit = course_size(Draw(number, plan, "outside", one.name, effects=effects).document())
        effects = one.scaled(effects, ratio / unit(plan))
        ratios = {one.name: ratio}
    if "clock_step" in effects:
        document = Draw(number, plan, "outside", one.name).document()
        at = recorded(document, effects["clock_step"]["at_s"])
        effects = {"clock_step": effects["clock_step"] | {"at_s": at}}
    return {
        "plan": plan,
        "sort": one.name,
        "hidden": one.hidden,
        "effects": effects,
        "ratios": ratios,
    }


def _plan_of(name: str, turn: int, random: Random) -> str:
    """One of the plans that show an effect; the demo's more often."""
    plans = [plan for plan in COMMON if plan in WAYS[name].plans]
    return str(random.choice(plans))


def _hide(
    wanted: dict[str, tuple[str, float]], plan: str, random: Random, size: Size
) -> dict[str, Any]:
    """Effects in random directions, by their signal-to-noise ratio or by their size."""
    told: dict[str, Any] = {"hidden": tuple(wanted)}
    told |= {key: {} for key in ("effects", "truth", "at", "ratios")}
    for name, (by, amount) in wanted.items():
        way = WAYS[name]
        direction = random.normal(size=len(way.names))
        if name in POSITIVE:
            direction = np.abs(direction)
        extra = {}
        if way.scan is not None:
            told["at"][name] = float(random.choice(scanned(way, plan)))
            extra = {way.scan[0]: told["at"][name]}
        unit = size(plan, name, told["at"].get(name), direction)
        factor = amount / unit if by == "ratio" else amount
        values = direction * factor
        told["effects"][name] = way.told(values) | extra
        told["truth"][name] = dict(zip(way.names, values.tolist(), strict=True))
        told["ratios"][name] = unit * factor
    return told


def _as_moved(one: Draw) -> Draw:
    """The draw with its ratio in its own campaign, for what remembers forces.

    How the table moves to a position whose azimuth the plan does not state, each campaign draws
    for itself; by the moves of the reference the ratio would be up to a quarter off.
    """
    for name in set(REMEMBERING) & set(one.truth):
        alone = replace(one, effects={name: one.effects[name]})
        ratio = course_size(alone.document())(one.plan)
        if one.sort == "physical":
            one = replace(one, ratios=one.ratios | {name: ratio})
            continue
        factor = one.ratios[name] / ratio
        values = {key: factor * value for key, value in one.truth[name].items()}
        effect = WAYS[name].told(np.array([*values.values()]))
        one = replace(one, effects=one.effects | {name: effect}, truth=one.truth | {name: values})
    return one
