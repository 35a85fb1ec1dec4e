"""What the equations of a mount are formed from: static positions, rotations, passages by hand."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import accumulate, pairwise

import numpy as np

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.equations import Campaign
from inertial.campaign.equations_by_hand import ByHand, motion_of
from inertial.campaign.motions import (
    MIN_BEND,
    CampaignMotions,
    Merged,
    between_blocks,
    mean_motions,
    positions_of,
)
from inertial.campaign.records import Manoeuvre
from inertial.campaign.static_positions import (
    Blocks,
    StaticPosition,
    case_axes,
    level_axes_of,
    of_faster_waves,
    turn_errors,
)
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.noise_model import sigma_of_mean
from inertial.estimation.random_walk import MeasuredDrift, Stretch
from inertial.physics.motion import Motion, mean_turned
from inertial.sensors import SENSORS
from inertial.tables import ACCEL

MIN_PIECE_S = 30.0  # s, duration of a piece of a static position
MAX_PIECES = 100  # pieces of all static positions together
# Blocks of a rotation in one mean of the accelerometers, whose input is slow: as preferred.
MERGED_BLOCKS = (5, 4, 6, 3, 7)


def campaign_of(data: CampaignData) -> Campaign:
    """The inputs of the equations of one mount.

    Without a shared clock the times of different logs are not comparable and are omitted.
    """
    inputs, statics = data.gyro_inputs.of_known_attitude, data.accelerometer_positions[0]
    if data.by_hand is None:
        inputs = replace(inputs, static_positions=_in_pieces(inputs.static_positions))
        statics = _in_pieces(statics)
    motions, solution = CampaignMotions(data), data.result
    drifts = {sensor: data.drift(sensor) for sensor in SENSORS}
    if data.by_hand is not None:  # what the accelerometers drift by is the support, as it tilts
        drifts["accel"] = data.noise.stated_drift("accel")
    static_motions = [motions.at_rest(position) for position in inputs.static_positions]
    turns: list[Motion] = []
    static_forces: list[tuple[str, StaticForce, Motion]] = []
    for position in statics:
        force = (position.manoeuvre.name, position.force(), motions.at_rest(position))
        static_forces.append(force)
    late = abs(data.noise.delay("accel") - data.noise.delay("gyro"))
    for recorded, turn in zip(inputs.whole_turns, inputs.turns, strict=True):
        if solution.gyro is None:
            break
        motion = motions.turning(recorded, turn)
        turns.append(motion)
        if not turn.by_hand:
            noise = [data.noise.of(recorded.plan.name, at, ACCEL) for at in ("steady", "rest")]
            noise.append(data.noise.of_integral(recorded.plan.name, "steady", "accel"))
            edges = [0, *(gap.before for gap in turn.gaps), len(turn.seconds)]
            clock = data.clocks.get(recorded.plan.log)
            early = 0.0 if clock is None or clock.averaged else clock.step / np.sqrt(12)
            early = float(np.hypot(early, late))
            walk = 0.0 if turn.course is not None else turn.angle_walk
            parts = _turning(recorded.plan, recorded.blocks, motion, noise, edges, early, walk)
            stretches = _stretches(turn.stretch, [at for _, _, at in parts], drifts["accel"])
            static_forces += [
                (m, replace(part, stretch=own), at)
                for (m, part, at), own in zip(parts, stretches, strict=True)
            ]
    at_rate = [r for r in inputs.usable if r.plan.recorded == "steady" and not r.by_encoder]
    steady = [
        (rotation.plan.name, rate, motions.at_rate(rotation, rate))
        for rotation, rate in zip(at_rate, inputs.set_rates, strict=True)
        if solution.gyro is not None
    ]
    return Campaign(
        inputs,
        static_forces,
        static_motions,
        turns,
        steady,
        solution,
        data.gravity,
        data.position_sigma,
        positions_of(data.plan),
        [m.name for m in data.plan],
        _by_hand(data, motions),
        drifts,
    )


def _by_hand(data: CampaignData, motions: CampaignMotions) -> ByHand | None:
    """The positions of unknown attitude, and the passages where they give the gyros' result."""
    handled, gyro = data.by_hand, data.result.gyro
    if handled is None:
        return None
    if gyro is None or "gyro" not in data.result.free:
        handled = replace(handled, passages=[])
    rests = {position.label: position for position in data.accelerometer_positions[0]}
    passing = []
    for each in handled.passages:
        assert gyro is not None  # else there are none
        place = each.passage.first
        before = motions.at_rest(rests[handled.stops[place].forces.name])
        passing.append(motion_of(each, before, gyro, place, shared_clock=data.shared_clock))
    return ByHand(handled, passing, data.gravity, data.earth, data.shared_clock)


def _in_pieces(positions: Sequence[StaticPosition]) -> list[StaticPosition]:
    """Static positions divided so that changes within them are resolved by few equations."""
    total = sum(float(position.seconds.sum()) for position in positions)
    seconds = max(MIN_PIECE_S, total / MAX_PIECES)
    return [piece for position in positions for piece in position.pieces(seconds)]


def _stretches(
    whole: Stretch | None, motions: Sequence[Motion], drift: MeasuredDrift
) -> list[Stretch | None]:
    """The stretch of each part of a rotation: one for all, unless the bias drifts within it."""
    if whole is None or not drift:
        return [whole] * len(motions)
    seconds = [float(motion.seconds.sum()) for motion in motions]
    return [
        replace(whole, name=f"{whole.name} {number}", start=whole.start + before, seconds=own)
        for number, (own, before) in enumerate(
            zip(seconds, accumulate(seconds, initial=0.0), strict=False)
        )
    ]


def _turning(
    m: Manoeuvre,
    blocks: Blocks,
    motion: Motion,
    noise: Sequence[Array],
    edges: Sequence[int],
    early: float,
    walk: float,
) -> list[tuple[str, StaticForce, Motion]]:
    """The accelerometers during a rotation in means of some blocks, none across the `edges`.

    Nor those that end at a gap near the corner of a ramp, where nothing shows the rate.

    `noise`: white at the steady rate and at rest, and that of the integral. While the table starts
    and stops the larger white one: what shakes the rest after a turn may begin before it is at
    rest. `early`: sigma of the time of a sample against that of the gyros, s. By it a mean is off
    in proportion to the change from its start to its end, of specific force that does not turn
    with the table: that of a lever arm in a ramp. The delay by a slow low pass of one of the
    sensors is in it. `walk`: as in `turn_errors`.
    """
    read, seconds = blocks.accel, blocks.seconds
    assert m.up is not None  # else the turn is refused
    # In a ramp the mean angle of a block is not the middle of what it turns by.
    angle, swept = motion.angle - motion.acceleration * seconds**2 / 12, motion.rate * seconds
    case = case_axes(m.up, m.axis)
    if case is not None and walk and m.angle:  # the gyros divide the angle from stop to stop
        angle *= m.angle / (motion.angle[-1] + swept[-1] / 2)
    turned = (m.axis, angle, swept)
    ups = mean_turned(m.up, *turned)
    *_, off = between_blocks(motion.rate, seconds, blocks.missing)
    starts = [start for piece in pairwise(edges) for start in _merged(off, *piece)]
    merged = Merged(seconds, starts)
    steady = np.logical_and.reduceat(blocks.steady, starts)[:, None]
    moving, resting, swing = noise
    density = np.where(steady, moving, np.fmax(moving, resting))
    sigmas = sigma_of_mean(density, swing, merged.seconds[:, None])
    axes = [merged.mean(mean_turned(axis, *turned)) for axis in level_axes_of(m)]
    level = np.stack(axes, axis=1)
    if case is None:
        between = np.concatenate([read[:1], (read[1:] + read[:-1]) / 2, read[-1:]])
        change = between[[*starts[1:], len(read)]] - between[starts]
        sigmas = np.hypot(sigmas, early * change / merged.seconds[:, None])
    sigmas = np.hypot(sigmas, of_faster_waves(m, merged.mean(ups), walk))
    shares = merged.mean(angle) / (m.angle or np.inf)
    cut = np.append((blocks.missing > 0) & (off[:-1] > MIN_BEND), False)
    known = ~(cut[starts] | cut[[*starts[1:], len(seconds)]])
    means = zip(merged.mean(ups), merged.mean(read), sigmas, level, shares, strict=True)
    rests = [
        StaticForce(
            m.position,
            up,
            mean,
            sigma,
            turning=True,
            level=own,
            case=case,
            turn_errors=turn_errors(m, float(share), walk),
        )
        for up, mean, sigma, own, share in means
    ]
    each = zip(rests, mean_motions(motion, merged), known.tolist(), strict=True)
    return [(m.name, rest, at) for rest, at, usable in each if usable]


def _merged(off: Array, first: int, after: int) -> list[int]:
    """The first of the blocks in each mean of those in [first, after).

    Between two means the rate must be known: else one of them would have a part of the angular
    acceleration of the other.

    off : how far the blocks beside the start of each are off a straight line, rad/s
    """
    starts = [first]
    while after - starts[-1] > max(MERGED_BLOCKS):
        places = starts[-1] + np.array(MERGED_BLOCKS)
        starts.append(int(places[np.argmin(np.fmax(off[places], MIN_BEND))]))
    return starts
