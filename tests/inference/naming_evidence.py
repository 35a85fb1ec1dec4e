"""What the equations of a made-up campaign say of a catalogue: Gaussian evidence, and residuals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from inertial.arrays import Array
from inertial.estimation.effect_information import EffectInformation
from inertial.model_selection.evidence import Evidence, SearchedEffect, searched_effect
from inertial.model_selection.search import Candidates
from inertial.model_selection.structure_tests import TESTS, Conditions, ScoreEquations
from tests.inference.naming_plans import (
    GRAVITY,
    Rows,
    catalogue,
    common,
    matrix,
    rows_of,
    times_of_jumps,
)

ARW, VRW = 2.9e-5, 5e-4  # rad/√s, (m/s)/√s
TILT = 2 / 206265  # rad, of every position


@dataclass(frozen=True)
class Plan:
    """A campaign's equations, and a way to draw what they would say."""

    rows: Rows
    effects: tuple[SearchedEffect, ...]
    informations: tuple[Array, Array]  # gyros, accelerometers
    roots: tuple[Array, Array]  # of the informations
    raw: Array  # before anything else is fitted, by sensor
    degrees: tuple[int, int]

    @property
    def information(self) -> Array:
        return self.informations[0] + self.informations[1]

    def index(self, name: str) -> int:
        return [one.name for one in self.effects].index(name)

    def draw(self, beta: Array, rng: np.random.Generator) -> Evidence:
        """What the sensors would say with these parameters, (k,)."""
        sensors = []
        for information, root, degrees in zip(
            self.informations, self.roots, self.degrees, strict=True
        ):
            white: Array = rng.standard_normal((root.shape[1],))
            noise: Array = root @ white
            right = information @ beta + noise
            # What lies along the columns, and what no column reaches.
            left = float(white @ white + rng.chisquare(degrees - root.shape[1]))
            left += float(np.dot(beta, right + noise))
            sensors.append(EffectInformation(self.names, information, right, left, degrees))
        return Evidence(tuple(sensors), ("gyro", "accel"), raw=self.raw)

    @property
    def names(self) -> tuple[str, ...]:
        return tuple(f"c{i}" for i in range(self.raw.shape[1]))

    def noise(self, draws: int, rng: np.random.Generator) -> Array:
        """What all sensors together would say without effects, (k, draws)."""
        return np.asarray(sum(r @ rng.standard_normal((r.shape[1], draws)) for r in self.roots))

    def alike(self, one: str, other: str) -> bool:
        """Whether an effect can mimic most of another, on the average over directions."""
        rng = np.random.default_rng(3)
        candidates = Candidates(self.effects)
        own = candidates.effect == self.index(other)
        shares = []
        for _ in range(5):
            beta, _ = self.signal(one, 1.0, rng)
            drops, _ = candidates.drops(self.information, self.information @ beta)
            shares.append(drops[own].max())
        return float(np.mean(shares)) >= 0.9

    def signal(self, name: str, snr: float, rng: np.random.Generator) -> tuple[Array, int]:
        """An effect of random direction and this signal-to-noise ratio, and which candidate."""
        one = self.effects[self.index(name)]
        value = int(rng.integers(len(one.candidates)))
        if len(one.candidates) > 20:  # not at the ends of the campaign
            value = int(rng.integers(4, len(one.candidates) - 4))
        columns = list(one.candidates[value])
        F = self.information[np.ix_(columns, columns)]
        beta = np.zeros(self.raw.shape[1])
        direction = rng.standard_normal(len(columns)) / np.sqrt(
            np.maximum(self.raw.sum(axis=0)[columns], 1e-30)
        )
        beta[columns] = direction * snr / np.sqrt(direction @ F @ direction)
        return beta, value


def _root(information: Array) -> Array:
    """F = RR', of full rank."""
    size = np.sqrt(np.diag(information))
    unit = np.where(size > 0, size, 1.0)
    values, vectors = np.linalg.eigh(information / np.outer(unit, unit))
    kept = values > 1e-10 * values[-1]
    return np.asarray(size[:, None] * vectors[:, kept] * np.sqrt(values[kept]))


def whitened(plan: str) -> tuple[Rows, tuple[tuple[Array, Array], ...]]:
    """The rows; for gyros and accelerometers sigma (3n,) and the fitted columns in units of it,
    those of known errors followed by their prior, as rows of their own."""
    r = rows_of(plan)
    n = len(r.time)
    result = []
    for density, truth in ((ARW, r.rate + r.earth), (VRW, GRAVITY * r.up)):
        base = [common(np.ones(n)), matrix(truth)]
        sigma = np.repeat(density / np.sqrt(r.seconds), 3)
        if density == VRW:
            for position in np.unique(r.position):
                here = (r.position == position)[:, None, None]
                tilt = np.stack([np.cross(r.up, e) * GRAVITY * TILT for e in np.eye(3)], 2)
                base.append(here * tilt)
        columns = np.concatenate(base, axis=2).reshape(3 * n, -1) / sigma[:, None]
        result.append((sigma, columns))
    return r, tuple(result)


@cache
def plan_of(plan: str, jumps: tuple[float, ...] = ()) -> Plan:
    """The evidence of a plan.

    `jumps`: the times at which a jump is sought; none: about every minute of the plan, also of
    the plan that is extended.
    """
    r, sensors = whitened(plan)
    n = len(r.time)
    effects, blocks = [], []
    start = 0
    times = np.array(jumps) if jumps else times_of_jumps(plan[0])
    for name, traces in catalogue(r, times).items():
        count = max(len(traces[0]), len(traces[1]))
        candidates = []
        for i in range(count):
            parts = [side[i] if len(side) == count else side[0] for side in traces]
            width = max(part.shape[2] for part in parts)
            parts = [p if p.shape[2] else np.zeros((n, 3, width)) for p in parts]
            blocks.append(parts)
            candidates.append(range(start, start + width))
            start += width
        effects.append(searched_effect(name, *candidates, free=name.startswith("any")))
    informations, degrees = [], []
    raw = np.zeros((2, start))
    for side, (sigma, columns) in enumerate(sensors):
        X = np.concatenate([b[side] for b in blocks], axis=2).reshape(3 * n, -1) / sigma[:, None]
        known = columns.shape[1] - 12
        prior = np.diag([1e-12] * 12 + [1.0] * known)
        size = np.sqrt(np.sum(columns**2, axis=0)) * (np.arange(columns.shape[1]) < 12)
        size = np.where(size > 0, size, 1.0)
        Q = np.linalg.qr(np.vstack([columns / size, prior]))[0][: 3 * n]
        rest = X - Q @ (Q.T @ X)
        own = np.sum(X**2, axis=0)
        raw[side] = own
        F = X.T @ rest
        F = (F + F.T) / 2
        gone = np.diag(F) < 1e-9 * np.maximum(own, 1e-30)
        F[gone] = 0.0
        F[:, gone] = 0.0
        informations.append(F)
        degrees.append(3 * n - 12)
    gyro, accel = informations
    roots = (_root(gyro), _root(accel))
    return Plan(r, tuple(effects), (gyro, accel), roots, raw, (degrees[0], degrees[1]))


@dataclass(frozen=True)
class Residuals:
    """What a fit leaves, `values` (n,) in units of `sigma`, and where it was read.

    `design`: (n, p), what was fitted, in units of sigma; `prior_sigma`: (p,), infinite where
    nothing was known; `channel`: (n,), which of six; `noise_degrees`: from which sigma is known.
    """

    values: Array
    sigma: Array
    channel: NDArray[np.int64]
    design: Array
    prior_sigma: Array
    read: Conditions
    noise_degrees: float = np.inf

    def answers(self) -> Iterator[ScoreEquations]:
        """What they say of every question of the six tests."""
        stacked = np.vstack([self.design, np.diag(1 / self.prior_sigma)])
        size = np.sqrt(np.sum(stacked**2, axis=0))
        space, triangle = np.linalg.qr(stacked / np.where(size > 0, size, 1.0))
        turn, values, _ = np.linalg.svd(triangle)
        space = (space @ turn[:, values > 1e-10 * values.max()])[: len(self.values)]
        degrees = round(len(self.values) - float(np.sum(space**2)))
        for channel in np.unique(self.channel):
            own = self.channel == channel
            r = self.read
            where = Conditions(
                r.time[own], r.angle[own], r.rate[own], r.up[own], r.temperature[own]
            )
            for kind, test in TESTS.items():
                for question in test(where):
                    functions = question.functions / self.sigma[own, None]
                    shadow = space[own].T @ functions
                    information = functions.T @ functions - shadow.T @ shadow
                    fitted = np.diag(information) < 1e-6 * np.sum(functions**2, axis=0)
                    left = np.where(fitted, 0.0, 1.0)
                    yield ScoreEquations(
                        kind,
                        ("gyro", "accel")[channel // 3],
                        "xyz"[channel % 3],
                        question,
                        information * np.outer(left, left),
                        functions.T @ self.values[own] * left,
                        float(self.values @ self.values),
                        degrees,
                        self.noise_degrees,
                    )


def fits(plan: str, signal: Array, rng: np.random.Generator) -> list[Residuals]:
    """What is left when the 24 parameters and the tilts are fitted to readings with a signal.

    `signal`: (2, n, 3), what gyros and accelerometers read beside the baseline, SI.
    """
    r, sensors = whitened(plan)
    found = []
    for number, (sigma, columns) in enumerate(sensors):
        axis = np.tile(np.arange(3), len(r.time))
        known = columns.shape[1] - 12
        tilts = columns[:, 12:] @ rng.standard_normal(known)
        y = signal[number].ravel() / sigma + tilts + rng.standard_normal(len(sigma))
        prior = np.r_[np.full(12, np.inf), np.ones(known)]
        stacked = np.vstack([columns, np.diag(1 / prior)])
        size = np.sqrt(np.sum(stacked**2, axis=0))
        fit = np.linalg.lstsq(stacked / size, np.r_[y, np.zeros(len(prior))], rcond=1e-12)[0]
        turning = np.repeat(np.isfinite(r.angle), 3)
        table = np.repeat(np.einsum("ij,ij->i", r.rate, r.up), 3)
        felt = r.rate.ravel() if number == 0 else table
        read = Conditions(
            np.repeat(r.time, 3),
            np.where(turning, np.repeat(r.angle, 3), np.nan),
            felt,
            np.repeat(r.up, 3, axis=0),
            np.repeat(r.temperature, 3),
        )
        left = y - columns @ (fit / size)
        found.append(Residuals(left, sigma, 3 * number + axis, columns, prior, read))
    return found
