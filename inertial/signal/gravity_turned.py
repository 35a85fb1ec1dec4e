"""Whether the gyros turn gravity as the accelerometers see it turn: axes and signs without a plan.

Of the upward direction v in body axes dv/dt = v × ω. With f = g v + b, and ω = G w − c where the
gyros read w, over a time T

    f(T) − f(0) = ∫ f × G w dt − H ∫ w dt − ∫ f dt × c + d T,    H = [b]× G,  d = b × c,

which is linear in the 24 unknowns G, H, c, d, so neither a bias nor a scale factor of
either sensor matters. Where an IMU is moved by hand its acceleration is noise. G is near the unit
matrix, or near that signed permutation by which the axes of the sensors differ. A turn about the
vertical says nothing, and what changes there is the pull of a lever arm, which does not stay where
it is in space. Accelerometers that all read their negative turn in the same way.

A gyro may read its negative in a part of a recording alone. A motion from rest to rest, consecutive
spans of it, tells its sign by which of both fits: a motion that tells nothing fits either way.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from inertial.arrays import Array, Integers
from inertial.signal.axis_permutations import Permutation
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.units import STANDARD_GRAVITY

SPAN_S = 0.5  # over which a change of the force is compared with the gyros
MIN_TURNED = 0.05  # rad, of the gyros and of the force, within it: less tells nothing
MAX_ARM = (
    0.4  # m: a change of the force within that times the rate squared may be the pull of an arm
)
MIN_SPANS, MAX_SPANS = 12, 20_000  # of three equations each, for 24 unknowns
MIN_ENTRY_SIGMA = 10.0  # sigmas of the entries of G that decide
MAX_ENTRY_SIGMA = 0.15  # of any entry
MAX_OFF_DIAGONAL = 0.5  # of the largest entry of its row and column
MAX_CONTRADICTING = 0.1  # of the spans that tell a sign: more is a sign of a part of them
REWEIGHTINGS = 10
ROBUST_SIGMA = 3.0  # sigmas from which on a span counts less: Cauchy's weights
UNKNOWNS = 24
MIN_SIGN_GAIN = 15.0  # of the logarithm of Cauchy's likelihood, by the one sign in a motion
MIN_ABOUT = 0.1  # rad, about an axis in a motion: its gyro with the other sign is far from any bias
MAX_MISFIT = np.log(2)  # of its negative, the mean of a motion: they fit to ROBUST_SIGMA
PRIOR = 1e-6  # of the normal matrix: what nothing determines stays 0

Stretch = tuple[Array, Array, float]  # of consecutive short means: forces, rates, time between them


@dataclass(frozen=True)
class Turned:
    """G, (3, 3), with its sigma, and from how many spans of half a second.

    `contradicting`: (3,), which share of the spans that tell the sign of a row of G are for the
    other one: an axis that is reversed for a time has both.
    unknowns : (24,), all of them; scatter : m/s², of a span about them
    """

    matrix: Array
    sigma: Array
    spans: int
    contradicting: Array
    unknowns: Array
    scatter: float

    @property
    def axes(self) -> Permutation | None:
        """As `axes_of_most`, if no axis is reversed for a time."""
        return None if (self.contradicting > MAX_CONTRADICTING).any() else self.axes_of_most

    @property
    def axes_of_most(self) -> Permutation | None:
        """What takes the readings of the gyros to the axes of the accelerometers, if it is sure."""
        size = np.abs(self.matrix)
        sources = np.argmax(size, axis=1)
        if sorted(sources) != [0, 1, 2] or (self.sigma > MAX_ENTRY_SIGMA).any():
            return None
        own = size[np.arange(3), sources]
        others = size.copy()
        others[np.arange(3), sources] = 0.0
        if (others > MAX_OFF_DIAGONAL * own[:, None]).any():
            return None
        if (own < MIN_ENTRY_SIGMA * self.sigma[np.arange(3), sources]).any():
            return None
        signs = np.sign(self.matrix[np.arange(3), sources]).astype(int)
        return Permutation(tuple(sources.tolist()), tuple(signs.tolist()))


def turned(stretches: Sequence[Stretch], arm: float = 0.0) -> Turned | None:
    """How the gyros turn gravity; None where too little is turned.

    Parameters
    ----------
    stretches : of consecutive short means: forces, (k, 3), m/s²; rates less their level at rest,
        (k, 3), rad/s; the time from one to the next, s
    arm : m, `MAX_ARM` where the units of the rates and of the time are known
    """
    spans = [_spans(*stretch, arm) for stretch in stretches]
    design = np.concatenate([np.empty((0, 3, UNKNOWNS)), *(part for part, _, _ in spans)])
    change = np.concatenate([np.empty((0, 3)), *(part for _, part, _ in spans)])
    if len(change) < MIN_SPANS:
        return None
    every = -(-len(change) // MAX_SPANS)
    design, change = design[::every].reshape(-1, UNKNOWNS), change[::every].ravel()
    weight = np.ones(len(change))
    for _ in range(REWEIGHTINGS):
        weighted = design * weight[:, None]
        normal = weighted.T @ design
        inverse = np.linalg.inv(normal + PRIOR * np.eye(UNKNOWNS))
        left = change - design @ (inverse @ (weighted.T @ change))
        scatter = MAD_TO_SIGMA * float(np.median(np.abs(left))) or 1.0
        with np.errstate(over="ignore"):  # without noise: far out the weight is 0
            weight = 1 / (1 + (left / (ROBUST_SIGMA * scatter)) ** 2)
    of_each = design * (weight * left)[:, None]
    covariance = inverse @ (of_each.T @ of_each) @ inverse  # whatever the scatter of each
    # What is not determined at all stays at 0: its sigma is that of the prior.
    sigma = np.sqrt(np.diag(covariance) + PRIOR * np.diag(inverse))
    solution = inverse @ (weighted.T @ change)
    matrix = solution[:9].reshape(3, 3)
    left = (change - design @ solution).reshape(-1, 3)
    contradicting = np.zeros(3)
    for row in range(3):
        other = left + 2 * (design[:, 3 * row : 3 * row + 3] @ matrix[row]).reshape(-1, 3)
        tells = np.linalg.norm(other - left, axis=1) > ROBUST_SIGMA * 2 * scatter
        wrong = np.linalg.norm(other, axis=1) < np.linalg.norm(left, axis=1)
        contradicting[row] = np.sum(wrong & tells) / max(np.sum(tells), 1)
    both = (matrix, sigma[:9].reshape(3, 3))
    return Turned(*both, len(change) // 3, contradicting, solution, scatter)


@dataclass(frozen=True)
class Motion:
    """Means [first, after) in which gravity is turned; spans: how many.

    reversed : (3,), by gyro: +1 where it reads as in most of the recording, −1 where its negative,
    0 where the motion does not tell
    """

    first: int
    after: int
    spans: int
    reversed: Integers


def motions(stretch: Stretch, seen: Turned, most: float = MAX_MISFIT) -> Iterator[Motion]:
    """The motions of a stretch, as of `turned`, and the signs of the gyros in each.

    most : mean loss up to which a motion fits
    """
    forces, rates, step = stretch
    steps = max(round(SPAN_S / step), 1)
    design, change, starts = _spans(forces, rates, step, MAX_ARM)
    losses = np.empty((4, len(starts)))
    for way in range(4):  # as it is, and each gyro with the other sign
        of_gyros = design
        if way:
            of_gyros = design.copy()
            of_gyros[:, :, [k for k in range(18) if k % 3 == way - 1]] *= -1
        left = (change - of_gyros @ seen.unknowns) / (ROBUST_SIGMA * seen.scatter)
        with np.errstate(over="ignore"):
            losses[way] = np.log1p(left**2).sum(axis=1)
    breaks = np.flatnonzero(np.diff(starts) > steps) + 1
    for own in np.split(np.arange(len(starts)), breaks):
        if not len(own):
            continue
        total = losses[:, own].sum(axis=1)
        gains = total[1:] - total[0]
        fits = np.minimum(total[1:], total[0]) < most * 3 * len(own)
        first, after = int(starts[own[0]]), int(starts[own[-1]]) + steps
        about = np.abs(rates[first:after]).sum(axis=0) * step
        told = fits & (np.abs(gains) > MIN_SIGN_GAIN) & (about > MIN_ABOUT)
        yield Motion(first, after, len(own), np.sign(gains).astype(np.int64) * told)


def signs_of_motions(
    stretches: Sequence[Stretch], seen: Turned
) -> tuple[Turned, list[list[Motion]]]:
    """The motions of each stretch, as by the recording in which all read alike, which is given too.

    Where a few motions are reversed, they pull at the unknowns of all: these are found anew with
    the motions read as they seem to be. Where so many are that no axes are seen, by the names.
    """
    if seen.axes_of_most is None:
        seen = replace(seen, unknowns=np.append(np.eye(3).ravel(), np.zeros(UNKNOWNS - 9)))
    alike = []
    for forces, rates, step in stretches:
        read = rates.copy()
        for one in motions((forces, rates, step), seen, np.inf):
            read[one.first : one.after + 1] *= np.where(one.reversed < 0, -1.0, 1.0)
        alike.append((forces, read, step))
    anew = turned(alike, MAX_ARM) or seen
    return anew, [list(motions(stretch, anew)) for stretch in stretches]


def _spans(forces: Array, rates: Array, step: float, arm: float) -> tuple[Array, Array, Integers]:
    """The equations of all spans: ∂/∂(G, H, c, d), (n, 3, 24), the change of f, (n, 3), begins."""
    steps = max(round(SPAN_S / step), 1)
    starts = np.arange(0, len(forces) - steps, steps)
    inside = starts[:, None] + np.arange(steps + 1)
    f, rate = forces[inside], rates[inside]  # (n, steps + 1, 3)
    share = np.full(steps + 1, step)
    share[[0, -1]] /= 2  # the trapezoidal rule
    across = np.zeros((*f.shape, 3))  # [f]×
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        across[..., i, j], across[..., j, i] = -f[..., k], f[..., k]
    of_matrix = np.einsum("s,nsir,nsc->nirc", share, across, rate).reshape(-1, 3, 9)
    whole = np.einsum("s,nsc->nc", share, rate)
    of_bias = -np.einsum("ir,nc->nirc", np.eye(3), whole).reshape(-1, 3, 9)
    of_level = -np.einsum("s,nsir->nir", share, across)
    of_both = np.broadcast_to(steps * step * np.eye(3), of_level.shape)
    change = f[:, -1] - f[:, 0]
    across_both = np.linalg.norm(np.cross(f[:, 0], f[:, -1]), axis=1)
    along = np.einsum("nc,nc->n", f[:, 0], f[:, -1])
    moved = (np.linalg.norm(whole, axis=1) > MIN_TURNED) & (
        np.arctan2(across_both, along) > MIN_TURNED
    )
    at_ends = np.sum(rate[:, [0, -1]] ** 2, axis=2).max(axis=1)  # between them it comes and goes
    moved &= np.linalg.norm(change, axis=1) > arm * at_ends
    there = np.isfinite(of_matrix).all(axis=(1, 2)) & moved
    design = np.concatenate([of_matrix, of_bias, of_level, of_both], axis=2)
    return design[there], change[there], starts[there]


# ---- The rate at which the specific force turns in the case, on a table with a level axis.
#
#     f(t) = c + A cos ωt + B sin ωt
#
# Bias, scale factors, cross terms and a lever arm are in c, A and B, so the accelerometers need no
# calibration: they count rounds. ω is had by Gauss and Newton's iteration from the planned rate.

MIN_ROUNDS = 1.0  # else a sine is not told from its tangent
MIN_MEANS = 12  # of seven unknowns in each axis
ITERATIONS = 8
MIN_AMPLITUDE = 0.5 * STANDARD_GRAVITY  # of what turns: about an axis that is level, not upright
MAX_CHANGE = 0.1  # relative, of the planned rate: what is further off is another rate


def rate_of_gravity(forces: Array, time: Array, planned: float) -> tuple[float, float]:
    """The rate, rad/s above 0, and its sigma by what the means scatter by; NaN where none turns.

    Parameters
    ----------
    forces : (k, 3), m/s², means over short parts of a steady turn; time : (k,), s, of their middles
    planned : rad/s, of any sign
    """
    nothing = (np.nan, np.nan)
    there = np.isfinite(forces).all(axis=1)
    forces, time = forces[there], time[there] - time[there].mean() if there.any() else time[there]
    rate = abs(planned)
    if len(time) < MIN_MEANS or np.ptp(time) * rate < 2 * np.pi * MIN_ROUNDS:
        return nothing
    for _ in range(ITERATIONS):
        cosine, sine = np.cos(rate * time), np.sin(rate * time)
        waves = np.column_stack([np.ones_like(time), cosine, sine])
        found = np.linalg.lstsq(waves, forces, rcond=None)[0]
        left = forces - waves @ found
        slope = time[:, None] * (np.outer(cosine, found[2]) - np.outer(sine, found[1]))
        slope -= waves @ np.linalg.lstsq(waves, slope, rcond=None)[0]
        information = float(np.sum(slope**2))
        if not information > 0:
            return nothing
        rate += float(np.sum(slope * left)) / information
        if abs(rate / planned) - 1 > MAX_CHANGE or rate <= 0:
            return nothing
    if (
        np.linalg.norm(found[1:]) / np.sqrt(2) < MIN_AMPLITUDE
        or abs(rate / planned) < 1 - MAX_CHANGE
    ):
        return nothing
    degrees = left.size - found.size - 1
    return rate, float(np.sqrt(np.sum(left**2) / degrees / information))
