"""A drift of gyro biases drawn on the blocks of a plan: what the stages take it for, and the limit.

White noise, random walk and laws are the laboratory's own, reduced to the means that the equations
of a clean campaign of the plan consist of. The limit of walk against law is the likelihood-ratio
test that knows the sizes, and that nothing else is there; sign, axis and time it averages over as
they are drawn. By Neyman and Pearson no test is right more often.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import chain
import numpy as np
from hidden_courses import RATE, Course, _start, known_course, told
from hidden_plans import PLANS, SPANS
from hidden_ways import WAYS
from resumable import code_of_outcomes
from scipy.special import logsumexp

import laboratory
from inertial.arrays import Array, Integers
from inertial.campaign.effect_evidence import evidence
from inertial.campaign.equations import Campaign
from inertial.campaign.observations import campaign_of
from inertial.effects import CATALOGUE
from inertial.estimation import gyroscopes
from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.gyroscope_observations import StaticRate
from inertial.estimation.random_walk import NO_DRIFT
from laboratory import Recording
from stages.criticism.bias_drift import HalfWave, drift_name
from stages.criticism.laws import with_laws
from stages.criticism.residual_structure import structure_tests
from stages.criticism.selection import Selection
from stages.criticism.stage import BLOCKS_SHARE, STRUCTURE_SHARE, TEMPERATURE_SHARE
from stages.criticism.temperature_functions import select_with_temperature

Document = dict[str, Any]

SEED = 72_119  # of all draws
LAWS = ("gyro_bias_ramp", "gyro_bias_jump", "gyro_warm_up")  # each in one axis
WALKS = {"walk of one axis": 1, "walk of three axes": 3}
KINDS = (*WALKS, *LAWS)
RATIOS = (8.0, 16.0)  # signal-to-noise ratio; of a walk the root of the mean of its square
SCANNED = 7  # times of a jump, time constants
WAVES = 48  # of the expansion of a walk
UNIT = np.radians(1 / 3600) / 60  # 1 °/h/√h in rad/s/√s
CLEAR = ("found", "one_of_class", "law")
LEVEL = chain.SETTINGS["criticism"]["level"]
IN_BLOCKS = [effect for effect in CATALOGUE.values() if effect.sought_in == "blocks"]


@cache
def code() -> str:
    """A hash of all that an outcome rests on."""
    own = [
        chain.ROOT / f"tests/{name}.py"
        for name in ("walks/walk_draws", "walks/walk_guess", "chain")
    ]
    own += (chain.ROOT / "tests/hidden").glob("hidden_*.py")
    return code_of_outcomes([*chain.up_to("gyroscope"), "criticism"], own)


# ---- The laboratory on the blocks of a plan.


@dataclass(frozen=True)
class Quiet:
    """A campaign of a plan without noise, and what it would say of laws and walks.

    `rests`: of the gyros at rest, not in pieces; `started`: when each log began, s; `courses`: of
    each law those of three axes for each value of its scan; `said`: of these and of the half waves
    of a walk; `degrees`: of freedom of the noise.
    """

    campaign: Campaign
    rests: Sequence[StaticRate]
    started: Mapping[str, float]
    courses: Mapping[str, Sequence[Course]]
    said: EffectInformation
    degrees: float

    def law(self, name: str) -> Integers:
        """The columns of a law, (values, 3)."""
        count = {law: 3 * len(courses) for law, courses in self.courses.items()}
        first = sum(count[law] for law in LAWS[: LAWS.index(name)])
        return np.arange(first, first + count[name]).reshape(-1, 3)

    @property
    def walk(self) -> Integers:
        """The columns of the half waves, (WAVES, 3): behind those of the laws."""
        return np.arange(-3 * WAVES, 0).reshape(-1, 3) + len(self.said.names)

    @property
    def variances(self) -> Array:
        """Of the half waves for K = 1, (WAVES,): 2 T/(k π)², after Karhunen and Loève."""
        span = float(np.ptp(self.campaign.motion.time))
        return np.asarray(2 * span / (np.pi * np.arange(1, WAVES + 1)) ** 2)

    def of(self, campaign: Campaign) -> EffectInformation:
        """What a campaign says of laws and walks."""
        laws = [course for own in self.courses.values() for course in own]
        return evidence(campaign, [*laws, *half_waves()]).total


def half_waves() -> list[HalfWave]:
    """Those of the gyros."""
    return [HalfWave("gyro", k) for k in range(1, WAVES + 1)]


def document_of(plan: str, noise: Mapping[str, float], seed: int, **effects: Any) -> Document:
    """A plan with another noise and with effects."""
    document = PLANS[plan](seed=seed, effects=effects)
    return document | {"noise": document["noise"] | dict(noise)}


def recorded(plan: str, noise: Mapping[str, float], seed: int = 0, **effects: Any) -> Recording:
    """The same as slowly as integrals are exact."""
    document = document_of(plan, noise, seed, **effects)
    document["receiver"] = document["receiver"] | {"rate_hz": RATE}
    if document["receiver"].get("message") == "columns":
        document["campaign"]["instrument"] |= {"rate_hz": RATE}
    return laboratory.perform(laboratory.specify(document))


def noise_of(recording: Recording, started: Mapping[str, float] | None = None) -> Course:
    """All that is noise in a recording."""
    truth = {log: replace(one, noisy=one.noiseless) for log, one in recording.truth.items()}
    return known_course("noise", [recording], replace(recording, truth=truth), started)


def added(campaign: Campaign, course: Course, sizes: Array) -> Campaign:
    """The campaign whose readings have a course more, `sizes` of it, (p,)."""
    more, inputs = course.signature(campaign.motion), campaign.inputs
    gyro, accel = more.gyro @ sizes, more.accel @ sizes
    rates = [
        replace(rate, mean=rate.mean + off)
        for rate, off in zip(inputs.static_rates, gyro, strict=False)
    ]
    place, turns = len(rates), []
    for turn, motion in zip(inputs.turns, campaign.turn_motions, strict=True):
        off = gyro[place : place + len(motion.rate)] * motion.seconds[:, None]
        turns.append(replace(turn, sums=turn.sums + off))
        place += len(motion.rate)
    forces = [
        (name, replace(force, mean=force.mean + off), motion)
        for (name, force, motion), off in zip(campaign.static_forces, accel[place:], strict=True)
    ]
    inputs = replace(inputs, turns=turns)
    vars(inputs)["static_rates"] = rates  # a cached property, of the positions
    return replace(campaign, inputs=inputs, static_forces=forces, _linear={})


@cache
def quiet(plan: str) -> Quiet:
    """A plan's clean campaign, its own noise taken out."""
    recording = laboratory.perform(laboratory.specify(document_of(plan, {}, SEED)))
    started = {log: _start(truth) for log, truth in recording.truth.items()}
    (data,) = chain.mounts(chain.in_memory(recording, "gyroscope"))
    campaign = replace(campaign_of(data), drifts=dict.fromkeys(("gyro", "accel"), NO_DRIFT))
    campaign = added(campaign.without_random_walks(), noise_of(recording), -np.ones(1))
    plain, courses = recorded(plan, {}), {}
    for name in LAWS:
        units = np.diag([parameter.typical for parameter in CATALOGUE[name].parameters])
        courses[name] = [
            known_course(
                f"{name} {at}",
                [recorded(plan, {}, **{name: told(name, unit, at)}) for unit in units],
                plain,
                started,
            )
            for at in _values(name, plan)
        ]
    rests, degrees = data.gyro_inputs.of_known_attitude.static_rates, data.noise.degrees
    made = Quiet(campaign, rests, started, courses, None, degrees)  # type: ignore[arg-type]
    return replace(made, said=made.of(campaign))


def _values(name: str, plan: str) -> list[Any]:
    """What is scanned of the laboratory's law."""
    way = WAYS[name]
    if way.scan is None:
        return [None]
    scale = SPANS[plan] if way.share else 1.0
    return (scale * np.linspace(*way.scan[1:], SCANNED)).tolist()


# ---- A draw.


@dataclass(frozen=True)
class Hidden:
    """What is hidden. `walk`: K of each axis, (3,); `columns`, `sizes`: of a law, (1,)."""

    walk: Array
    columns: Sequence[int] = ()
    sizes: Sequence[float] = ()


def hidden(known: Quiet, kind: str, ratio: float, random: np.random.Generator) -> Hidden:
    """A kind of a given ratio: axis, sign and time by chance."""
    axis = int(random.integers(3))
    if kind in WALKS:
        axes = [axis] if WALKS[kind] == 1 else [0, 1, 2]
        size = ratio / np.sqrt(signal_of_walk(known, axes))
        return Hidden(size * np.isin(range(3), axes))
    columns = known.law(kind)
    column = int(columns[random.integers(len(columns)), axis])
    size = ratio / np.sqrt(known.said.information[column, column])
    return Hidden(np.zeros(3), [column], [float(size * random.choice([-1, 1]))])


def signal_of_walk(known: Quiet, axes: Sequence[int]) -> float:
    """The mean of the square of its signal-to-noise ratio for K = 1."""
    return float(known.variances @ np.diag(known.said.information)[known.walk[:, axes]].sum(axis=1))


def drawn(plan: str, truth: Hidden, random: np.random.Generator) -> Campaign:
    """A campaign of the plan with new noise and what is hidden."""
    known = quiet(plan)
    seeds = random.integers(1, 2**31, 2).tolist()
    white = noise_of(recorded(plan, {}, seeds[0]), known.started)
    campaign = added(known.campaign, white, np.ones(1))
    if truth.walk.any():
        only = {"angle_random_walk_deg_sqrt_h": 0.0, "velocity_random_walk_m_s_sqrt_h": 0.0}
        only["gyro_rate_random_walk_deg_h_sqrt_h"] = 1.0
        walk = noise_of(recorded(plan, only, seeds[1]), known.started)
        gyro = walk.gyro * np.eye(3)
        each = Course("walk", walk.time, gyro, np.zeros_like(gyro))
        return added(campaign, each, truth.walk / UNIT)
    ((column,), (size,)) = truth.columns, truth.sizes
    every = [course for own in known.courses.values() for course in own]
    return added(campaign, every[column // 3], size * np.eye(3)[column % 3])


def outcome(
    plan: str, kind: str, ratio: float, number: int, says: Callable[[Campaign], str] | None = None
) -> dict[str, Any]:
    """Of a draw: what the stages say, and the log likelihood of each kind; what `says` guesses."""
    made = {"plan": plan, "kind": kind, "ratio": ratio, "number": number, "code": code()}
    place = [list(PLANS).index(plan), KINDS.index(kind), int(ratio), number]
    random = np.random.default_rng([SEED, *place])
    known = quiet(plan)
    truth = hidden(known, kind, ratio, random)
    campaign = drawn(plan, truth, random)
    said = _said(selected(fitted(campaign, known), known.degrees), kind)
    guess = {"guess": says(campaign)} if says else {}
    return made | said | guess | {"likelihoods": limits(known, known.of(campaign), ratio)}


# ---- What the stages say.


def fitted(campaign: Campaign, known: Quiet) -> Campaign:
    """The campaign with the random walk that the stage `gyroscope` estimates, of whole rests."""
    pieces: dict[str, list[StaticRate]] = {}
    for piece in campaign.inputs.static_rates:
        pieces.setdefault(piece.stretch.name.rpartition(" ")[0], []).append(piece)
    rests = []
    for rest in known.rests:
        own = pieces[rest.stretch.name]
        seconds = [piece.stretch.seconds for piece in own]
        mean = np.average([piece.mean for piece in own], axis=0, weights=seconds)
        rests.append(replace(rest, mean=mean))
    of_table = (campaign.inputs.turns, [], campaign.inputs.earth, campaign.position_sigma)
    walk = gyroscopes.fit(rests, *of_table, known.degrees).random_walk
    return campaign.with_random_walks((walk, 0.0))


def selected(campaign: Campaign, degrees: float) -> Selection:
    """The names, as the stage `criticism` selects them from blocks."""
    levels = (LEVEL * BLOCKS_SHARE, LEVEL * STRUCTURE_SHARE)
    selection = select_with_temperature(
        campaign, IN_BLOCKS, levels[0], LEVEL * TEMPERATURE_SHARE, degrees
    )
    tested = structure_tests(selection.campaign, selection.fitted, degrees, levels[1])
    selection, tested = with_laws(selection, tested, campaign, IN_BLOCKS, *levels, degrees)
    return selection.without_certain_names(["gyro"] if tested.of("gyro") else [])


def _said(selection: Selection, kind: str) -> dict[str, Any]:
    """Whether the law is in the class that is named, and no walk; or no name for a walk.

    A walk may also be called a drift without a law. `members`: of all that is named, or may be in
    place of a walk.
    """
    own = [c for c in selection.named.causes if selection.sensor(c) == "gyro"]
    named = [c for c in own if c.verdict in CLEAR]
    walk = bool(selection.random_walks[0]) or drift_name("gyro") in [c.effect for c in own]
    law = any(kind in c.members for c in named)
    return {
        "named": [c.effect for c in named],
        "uncertain": [c.effect for c in own if c.verdict not in CLEAR],
        "walk": walk,
        "members": sorted(
            {member for c in own for member in c.members}
            | ({"gyro_random_walk", *selection.alternatives} if walk else set())
        ),
        "right": (walk and not named) if kind in WALKS else (law and not walk),
    }


# ---- The likelihood-ratio test.


def limits(known: Quiet, said: EffectInformation, ratio: float) -> dict[str, float]:
    """Log likelihood of each kind of this ratio against nothing, as it is drawn."""
    alone = [_walk(known, said, ratio, [axis]) for axis in range(3)]
    of_walks = (_mean(np.array(alone)), _walk(known, said, ratio, [0, 1, 2]))
    return dict(zip(WALKS, of_walks, strict=True)) | {
        name: _mean(_law(said, known.law(name), ratio)) for name in LAWS
    }


def _mean(logs: Array) -> float:
    return float(logsumexp(logs) - np.log(logs.size))


def _law(said: EffectInformation, columns: Integers, ratio: float) -> Array:
    """Of a law of either sign, of each value and axis."""
    along = said.right[columns] * ratio / np.sqrt(np.diag(said.information)[columns])
    return np.stack([along, -along]) - ratio**2 / 2


def _walk(known: Quiet, said: EffectInformation, ratio: float, axes: Sequence[int]) -> float:
    """Of a walk of some axes: ½ bᵀ (V⁻¹ + F)⁻¹ b − ½ ln |1 + V F|."""
    own = known.walk[:, axes].ravel()
    root = np.sqrt(np.repeat(known.variances, len(axes)) / signal_of_walk(known, axes)) * ratio
    block = np.eye(len(own)) + said.information[np.ix_(own, own)] * np.outer(root, root)
    along = root * said.right[own]
    return float(along @ np.linalg.solve(block, along) - np.linalg.slogdet(block)[1]) / 2
