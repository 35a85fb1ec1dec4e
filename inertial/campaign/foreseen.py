"""A campaign before it is recorded: its blocks without noise, and the sigmas to be expected.

The information of a manoeuvre depends on attitude, rate, duration and noise, not on the readings.
So the blocks of manoeuvres that are only planned are computed by the forward model, and the
equations of the estimation are formed of them as of recorded ones.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import groupby

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.noise_levels import COMMON, DRIFTS, LEVEL_COLUMNS, NoiseLevels
from inertial.campaign.rate_segments import position_of
from inertial.campaign.records import Clock, Known, Manoeuvre, Performed, Row
from inertial.campaign.rotating_positions import LEVER_ARM, turning_rests
from inertial.campaign.solution import Solution
from inertial.estimation import accelerometers, gyroscopes
from inertial.estimation.accelerometers import Reference, StaticForce
from inertial.estimation.drifting_equations import DriftingEquations
from inertial.estimation.gyroscope_equations import Linearisation
from inertial.estimation.least_squares import Estimate
from inertial.estimation.triad import UNKNOWNS
from inertial.physics.forward import Site, Triad, predict
from inertial.physics.motion import Profile, level_axes, mean_turned, turning
from inertial.tables import ACCEL, CHANNELS, GYRO

# As the section `segment` of config.yaml divides a recording.
REST_BLOCK, TURN_BLOCK = 5.0, 0.2  # s
SMALL_ANGLE = np.radians(5)  # rad: a turn may be in longer blocks, as long as each turns no more
MARGIN = 0.5  # s, excluded between a rest and adjacent motion
PAUSE = 60.0  # s, before manoeuvres that are added to a campaign
LOG = "session"
RATE = 100.0  # samples per second, to count them; no sigma depends on it
IDEAL = Triad(np.eye(3), np.zeros(3))


@dataclass(frozen=True)
class Pace:
    """How a table goes from one manoeuvre to the next, s.

    `still`: at rest before and after every turn; `change`: to another position, until it is still.
    """

    still: float
    change: float


# ---- When what takes place.


@dataclass(frozen=True)
class Period:
    """A stretch at rest or in motion; `start`, `seconds`: s; `angle`: rad, turned before it."""

    manoeuvre: Manoeuvre
    phase: str
    start: float
    seconds: float
    angle: float = 0.0


def session_seconds(plan: Sequence[Manoeuvre], pace: Pace) -> float:
    """The time at the table for a plan in one log, changes of position included, s."""
    own = sum((m.seconds or 0.0) + 2 * pace.still * (m.do == "turn") for m in plan)
    return own + pace.change * (len(list(_visits(plan))) - 1)


def _visits(plan: Sequence[Manoeuvre]) -> Iterator[list[Manoeuvre]]:
    """Consecutive manoeuvres of one position."""
    return (list(visit) for _position, visit in groupby(plan, key=lambda m: m.position))


def _periods(plan: Sequence[Manoeuvre], pace: Pace, start: float) -> Iterator[Period]:
    """What the stage `segment` would find: a rest includes the time at rest of adjacent turns."""
    now = start
    for visit in _visits(plan):
        for i, m in enumerate(visit):
            before = visit[i - 1] if i else None
            after = visit[i + 1] if i + 1 < len(visit) else None
            seconds = m.seconds or 0.0
            if m.do == "rest":
                joined = [n is not None and n.do == "turn" for n in (before, after)]
                first = now - pace.still * joined[0] + MARGIN
                yield Period(m, "rest", first, seconds + pace.still * sum(joined) - 2 * MARGIN)
                now += seconds
                continue
            if before is None or before.do == "turn":
                yield Period(m, "rest-before", now + MARGIN, pace.still - 2 * MARGIN)
            yield Period(m, "turn", now + pace.still, seconds)
            now += seconds + 2 * pace.still
            if after is None or after.do == "turn":
                last = now - pace.still + MARGIN
                yield Period(m, "rest-after", last, pace.still - 2 * MARGIN, m.angle or 0.0)
        now += pace.change


# ---- The blocks.


@dataclass(frozen=True)
class _Pieces:
    """k blocks of a stretch: phases, middles and durations, s, angles and rates about the axis."""

    phases: list[str]
    time: Array
    seconds: Array
    angle: Array
    rate: Array


def _pieces(part: Period) -> _Pieces:
    m = part.manoeuvre
    if part.phase != "turn":
        count = max(round(part.seconds / REST_BLOCK), 1)
        seconds = np.full(count, part.seconds / count)
        zero = np.zeros(count)
        time = part.start + (np.arange(count) + 0.5) * seconds
        return _Pieces([part.phase] * count, time, seconds, zero + part.angle, zero)
    assert m.angle is not None and m.rate is not None  # else it is not planned here
    profile = Profile(abs(m.angle), abs(m.rate), m.acceleration or np.inf)
    block = max(TURN_BLOCK, SMALL_ANGLE / abs(m.rate))
    ends = np.append(np.arange(-MARGIN, profile.seconds + MARGIN, block), 0.0)
    ends[-1] = profile.seconds + MARGIN
    angles = np.sign(m.angle) * profile.at(ends)[0]
    seconds, middle = np.diff(ends), (ends[1:] + ends[:-1]) / 2
    steady = (ends[:-1] >= profile.ramp_seconds) & (
        ends[1:] <= profile.seconds - profile.ramp_seconds
    )
    ramps = np.where(middle < profile.seconds / 2, "spin-up", "spin-down")
    phases = np.where(steady, "steady", ramps).tolist()
    rate = np.diff(angles) / seconds
    return _Pieces(phases, part.start + middle, seconds, (angles[1:] + angles[:-1]) / 2, rate)


def _blocks(
    part: Period, solution: Solution, heading: float | None, log: str
) -> dict[str, Array | list[str]]:
    """The blocks of a stretch as columns of the table, without noise."""
    m, pieces = part.manoeuvre, _pieces(part)
    assert m.up is not None  # else it is not planned here
    about = m.up if m.about is None else m.about
    north = solution.north(position_of(m, heading))
    # An unknown azimuth: any value does.
    north = level_axes(m.up)[0] if np.isnan(north).any() else north
    middle, swept = pieces.angle, pieces.rate * pieces.seconds
    zero = np.zeros(len(middle))
    motion = turning(about, m.up, north, middle, pieces.rate, zero, pieces.time, pieces.seconds)
    ups, norths = (mean_turned(each, about, middle, swept) for each in (m.up, north))
    read = predict(
        replace(motion, up=ups, north=norths),
        solution.site,
        solution.gyro or IDEAL,
        solution.accelerometer or IDEAL,
    )
    readings = np.hstack([read.accel, read.gyro]).T
    return {
        "manoeuvre": [m.name] * len(middle),
        "phase": pieces.phases,
        "log": [log] * len(middle),
        "time": pieces.time,
        "seconds": pieces.seconds,
        "count": pieces.seconds * RATE,
        **dict(zip((*ACCEL, *GYRO), readings, strict=True)),
    }


def _table_of(parts: Sequence[dict[str, Array | list[str]]]) -> pd.DataFrame:
    """The table of blocks."""
    frame = pd.DataFrame({name: np.concatenate([p[name] for p in parts]) for name in parts[0]})
    nothing = {"from_record": 0, "to_record": 0, "missing_s": 0.0, "mask_share": 0.0}
    return frame.assign(**nothing, table_angle=np.nan, temperature=np.nan)


def _performed(m: Manoeuvre) -> Performed:
    return Performed(m.name, "", angle=m.angle, rate=m.rate, seconds=m.seconds or 0.0)


def extended(data: CampaignData, plans: Sequence[Sequence[Manoeuvre]], pace: Pace) -> CampaignData:
    """A campaign with a solution, and manoeuvres that are to be added, in a log of its last.

    Of several plans each begins at the same time: alternatives, to be compared.
    """
    recorded = data.blocks["time"].max() if len(data.blocks) else np.nan
    start = 0.0 if np.isnan(recorded) else float(recorded) + PAUSE
    log = data.plan[-1].log if data.plan else LOG
    more = [replace(m, log=log) for plan in plans for m in plan]
    parts = [part for plan in plans for part in _periods(plan, pace, start)]
    added = _table_of([_blocks(part, data.result, data.heading, log) for part in parts])
    return replace(
        data,
        plan=[*data.plan, *more],
        performed={**data.performed, **{m.name: _performed(m) for m in more}},
        blocks=pd.concat([data.blocks, added], ignore_index=True) if len(data.blocks) else added,
    )


def foreseen(
    plan: Sequence[Manoeuvre], pace: Pace, noise: NoiseLevels, known: Mapping[str, Known]
) -> CampaignData:
    """The campaign of a plan that is recorded in one log, by an ideal IMU with this noise."""
    return extended(nothing_recorded(noise, known), [plan], pace)


def nothing_recorded(noise: NoiseLevels, known: Mapping[str, Known]) -> CampaignData:
    """A campaign of an ideal IMU with this noise, to which a plan may be added."""
    site = Site(*(known[name].number for name in ("gravity", "earth_rate_up", "earth_rate_level")))
    return CampaignData(
        [],
        {},
        pd.DataFrame(),
        noise,
        known,
        clocks={LOG: Clock(1 / RATE)},
        shared_clock=True,
        solution=Solution(IDEAL, IDEAL, site, {}),
    )


def stated_noise(figures: Mapping[str, Mapping[str, float | None]]) -> NoiseLevels:
    """The noise of a data sheet as levels of a campaign, infinitely well known.

    `figures`: white_noise, bias_instability and random_walk, per √s and SI, of accel and gyro.
    """
    rows = []
    for channel in CHANNELS:
        own = figures[channel.partition("_")[0]]
        level: Row = {"channel": channel, "white_noise": own["white_noise"], "source": COMMON}
        drifts = {name: own.get(name) for name in DRIFTS}
        rows.append(level | {"sigma": 0.0, "degrees": np.inf} | drifts)
    return NoiseLevels(pd.DataFrame(rows).reindex(columns=LEVEL_COLUMNS))


# ---- The sigmas of the estimation.


def sigmas(data: CampaignData) -> Array:
    """Sigmas of the 24 parameters by the joint fit, accelerometers first; inf: none, (24,)."""
    drift = data.noise.drift("accel")
    fitted = accelerometers.weighted(*_forces(data), effect_sigma=LEVER_ARM, measured=drift)
    inputs = data.gyro_inputs
    turned = gyroscopes.joint(
        inputs.static_rates,
        inputs.segments,
        inputs.set_rates,
        inputs.earth,
        inputs.position_sigma,
        measured=data.noise.drift("gyro"),
    )
    return np.concatenate([_of_parameters(fitted), _of_parameters(turned)])


def _of_parameters(estimate: Estimate) -> Array:
    return np.where(estimate.determined, estimate.sigma, np.inf)[:UNKNOWNS]


def information_of_positions(data: CampaignData) -> dict[str, tuple[Array, Array]]:
    """Of gyros (13, 13) and accelerometers (16, 16), by position, its errors eliminated.

    Unknowns: M by rows, bias, the upward earth rate; M, bias, gravity, three lever arms. The priors
    are left out, so that the information of positions adds up. A drift of the biases is left out
    as well.
    """
    inputs, solution = data.gyro_inputs, data.result
    gyro, accelerometer = solution.gyro or IDEAL, solution.accelerometer or IDEAL
    gyros = gyroscopes.linearised(
        Linearisation(gyro.matrix, gyro.bias, {}),
        inputs.segments,
        inputs.set_rates,
        inputs.earth,
        inputs.position_sigma,
    ).with_statics(inputs.static_rates)
    forces = _forces(data)
    force = accelerometers.drifting(*forces, accelerometer, LEVER_ARM, walking=False)
    of_gyros, of_forces = by_position(gyros.drifting()), by_position(force)
    names = dict.fromkeys([*of_gyros, *of_forces])
    none = np.zeros((13, 13)), np.zeros((16, 16))
    return {name: (of_gyros.get(name, none[0]), of_forces.get(name, none[1])) for name in names}


def by_position(equations: DriftingEquations) -> dict[str, Array]:
    """The information of the equations of each position alone, without priors, (q, q)."""
    places: dict[str, list[int]] = {}
    for place, name in enumerate(equations.positions):
        places.setdefault(name, []).append(place)
    return {
        name: _normal(
            replace(
                equations, blocks=[equations.blocks[i] for i in own], positions=[name] * len(own)
            )
        )
        for name, own in places.items()
    }


def _normal(equations: DriftingEquations) -> Array:
    rows = equations.system().design
    return np.asarray(rows.T @ rows)


def _forces(data: CampaignData) -> tuple[list[StaticForce], Reference]:
    """Static positions and steady turns of the accelerometers, and what is known."""
    rests = [position.force() for position in data.accelerometer_positions[0]]
    rests += [rest for _, rest in turning_rests(data)]
    return rests, data.reference
