"""The equations of the gyros in static positions, at steady rates and in rate segments.

    sum over a block = M · (u Δθ + E) + bias · τ + noise

u is the axis of the turn in body axes, tilted by δ; Δθ the angle that the table turns during the
block; E the earth's rate in body axes, summed. The rate of the table is not exactly known, so Δθ of
every block is an unknown that occurs in its own three readings only; known is the whole angle from
rest to rest. So a block gives the two combinations of its channels that are free of Δθ, and the
rate segment as a whole the third.

White noise of the angle, the quantisation of the gyros, is an error of the readings at every edge
of the blocks that its two neighbours share with opposite signs. A combination of channels that is
white by their rates has a share r of it, s: the covariance of its blocks is τ + 2r, and −r beside.
Of the segment as a whole, and of a window, the errors at both ends remain.

A gap in a rate segment is interpolated from the blocks next to it: the table turned in it at their
rate, to a known sigma, an unknown of its own. So in the segment as a whole every block counts for
itself and for its share of the gaps,

    sum of w · (sum over a block) = M · (u α + sum of w · E) + bias · sum of w · τ,   w ≥ 1,

and noise, earth and bias are those of what was recorded, w times. In a steady part the share is the
same for all, T_missing/T_steady; by the sums S of one gyro that is a recorded angle of
α / (1 + S_steady/S · T_missing/T_steady), in which its scale factor cancels.

Where the encoder of the table is recorded, known is the angle of each of its windows, of any
length, E₂ − E₁ by its readings. So no rest is needed at the ends of a window, nor what lies between
two. The sum over a window has

    M · u (E₂ − E₁ − τ (ω₂ − ω₁) − a (sin E₂ − sin E₁) − b (cos E₂ − cos E₁)),

with the delay τ of the gyros less that of the encoder, and the eccentricity a, b of the encoder:
unknowns of the table, with those that are eliminated. An edge that two windows share has one error.

Where samples are timed by stamps of arrival, τ is uncertain by a share that all sums of a log have
in common: one unknown of its clock, by which their angle is off.

The earth's rate has an upward component, known from the latitude, and a horizontal component of
known size whose direction is known only with `mark` and the table's heading. Else it is an unknown
of each position, with the size as its sigma. Of a turn in an unknown attitude all three components
are unknowns.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from scipy.linalg import cholesky_banded, solve_banded

from inertial.arrays import Array, Booleans
from inertial.estimation.elimination import (
    OF_CASE,
    TILTS,
    EquationBlock,
    Name,
    compressed,
    names_of,
    whitened,
)
from inertial.estimation.gyroscope_observations import (
    TABLE,
    Earth,
    EncoderWindow,
    Position,
    RateSegment,
    StaticRate,
    SteadyRate,
)
from inertial.estimation.noise_model import SQRT2, wave, waves_within
from inertial.estimation.random_walk import Stretch
from inertial.estimation.triad import UNKNOWNS, design_of
from inertial.physics.forward import Triad, measured_angles
from inertial.physics.motion import all_level_axes, cross, is_vertical, level_axes, turned_all

UPRIGHT = np.array([0.0, 0.0, 1.0])  # z, for want of a direction
# What is known of an encoder before: it is read within 50 ms, and off its axis by no more than
# those of a laboratory are; what the windows say of both counts.
DELAY_SIGMA = 0.05  # s
ECCENTRICITY_SIGMA = 1e-4  # rad, 20 arcsec
CLOCK = "clock"  # kind of the error of the rate of a log's clock
DELAY: Name = ("encoder delay", TABLE)
TABLE_RATE: Name = ("table rate", TABLE)  # by which all its rates are off, in its sigma
WAVES: tuple[Name, Name] = (("encoder sine", TABLE), ("encoder cosine", TABLE))
MAX_BLOCKS_PER_PASS = 4000  # so that the memory does not grow with the length of a segment


def horizontal_names(position: Position) -> tuple[Name, ...]:
    """The unknown components of the earth's rate; none where north is known."""
    if position.north is not None:
        return ()
    if not position.is_known:
        return tuple((f"earth {i}", position.name) for i in (0, 1, 2))
    name = position.azimuth or (position.name if position.mark is None else TABLE)
    return tuple((f"level {i}", name) for i in (0, 1))


def horizontal_axes(position: Position) -> Array:
    """The directions of the unknown components of the earth's rate, (2, 3) or (3, 3)."""
    if not position.is_known:
        return np.eye(3)
    if position.mark is not None:
        return np.array([position.mark, cross(position.up, position.mark)])
    return np.array(level_axes(position.up))


def horizontal_sigma(position: Position, earth: Earth) -> float:
    """The sigma of each of these components, rad/s: that of a direction of which nothing is known.

    Without a latitude the upward component is one of unknown sign, with its size as its sigma.
    """
    if position.is_known:
        return float(earth.level / np.sqrt(2))
    return float(np.linalg.norm([earth.up, earth.up_sigma, earth.level]) / np.sqrt(3))


def is_upright(position: Position, about: Array) -> bool:
    """Whether the table turns about the vertical of this position."""
    return position.is_known and is_vertical(position.up, about)


def tilt_axes(position: Position, about: Array) -> dict[Name, Array]:
    """The directions about which the axis of a turn may be tilted, in body axes, by unknown.

    Of a turn about the vertical they are those of the position, so that its tilt is that which the
    accelerometers have there, in whichever sense the table turns.
    """
    upright = is_upright(position, about)
    axes: Sequence[Array] = level_axes(position.up if upright else about)
    return dict(zip(names_of([position.name], OF_CASE if upright else TILTS), axes, strict=True))


@dataclass(frozen=True)
class Linearisation:
    """The point about which the equations are linear: M, bias, horizontal earth rates.

    `azimuths`: the positions whose azimuth is known well enough to constrain the size of the
    horizontal earth rate, which is exactly known.
    """

    matrix: Array
    bias: Array
    levels: Mapping[Name, float]  # by kind and name of the unknowns
    azimuths: Collection[str] = ()


def static_equations(
    statics: Sequence[StaticRate],
    point: Linearisation,
    earth: Earth,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> list[tuple[str, EquationBlock, Stretch]]:
    """Position, equations and stretch of every static mean.

    Parameters
    ----------
    point : that they are linear about; `prior`: (s,), of the shared unknowns
    effects : names of the last shared unknowns
    sigma : of the errors, to which those of the static positions are added
    """
    if not statics:
        return []
    n, s = len(statics), len(prior)
    positions = [static.position for static in statics]
    abouts = np.array([static.about for static in statics])
    angles = np.array([static.angle for static in statics])
    ups = turned_all(np.array([p.up for p in positions]), abouts, angles)
    norths = np.array([np.zeros(3) if p.north is None else p.north for p in positions])
    known = turned_all(earth.level * norths, abouts, angles)
    axes = np.zeros((n, 3, 3))
    axes[:, :2] = all_level_axes(np.array([p.up if p.is_known else UPRIGHT for p in positions]))
    for i, position in enumerate(positions):
        if position.mark is not None or not position.is_known:
            own = horizontal_axes(position)
            axes[i, : len(own)] = own
    unknown = [turned_all(axes[:, i], abouts, angles) for i in (0, 1, 2)]
    named = [horizontal_names(position) for position in positions]
    sizes = np.zeros((n, 3))
    for i, names in enumerate(named):
        sizes[i, : len(names)] = [point.levels.get(name, 0.0) for name in names]
    found = np.einsum("kn,nki->ni", sizes.T, np.stack(unknown, axis=1))
    # The products M · earth are linear about the present M and horizontal rate of each position.
    rows = np.zeros((n, 3, s + 4))
    for row in range(3):
        rows[:, row, 3 * row : 3 * row + 3] = known + found + earth.up * ups
        rows[:, row, 9 + row] = 1.0
    rows[:, :, UNKNOWNS] = ups @ point.matrix.T
    rows[:, :, UNKNOWNS + 1 : s] = [static.sensitivities.of(effects) for static in statics]
    for i in (0, 1, 2):
        rows[:, :, s + i] = unknown[i] @ point.matrix.T
    rows[:, :, -1] = np.array([st.mean for st in statics]) + rows[:, :, UNKNOWNS] * earth.up
    rows[:, :, -1] += found @ point.matrix.T - rows[:, :, :s] @ prior
    result = []
    for i, (static, names) in enumerate(zip(statics, named, strict=True)):
        sigma |= dict.fromkeys(names, horizontal_sigma(static.position, earth))
        columns = np.r_[: s + len(names), s + 3]
        block = whitened(rows[i][:, columns], static.sigma, names)
        result.append((static.position.name, block, static.stretch or Stretch(f"rest {i}")))
    return result


def steady_equations(
    steady: SteadyRate,
    name: str,
    matrix: Array,
    earth: Earth,
    position_sigma: float,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
) -> EquationBlock:
    """The equations of a part at a known rate; arguments as in `static_equations`."""
    names = horizontal_names(steady.position)
    angles, shares = steady.rate * steady.elapsed, steady.seconds / steady.seconds.sum()
    known = np.zeros(3)
    if steady.position.north is not None:
        north = earth.level * steady.position.north
        known = shares @ turned_all(north, steady.about, angles)
    mean_up = shares @ turned_all(steady.position.up, steady.about, angles)
    up = matrix @ mean_up
    truth = steady.rate * steady.about + known + earth.up * mean_up
    columns = [design_of(truth), up[:, None], steady.sensitivities.of(effects)]
    sigma |= dict.fromkeys(names, horizontal_sigma(steady.position, earth))
    if names:
        axes = horizontal_axes(steady.position)
        means = [shares @ turned_all(axis, steady.about, angles) for axis in axes]
        columns.append(matrix @ np.column_stack(means))
    for tilt, axis in tilt_axes(steady.position, steady.about).items():
        sigma[tilt], names = position_sigma, (*names, tilt)
        columns.append((steady.rate * (matrix @ cross(axis, steady.about)))[:, None])
    along = matrix @ steady.about
    rate = ("rate", name)
    sigma[rate], names = steady.rate_sigma, (*names, rate)
    columns.append(along[:, None])
    if steady.table_rate_sigma:
        sigma[TABLE_RATE], names = 1.0, (*names, TABLE_RATE)
        columns.append((np.sign(steady.rate) * steady.table_rate_sigma * along)[:, None])
    design = np.hstack(columns)
    observed = steady.mean + up * earth.up - design[:, : len(prior)] @ prior
    return whitened(np.column_stack([design, observed]), steady.sigma, names)


def segment_equations(
    segment: RateSegment,
    name: str,
    point: Linearisation,
    earth: Earth,
    position_sigma: float,
    prior: Array,
    effects: Sequence[str],
    sigma: dict[Name, float],
    instability: Array,
) -> EquationBlock | None:
    """The equations of a rate segment in few rows; None where no recorded gyro senses its axis.

    Parameters
    ----------
    name : of the segment, for its own errors; `position_sigma`: rad
    prior : (s,), of the shared unknowns, of which `effects` are the last
    sigma : of the errors, to which those of the segment are added
    instability : (3,), rad/s, by which the biases go about their mean
    """
    recorded = np.isfinite(segment.sums).all(axis=0) & np.isfinite(segment.density)
    weight = np.where(recorded, 1 / np.where(recorded, segment.density, 1.0), 0.0)
    along = weight * (point.matrix @ segment.about)
    if not np.any(along):
        return None
    own, course = _own_errors(segment, name, earth, position_sigma, instability * recorded)
    sigma |= own
    sums = np.where(recorded, segment.sums, 0.0)
    angle = _block_angles(segment, weight, point, earth)
    middle = segment.turned(angle)

    # Two combinations of every block that do not depend on its angle.
    across = np.zeros((int(recorded.sum()) - 1, 3))
    across[:, recorded] = np.linalg.svd(along[None, recorded] / np.linalg.norm(along))[2][1:]
    across, edges = _apart(across * weight, segment.quantisation)
    blocks = _Blocks(segment, point, earth, prior, effects, list(own), course, sums, angle, middle)
    whole = np.zeros((3, len(prior) + len(own) + 1))
    unweighted, rows, count = whole.copy(), [whole[:0]], 1
    of_windows = [whole.copy() for _ in segment.windows]
    for start in range(0, len(sums), MAX_BLOCKS_PER_PASS):
        some = slice(start, start + MAX_BLOCKS_PER_PASS)
        equations = blocks.equations(some)
        whole += np.einsum("k,krc->rc", segment.weights[some], equations)
        for window, total in zip(segment.windows, of_windows, strict=True):
            inside = slice(max(window.first - start, 0), max(window.after - start, 0))
            total += equations[inside].sum(axis=0)
        if segment.by_hand:
            unweighted += equations.sum(axis=0)
            continue
        usable = segment.usable_blocks[some]
        pairs = np.einsum("dr,krc->kdc", across, equations[usable])
        for d, edge in enumerate(edges):
            pairs[:, d] = _whitened_blocks(pairs[:, d], segment.seconds[some], usable, edge)
        rows.append(compressed(pairs.reshape(-1, pairs.shape[-1])))
        count += len(across) * int(usable.sum())
    if segment.by_hand:
        rows.append(across @ unweighted / np.sqrt(segment.seconds.sum() + 2 * edges)[:, None])
        count += len(across)
    known_angle = partial(_known_angle, segment, point.matrix, recorded, own=list(own))
    if segment.windows:
        known = np.array(
            [
                known_angle(
                    total,
                    segment.seconds[window.first : window.after].sum(),
                    window.end - window.start - angle[window.first : window.after].sum(),
                    _errors_of(segment, name, window),
                )
                for window, total in zip(segment.windows, of_windows, strict=True)
            ]
        )
    else:
        by_kind = {"angle": 1.0, "gap angle": 1.0, CLOCK: segment.angle}
        errors = {error: by_kind[error[0]] for error in own if error[0] in by_kind}
        duration = float(segment.weights**2 @ segment.seconds)
        missing = segment.angle - float(segment.weights @ angle)
        known = known_angle(whole, duration, missing, errors)[None]
    known = known[np.isfinite(known).all(axis=1)]
    stacked, count = np.vstack([*rows, known]), count - 1 + len(known)
    return EquationBlock(compressed(stacked), tuple(own), count, 0.0)


def _apart(across: Array, quantisation: Array) -> tuple[Array, Array]:
    """Combinations of channels, (d, 3), whose errors of the angle are independent too.

    And of each the variance of that, s, (d,). `across`: those that are white of 1 by their rates.
    """
    edges = np.zeros(len(across))
    if quantisation.any():
        edges, axes = np.linalg.eigh((across * quantisation**2) @ across.T)
        across = axes.T @ across
    return across, edges


def _whitened_blocks(rows: Array, seconds: Array, usable: Booleans, edge: float) -> Array:
    """The equations of the usable of k blocks, (u, c), with errors that are white of 1.

    Parameters
    ----------
    seconds : (k,), their duration, the variance of their white noise
    edge : s, variance at each edge that neighbours share
    """
    time = seconds[usable]
    if not edge:
        return np.asarray(rows / np.sqrt(time)[:, None])
    beside = np.append(np.where(np.diff(np.flatnonzero(usable)) == 1, -edge, 0.0), 0.0)
    root = cholesky_banded(np.array([time + 2 * edge, beside[: len(time)]]), lower=True)
    return np.asarray(solve_banded((1, 0), root, rows))


def _ends(along: Array, quiet: Array, quantisation: Array) -> float:
    """Variance of the errors of the angle at both ends of a sum of the channels, s.

    In units of its white noise. `along`: (3,), their weights in sigmas; `quiet`: (3,), 1/sigma.
    """
    return float(2 * along**2 @ (quiet * quantisation) ** 2 / (along @ along))


def _own_errors(
    segment: RateSegment, name: str, earth: Earth, position_sigma: float, instability: Array
) -> tuple[dict[Name, float], list[tuple[int, int]]]:
    """The errors of a rate segment with their sigmas, and number and axis of each wave of biases.

    The waves are the last of the errors; `instability`: 0 of a gyro that is not recorded.
    """
    vague = horizontal_sigma(segment.position, earth)
    own = dict.fromkeys(horizontal_names(segment.position), vague)
    own |= dict.fromkeys(tilt_axes(segment.position, segment.about), position_sigma)
    if segment.windows:
        own |= {DELAY: DELAY_SIGMA, **dict.fromkeys(WAVES, ECCENTRICITY_SIGMA)}
        edges = {edge for w in segment.windows for edge in (w.start, w.end)}
        own |= dict.fromkeys((_edge(name, e) for e in sorted(edges)), segment.angle_sigma / SQRT2)
    else:
        own[("angle", name)] = segment.angle_sigma
        if segment.gaps:
            own[("gap angle", name)] = segment.gap_sigma
    if segment.clock_sigma:
        own[(CLOCK, segment.clock)] = segment.clock_sigma
    waves = waves_within(float(segment.seconds.sum()), instability, segment.density)
    course = [(number + 1, axis) for number, axis in np.argwhere(waves > 0).tolist()]
    names = [(f"wave {number} of bias {axis}", name) for number, axis in course]
    return own | dict(zip(names, waves[waves > 0].tolist(), strict=True)), course


def _block_angles(segment: RateSegment, weight: Array, point: Linearisation, earth: Earth) -> Array:
    """The angle of each block, (k,), rad, from the channels along the axis."""
    position = segment.position
    level = np.zeros(3) if position.north is None else earth.level * position.north
    for key, axis in zip(horizontal_names(position), horizontal_axes(position), strict=False):
        level = level + point.levels.get(key, 0.0) * axis
    return measured_angles(
        segment.sums,
        segment.seconds,
        segment.about,
        earth.up * position.up + level,
        Triad(point.matrix, point.bias),
        segment.turned,
        weight,
    )


@dataclass(frozen=True)
class _Blocks:
    """The equations of the blocks of a rate segment, before elimination of their angles.

    `course`: number and axis of each wave of the biases about their mean, the last of `own`.
    """

    segment: RateSegment
    point: Linearisation
    earth: Earth
    prior: Array
    effects: Sequence[str]
    own: Sequence[Name]
    course: Sequence[tuple[int, int]]
    sums: Array  # (k, 3), rad
    angle: Array  # (k,), rad
    middle: Array  # (k,), rad, turned since the start at the middle

    def equations(self, some: slice) -> Array:
        """Coefficients of shared unknowns, of own errors, and the observed, (blocks, 3, n)."""
        segment, matrix, earth = self.segment, self.point.matrix, self.earth
        position, about, s = segment.position, segment.about, len(self.prior)
        seconds, angle, middle = segment.seconds[some], self.angle[some], self.middle[some]
        rows = np.zeros((len(seconds), 3, s + len(self.own) + 1))
        up = turned_all(position.up, about, middle)
        rate = earth.up * up
        if position.north is not None:
            rate += turned_all(earth.level * position.north, about, middle)
        truth = angle[:, None] * about + rate * seconds[:, None]
        for row in range(3):
            rows[:, row, 3 * row : 3 * row + 3] = truth
            rows[:, row, 9 + row] = seconds
        rows[:, :, UNKNOWNS] = seconds[:, None] * (up @ matrix.T)
        if segment.sensitivities.names:
            sensitivities = segment.sensitivities.of(self.effects)[some]
            rows[:, :, UNKNOWNS + 1 : s] = sensitivities * seconds[:, None, None]
        column = s
        if position.north is None:
            for axis in horizontal_axes(position):
                level = turned_all(axis, about, middle) @ matrix.T
                rows[:, :, column] = level * seconds[:, None]
                column += 1
        for axis in tilt_axes(position, about).values():
            rows[:, :, column] = np.outer(angle, matrix @ cross(axis, about))
            column += 1
        fraction = segment.elapsed / segment.elapsed[-1]
        for place, (number, axis) in enumerate(self.course, s + len(self.own) - len(self.course)):
            rows[:, axis, place] = seconds * wave(number, fraction[some])
        observed = self.sums[some] + rows[:, :, UNKNOWNS] * earth.up
        rows[:, :, -1] = observed - rows[:, :, :s] @ self.prior
        return rows


def _known_angle(
    segment: RateSegment,
    matrix: Array,
    recorded: Booleans,  # (3,)
    whole: Array,  # (3, columns), weighted sum of the blocks
    duration: float,  # s, variance of its white noise
    missing: float,  # rad, the known angle less that of the blocks
    errors: Mapping[Name, float],  # of the known angle, for one of each
    own: Sequence[Name],
) -> Array:
    """The equation of a known angle; the motion of the table on the way is no noise here."""
    quiet = np.where(recorded, 1 / np.where(recorded, segment.quiet_density, 1.0), 0.0)
    along = quiet * (matrix @ segment.about)
    duration += _ends(along, quiet, segment.quantisation)
    along = quiet * along / (np.linalg.norm(along) * np.sqrt(duration))
    row = along @ whole
    # M multiplies the known angle, from which the sum of the blocks' angles differs a little.
    change = np.kron(along, missing * segment.about)
    row[:9] += change
    row[-1] -= change @ np.eye(3).ravel()
    for error, size in errors.items():
        row[own.index(error) - len(own) - 1] += along @ (matrix @ segment.about) * size
    return np.asarray(row)


def _errors_of(segment: RateSegment, name: str, window: EncoderWindow) -> dict[Name, float]:
    """The errors of the angle that the encoder reads over a window."""
    errors = {DELAY: -window.change, **dict(zip(WAVES, np.negative(window.waves), strict=True))}
    errors |= {_edge(name, window.start): -1.0, _edge(name, window.end): 1.0}
    if segment.clock_sigma:
        errors[(CLOCK, segment.clock)] = window.end - window.start
    return errors


def _edge(name: str, angle: float) -> Name:
    """The error of the encoder at one of its readings."""
    return ("angle", f"{name} at {angle!r}")
