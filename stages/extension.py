"""The model with the effects that criticism named, refitted, and what it gains."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts import tables
from stages.contracts.parquet import Stream
from stages.contracts.records import known_of, manoeuvres_of, performed_of, rows_of, share_a_clock
from stages.contracts.stage import Stage, Tables
from stages.effects import CATALOGUE
from stages.estimation.estimates import by_mount, described
from stages.estimation.evidence import Campaign, campaign_of
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.ringing import steady_residuals
from stages.estimation.solution import Solution, solution_of
from stages.inference.least_squares import Estimate, System
from stages.inference.lines import without_line
from stages.inference.triad import errors_of, linear_names
from stages.model.effect import Effect

Array = NDArray[np.float64]
Row = dict[str, Any]

WIDE = 1e4  # sigma of an effect's parameters beforehand, in their typical sizes
FOLDS = 4  # groups of manoeuvres, each foretold from the others
SENSORS = {"gyro": "gyroscope", "accel": "accelerometer"}


def extension(
    simulated: Stream,
    scores: pd.DataFrame,
    effects: pd.DataFrame,
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    clocks: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_positions: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_positions: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
) -> Tables:
    """Parameters and covariance of the extended model, and its gain on fitted and held-out data.

    Where nothing was named there is nothing to extend, and the tables are empty.
    """
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    named = {row["effect"]: _effect(row) for row in rows_of(scores) if row["named"]}
    in_blocks = [effect for effect in named.values() if effect.sought_in == "blocks"]
    parameters: list[Row] = []
    covariances: list[pd.DataFrame] = []
    gain: list[Row] = []
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        solution = solution_of(
            (accelerometer_parameters, gyroscope_parameters),
            (accelerometer_positions, gyroscope_positions),
            given,
            suffix,
            (accelerometer_fit, gyroscope_fit),
        )
        if in_blocks:
            campaign = campaign_of(
                blocks, plan, done, levels, given, solution, share_a_clock(clocks)
            )
            still = campaign.without_walk()
            if still.deviance(in_blocks) <= campaign.deviance(in_blocks):
                campaign = still  # the effects explain what looked like a random walk
            systems = campaign.systems(in_blocks, WIDE)
            for sensor, system in zip(SENSORS, systems, strict=True):
                if system is not None:
                    rows, covariance = _solved(sensor, suffix, system, in_blocks)
                    parameters += rows
                    covariances.append(covariance)
            gain += _gain(campaign, in_blocks)
        if "oscillation" in named:
            own = {m.name for m in plan}
            steps = {row["log"]: row["step"] for row in rows_of(clocks)}
            step_of = {m.name: steps[m.log] for m in plan}
            turns = [(n, r) for n, r in steady_residuals(simulated) if n in own]
            gain += _gain_of_line(turns, step_of, effects, solution)
    empty = tables.COVARIANCE.empty()
    return {
        "parameters": pd.DataFrame(parameters) if parameters else tables.PARAMETERS.empty(),
        "covariance": pd.concat(covariances) if covariances else empty,
        "gain": pd.DataFrame(gain) if gain else tables.GAIN.empty(),
    }


def _effect(score: Row) -> Effect:
    """The named effect, with the value that was found of what is scanned."""
    effect = CATALOGUE[score["effect"]]
    return effect if score["at"] is None else effect.fixed(score["at"])


def _solved(
    sensor: str, suffix: str, system: System, effects: Sequence[Effect]
) -> tuple[list[Row], pd.DataFrame]:
    """The twelve parameters of a sensor and those of the effects that it shows."""
    estimate = system.solve()
    stage = SENSORS[sensor]
    method = f"{stage}{suffix}"
    names, places, said = [], [], []
    for i, name in enumerate(linear_names()):
        names.append(f"extension/{method}/{name}")
        places.append(i)
        said.append((name, *described(stage, name)))
    for effect in effects:
        for parameter in effect.parameters:
            full = f"{effect.name}.{parameter.name}"
            place = system.column("effect", f"{effect.label}.{parameter.name}")
            if place is not None and estimate.determined[place]:
                names.append(f"extension/{method}/{full}")
                places.append(place)
                said.append((full, parameter.unit, "body", parameter.meaning))
    values = estimate.values.copy()
    values[:12] = errors_of(values[:12])
    rows = [
        {
            "id": name,
            "stage": "extension",
            "method": method,
            "parameter": parameter,
            "value": float(values[place]) if estimate.determined[place] else None,
            "sigma": float(estimate.sigma[place]) if estimate.determined[place] else None,
            "unit": unit,
            "frame": frame,
            "meaning": meaning,
            "reason": "" if estimate.determined[place] else "as in the joint estimate",
        }
        for name, place, (parameter, unit, frame, meaning) in zip(names, places, said, strict=True)
    ]
    matrix = estimate.covariance[np.ix_(places, places)]
    covariance = pd.DataFrame(
        {
            "first": np.repeat(names, len(names)),
            "second": np.tile(names, len(names)),
            "covariance": matrix.ravel(),
        }
    )
    return rows, covariance


def _gain(campaign: Campaign, effects: Sequence[Effect]) -> Iterator[Row]:
    """By how much the effects bring the model nearer to the data, fitted and foretold.

    Held-out: −2 log of the predictive density of the manoeuvres of each fold, given those of
    the others: the difference of the deviances of all and of the others.
    """
    folds = [set(campaign.manoeuvres[start::FOLDS]) for start in range(FOLDS)]
    every = set(campaign.manoeuvres)
    without = _solve(campaign.systems([], WIDE))
    within = _solve(campaign.systems(effects, WIDE))
    others = [_solve(campaign.systems([], WIDE, every - fold)) for fold in folds]
    others_within = [_solve(campaign.systems(effects, WIDE, every - fold)) for fold in folds]
    for number, sensor in enumerate(SENSORS):
        before, after = without[number], within[number]
        if before is None or after is None or not _shows(after):
            continue
        fitted = (before.chi_squared, after.chi_squared)
        yield _row(sensor, effects, "fitted", before.rows, fitted, fitted)
        foretold = [0.0, 0.0]
        misses = [0.0, 0.0]
        rows = 0
        for trained, trained_within in zip(others, others_within, strict=True):
            fewer, fewer_within = trained[number], trained_within[number]
            if fewer is None or fewer_within is None:
                continue
            pairs = [(before, fewer), (after, fewer_within)]
            for i, (whole, part) in enumerate(pairs):
                foretold[i] += whole.deviance - part.deviance
                misses[i] += whole.chi_squared - part.chi_squared
            rows += before.rows - fewer.rows
        if rows:
            told, squares = (foretold[0], foretold[1]), (misses[0], misses[1])
            yield _row(sensor, effects, "held-out", rows, told, squares)


def _shows(estimate: Estimate) -> bool:
    """Whether a sensor sees anything of the effects."""
    effects = [i for i, (kind, _) in enumerate(estimate.names) if kind == "effect"]
    return bool(estimate.determined[effects].any())


def _solve(systems: Sequence[System | None]) -> list[Estimate | None]:
    return [None if system is None else system.solve() for system in systems]


def _row(
    sensor: str,
    effects: Sequence[Effect],
    scope: str,
    rows: int,
    before_after: tuple[float, float],
    squares: tuple[float, float],
) -> Row:
    before, after = before_after
    return {
        "sensor": sensor,
        "effects": ", ".join(effect.name for effect in effects),
        "scope": scope,
        "rows": rows,
        "before": before,
        "after": after,
        "drop": before - after,
        "rms_before": float(np.sqrt(max(squares[0], 0.0) / rows)),
        "rms_after": float(np.sqrt(max(squares[1], 0.0) / rows)),
        "unit": "sigma",
    }


def _gain_of_line(
    turns: Sequence[tuple[str, Array]],
    step_of: dict[str, float],
    effects: pd.DataFrame,
    solution: Solution,
) -> Iterator[Row]:
    """What an oscillation explains of the full-rate residuals about its axis.

    Held-out: the frequency is that of all turns and the amplitude that of the other turns; only
    the phase is the turn's own, for nothing could foretell it.
    """
    values = {r["parameter"]: r["value"] for r in rows_of(effects) if r["effect"] == "oscillation"}
    frequency = values.get("frequency")
    if frequency is None or solution.gyro is None or not turns:
        return
    inverse = np.linalg.inv(solution.gyro.matrix)
    truths = {name: residuals @ inverse.T for name, residuals in turns}
    spread = np.mean([truth.std(axis=0) for truth in truths.values()], axis=0)
    axis = int(np.argmax(spread))
    parts = {
        name: without_line(truth[:, axis], 1 / step_of[name], frequency)
        for name, truth in truths.items()
    }
    amplitudes = {name: part.amplitude for name, part in parts.items()}
    samples = sum(len(truth) for truth in truths.values())
    before = sum(float(np.sum(part.record**2)) for part in parts.values())
    for scope in ("fitted", "held-out"):
        after = 0.0
        for name, part in parts.items():
            rest = [a for other, a in amplitudes.items() if other != name]
            size = amplitudes[name] if scope == "fitted" or not rest else float(np.mean(rest))
            after += float(np.sum(part.less(size) ** 2))
        yield {
            "sensor": f"gyro {'xyz'[axis]}",
            "effects": "oscillation",
            "scope": scope,
            "rows": samples,
            "before": before / samples,
            "after": after / samples,
            "drop": (before - after) / samples,
            "rms_before": float(np.sqrt(before / samples)),
            "rms_after": float(np.sqrt(after / samples)),
            "unit": "rad/s",
        }


STAGE = Stage(
    extension,
    reads={
        "simulated": tables.SIMULATED,
        "scores": tables.SCORES,
        "effects": tables.EFFECTS,
        "blocks": tables.BLOCKS,
        "manoeuvres": tables.MANOEUVRES,
        "performed": tables.PERFORMED,
        "noise": tables.NOISE,
        "known": tables.KNOWN,
        "clocks": tables.CLOCKS,
        "accelerometer_parameters": tables.PARAMETERS,
        "accelerometer_positions": tables.POSITIONS,
        "gyroscope_parameters": tables.PARAMETERS,
        "gyroscope_positions": tables.POSITIONS,
        "accelerometer_fit": tables.FIT,
        "gyroscope_fit": tables.FIT,
    },
    streams=("simulated",),
    writes={
        "parameters": tables.PARAMETERS,
        "covariance": tables.COVARIANCE,
        "gain": tables.GAIN,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
