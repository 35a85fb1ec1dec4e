"""The gyros from static positions and rate segments of a known angle, all nine elements of M."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from inertial.estimation.elimination import EquationBlock, Name, eliminate
from inertial.estimation.gyroscope_rows import (
    Around,
    Bridge,
    Earth,
    Position,
    Steady,
    Still,
    Turn,
    of_rests,
    of_steady,
    of_turn,
)
from inertial.estimation.horizontal_earth_rate import known_azimuths, sized
from inertial.estimation.least_squares import Estimate, System, solve
from inertial.estimation.random_walk import Stretch, linear_trend, with_drifts
from inertial.estimation.triad import UNKNOWNS
from inertial.estimation.variance_components import ScatterFit, walk_search, with_random_walk

# ---- Bias and scale factor error of one gyro from whole turns about it, as S0 has it.


@dataclass(frozen=True)
class Angle:
    """One whole turn as its own axis saw it: summed angle of that gyro, α, duration, up or down."""

    summed: float  # rad
    angle: float  # rad, along the axis
    angle_sigma: float
    seconds: float
    up: float  # +1 where the axis points up, −1 where it points down
    density: float  # rad/√s


def known_angle(turns: Sequence[Angle], earth: Earth, scatter: float = 0.0) -> Estimate:
    """Bias and scale factor error of one gyro from turns about it, forward and backward.

    α̃ = b t + (1 + s) α + ω_e sinφ t for each turn; for one forward and one backward turn over
    equal times this is S0 (3-9), (3-10): b = (α̃₁+α̃₂)/(2t) − ω_e sinφ, s = (α̃₁−α̃₂)/(2α) − 1.
    Unknowns: b, s, the upward earth rate. `scatter` as in `joint`.
    """
    seconds = np.array([turn.seconds for turn in turns])
    angles = np.array([turn.angle for turn in turns])
    up = np.array([turn.up for turn in turns])
    summed = np.array([turn.summed for turn in turns])
    variance = [turn.density**2 * turn.seconds + turn.angle_sigma**2 for turn in turns]
    sigma = np.sqrt(variance + (scatter * seconds) ** 2)
    design = np.column_stack([seconds, angles, up * seconds])
    prior, prior_sigma = np.array([0.0, 0.0, earth.up]), np.array([1.0, 1.0, earth.up_sigma])
    return solve(design, summed - angles, sigma, prior, prior_sigma, 2)


# ---- The gyros from turns of a known angle and from rests, all three by all three.
#
#     sum over a block = M · (u Δθ + E) + bias · τ + noise
#
# u is the axis of the turn in body axes, tilted by δ; Δθ the angle that the table
# turns during the block; E the earth's rate in body axes, summed. The table keeps
# no exact rate, so Δθ of every block is an unknown that only its own three
# readings tell; what is known is the whole angle from rest to rest. So a block
# gives the two combinations of its channels that do not see Δθ, and the turn as a
# whole the third.
#
# A stretch that is missing in a turn is bridged by the blocks about it: the table turned in it as
# at their rate, which is known to a sigma only, an unknown of its own. So in the turn as a whole
# every block counts for itself and for its share of what is missing,
#
#     sum of w · (sum over a block) = M · (u α + sum of w · E) + bias · sum of w · τ,   w ≥ 1,
#
# and noise, earth and bias are those of what was recorded, w times. In a steady part the
# share is the same for all, T_missing/T_steady; by the sums S of one gyro that is a recorded angle
# of α / (1 + S_steady/S · T_missing/T_steady), in which its scale factor cancels.
#
# The earth's rate has an upward part, known from the latitude, and a level part of
# known size whose direction is known only with `mark` and the table's heading. Else
# it is an unknown of each position, with the size as its sigma.

__all__ = [
    "Angle",
    "Around",
    "Bridge",
    "Earth",
    "Position",
    "Steady",
    "Still",
    "Turn",
    "about",
    "around_of",
    "equations",
    "fitted",
    "joint",
    "known_angle",
]

Array = NDArray[np.float64]

# Vague priors: M within 0.1 of the unit matrix, the bias within 1 rad/s. Without turns only the
# earth's rate shows M, and a wider prior would let an absurd M explain an unknown azimuth.
PRIOR = np.append(np.eye(3).ravel(), np.zeros(3))
PRIOR_SIGMA = np.append(np.full(9, 0.1), np.full(3, 1.0))
ROUNDS = 5  # times that the equations are made
BIAS = 9  # where the three biases stand
WALK = 8e-5  # rad/s/√s, 1000 °/h/√h: a hundred times that of the poorest gyros
SCATTER = (1e-11, 0.1)  # rad/s: how much manoeuvres may differ beyond the noise


def joint(
    stills: Sequence[Still],
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    position_sigma: float,
    scatter: float = 0.0,
    walk: float = 0.0,
) -> Estimate:
    """Bias and M of the gyros from all rests and turns at once.

    `scatter`, rad/s, is by what the readings differ from manoeuvre to manoeuvre beyond noise;
    `walk`, rad/s/√s, by what the bias walks from one to the next, see `random_walk`.

    The equations hold products of M with the errors, so they are solved some times,
    each time about the last result. So is what is known of the level earth rate, see `azimuth`.
    """
    around = Around(np.eye(3), _first_bias(stills), {})
    for _ in range(ROUNDS):
        linear = about(around, turns, steadies, earth, position_sigma)
        estimate = linear.system(stills, scatter, walk).solve()
        around = around_of(estimate, earth)
    return estimate


def fitted(
    stills: Sequence[Still],
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    position_sigma: float,
    noise_degrees: float = np.inf,
) -> ScatterFit:
    """The joint estimate with that scatter and that random walk which the data ask for."""
    rows = (turns, steadies, earth, position_sigma)
    estimate = joint(stills, *rows)
    linear = about(around_of(estimate, earth), *rows)

    def fit(scatter: float, walk: float) -> Estimate:
        return linear.system(stills, scatter, walk).solve_shared()

    every: list[Still | Turn | Steady] = [*stills, *turns, *steadies]
    attitudes = {one.position.name: str(np.round(one.position.up, 3)) for one in every}

    def alike(by: Callable[[str, Stretch], Stretch]) -> Callable[[float], float]:
        return lambda size: linear.system(stills, size, alike=by).solve_shared().deviance

    stretches = [one.stretch for one in every if one.stretch is not None]
    rivals = [
        alike(lambda position, _: Stretch(position)),
        alike(lambda position, _: Stretch(attitudes[position])),
    ]
    if stretches:
        straight = linear_trend(stretches)
        rivals.append(alike(lambda _, stretch: straight(stretch)))
    noises = [one.sigma for one in every if not isinstance(one, Turn)]
    noise = float(np.nanmedian([*noises, np.full(3, np.nan)])) if noises else 0.0
    found = with_random_walk(
        fit, SCATTER, walk_search(stretches, noise, WALK), rivals, noise_degrees
    )
    if found.scatter or found.random_walk:
        estimate = joint(stills, *rows, found.scatter, found.random_walk)
    return replace(found, estimate=estimate)


def around_of(estimate: Estimate, earth: Earth) -> Around:
    """To be linear about an estimate."""
    values = estimate.values
    levels = dict(zip(estimate.names, values.tolist(), strict=True))
    sigmas = dict(zip(estimate.names, estimate.sigma.tolist(), strict=True))
    return Around(values[:9].reshape(3, 3), values[9:12], levels, known_azimuths(sigmas, earth))


def _first_bias(stills: Sequence[Still]) -> Array:
    if not stills:
        return np.zeros(3)
    known = [column[np.isfinite(column)] for column in np.array([s.mean for s in stills]).T]
    return np.array([np.median(readings) if len(readings) else 0.0 for readings in known])


@dataclass(frozen=True)
class Linear:
    """The equations of turns linear about a place, made once; those of rests are added to them.

    `parts`: with the position and the stretch of each; `sigma`: of the errors; `wide`: of effects.
    """

    around: Around
    earth: Earth
    wide: Mapping[str, float]
    parts: Sequence[tuple[str, EquationBlock, Stretch]]
    sigma: Mapping[Name, float]

    def system(
        self,
        stills: Sequence[Still],
        scatter: float = 0.0,
        walk: float = 0.0,
        alike: Callable[[str, Stretch], Stretch] | None = None,
    ) -> System:
        """All equations. Unknowns: M by rows, bias, upward earth rate, effects; apart: the errors.

        `scatter`, `walk`: as in `joint`; `alike`: by position and stretch, whose scatter it has.
        """
        prior = np.concatenate([PRIOR, [self.earth.up], np.zeros(len(self.wide))])
        sigma = dict(self.sigma)
        rests = of_rests(stills, self.around.matrix, self.earth, prior, list(self.wide), sigma)
        by_position: dict[str, list[tuple[EquationBlock, Stretch]]] = {}
        told = sized(self.around, self.earth, len(prior), sigma)
        for position, part, stretch in (*rests, *self.parts):
            one = stretch if alike is None else alike(position, stretch)
            by_position.setdefault(position, []).append((told(part), one))
        every = [one for some in by_position.values() for one in some]
        parts, of_drifts = with_drifts(every, len(prior), BIAS, scatter, walk)
        rows, eliminated = eliminate(parts, len(prior), sigma | of_drifts)
        names = [("parameter", str(i)) for i in range(UNKNOWNS)]
        names += [("earth", "up"), *(("effect", name) for name in self.wide)]
        return System(
            rows[:, :-1],
            rows[:, -1] + rows[:, :-1] @ prior,
            np.ones(len(rows)),
            prior,
            np.array([*PRIOR_SIGMA, self.earth.up_sigma, *self.wide.values()]),
            UNKNOWNS,
            tuple(names),
            eliminated,
        )


def about(
    around: Around,
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    position_sigma: float,
    wide: Mapping[str, float] | None = None,
) -> Linear:
    """The equations of turns and steady runs, linear about `around`.

    `position_sigma`: of the positions, rad; `wide`: effects that are unknowns, with their sigmas.
    """
    wide = wide or {}
    prior = np.concatenate([PRIOR, [earth.up], np.zeros(len(wide))])
    sigma: dict[Name, float] = {}
    parts: list[tuple[str, EquationBlock, Stretch]] = []
    for number, turn in enumerate(turns):
        name = f"{turn.position.name} {number}"
        part = of_turn(turn, name, around, earth, position_sigma, prior, list(wide), sigma)
        if part is not None:
            parts.append((turn.position.name, part, turn.stretch or Stretch(name)))
    for number, steady in enumerate(steadies):
        name = f"{steady.position.name} {number}"
        part = of_steady(
            steady, name, around.matrix, earth, position_sigma, prior, list(wide), sigma
        )
        stretch = steady.stretch or Stretch(f"{name} (steady)")
        parts.append((steady.position.name, part, stretch))
    return Linear(around, earth, wide, parts, sigma)


def equations(
    stills: Sequence[Still],
    turns: Sequence[Turn],
    steadies: Sequence[Steady],
    earth: Earth,
    sigmas: tuple[float, float, float],
    around: Around,
    wide: Mapping[str, float] | None = None,
) -> System:
    """The equations of all rests and turns, linear about `around`.

    `sigmas`: of the positions, rad, scatter and walk as in `joint`; `wide`: as in `about`.
    """
    linear = about(around, turns, steadies, earth, sigmas[0], wide)
    return linear.system(stills, *sigmas[1:])
