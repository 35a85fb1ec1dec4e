"""Which physical effects the simulation lacks, by name."""

from collections.abc import Iterator, Mapping
from math import degrees, pi
from typing import Any

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.findings import Finding, table_of
from stages.contracts.parquet import Stream
from stages.contracts.records import (
    clocks_of,
    known_of,
    manoeuvres_of,
    performed_of,
    rows_of,
    share_a_clock,
)
from stages.contracts.stage import Stage, Tables
from stages.effects import CATALOGUE
from stages.estimation.estimates import by_mount
from stages.estimation.evidence import campaign_of, evidence
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.ringing import (
    Oscillating,
    Ringing,
    ringing,
    steady_residuals,
    together,
)
from stages.estimation.solution import Solution, solution_of
from stages.inference.least_squares import INCONSISTENT
from stages.inference.naming import Evidence, Score, name
from stages.model.effect import Effect

SENSOR = {"gyro": "gyros", "accel": "accelerometers"}
SUFFICES = 5.0  # sigmas: what a campaign can see
EXCESS = 1.2  # chi-squared per degree that the uncertainty of the noise level does not explain
Row = dict[str, Any]


def criticism(
    simulated: Stream,
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
    *,
    level: float,
    lowest_hz: float,
) -> Tables:
    """Scores of every effect of the catalogue, its estimates, the lines, and the findings.

    `level` is the accepted chance of naming anything where nothing is missing; every effect
    of the catalogue has the same share of it.
    """
    given, done, clock = known_of(known), performed_of(performed), clocks_of(clocks)
    averaged = {row["log"] for row in rows_of(clocks) if row["clock"] == "GPS"}
    levels = NoiseLevels(noise)
    logs = {m.name: m.log for m in manoeuvres_of(manoeuvres)}
    in_blocks = [effect for effect in CATALOGUE.values() if not effect.rings]
    in_spectrum = [effect for effect in CATALOGUE.values() if effect.rings]
    share = level / len(CATALOGUE)
    scores: list[Row] = []
    estimates: list[Row] = []
    findings: list[Finding] = []
    lines: list[Ringing] = []
    for suffix, plan in by_mount(manoeuvres_of(manoeuvres)):
        solution = solution_of(
            (accelerometer_parameters, gyroscope_parameters),
            (accelerometer_positions, gyroscope_positions),
            given,
            suffix,
            (accelerometer_fit, gyroscope_fit),
        )
        campaign = campaign_of(blocks, plan, done, levels, given, solution, share_a_clock(clocks))
        said = evidence(campaign, in_blocks)
        columns = {
            e.name: [i for i, n in enumerate(said.names) if n.startswith(f"{e.name}.")]
            for e in in_blocks
        }
        found = name(said, columns, share * len(in_blocks))
        rows = _estimates(in_blocks, said, columns, found, suffix)
        findings += _unexplained(said, columns, found, suffix)
        estimates += rows
        for score in found:
            effect = CATALOGUE[score.effect]
            told = _told(effect, score, [r for r in rows if r["effect"] == effect.name])
            scores.append(_score(effect, score, "blocks", told))
            if score.named:
                findings.append(_finding(effect, score.p_value, told, suffix))
        own = {m.name for m in plan}
        rings = [
            ring
            for turn, residuals in steady_residuals(simulated)
            if turn in own and solution.gyro is not None
            for ring in ringing(
                turn,
                residuals,
                solution.gyro,
                clock[logs[turn]].step,
                logs[turn] in averaged,
                lowest_hz,
            )
        ]
        lines += rings
        for effect in in_spectrum:
            heard = together(rings, share)
            score = _heard(effect, heard, rings)
            told = _oscillation(heard, rings, solution)
            scores.append(_score(effect, score, "spectrum", told))
            estimates += _of_oscillation(effect, heard, rings, suffix)
            if heard:
                findings.append(_finding(effect, heard[0].p_value, told, suffix))
    return {
        "scores": pd.DataFrame(scores) if scores else tables.SCORES.empty(),
        "effects": pd.DataFrame(estimates) if estimates else tables.EFFECTS.empty(),
        "lines": _lines(lines),
        "findings": table_of(findings),
    }


def _score(effect: Effect, score: Score, where: str, told: str) -> Row:
    return {
        "effect": effect.name,
        "cause": effect.cause,
        "sought_in": where,
        "statistic": score.statistic,
        "degrees": score.degrees,
        "p_value": score.p_value,
        "named": score.named,
        "sentence": told,
    }


def _estimates(
    effects: list[Effect],
    said: Evidence,
    columns: Mapping[str, list[int]],
    found: list[Score],
    suffix: str,
) -> list[Row]:
    """Each effect's parameters beside all that are named, and what the campaign could see."""
    named = [i for score in found if score.named for i in columns[score.effect]]
    rows = []
    for effect in effects if said.sensors else []:
        chosen = list(dict.fromkeys([*named, *columns[effect.name]]))
        values, covariance = said.total.estimate(chosen)
        for i, parameter in zip(columns[effect.name], effect.parameters, strict=True):
            place = chosen.index(i)
            sigma = float(np.sqrt(covariance[place, place]))
            seen = np.isfinite(sigma)
            rows.append(
                {
                    "id": f"criticism/{effect.name}{suffix}/{parameter.name}",
                    "effect": effect.name,
                    "parameter": parameter.name,
                    "value": float(values[place]) if seen else None,
                    "sigma": sigma if seen else None,
                    "visible": SUFFICES * sigma if seen else None,
                    "unit": parameter.unit,
                    "meaning": parameter.meaning,
                }
            )
    return rows


def _told(effect: Effect, score: Score, rows: list[Row]) -> str:
    """What is said of an effect that is sought in blocks."""
    title = effect.name.replace("_", " ")
    if score.degrees == 0:
        return (
            f"This plan cannot show {title}: no manoeuvre excites it, or its direction is unknown."
        )
    if not score.named:
        return f"No {title} is needed (p = {score.p_value:.2g})."
    clear = [row for row in rows if row["sigma"] and abs(row["value"]) > SUFFICES * row["sigma"]]
    numbers = ", ".join(
        f"{row['parameter']} = ({row['value']:.3g} ± {row['sigma']:.1g}) {row['unit']}"
        for row in clear or rows
        if row["sigma"]
    )
    return f"The data ask for {title}: {effect.cause}. {numbers}."


def _finding(effect: Effect, p_value: float, told: str, suffix: str) -> Finding:
    return Finding(
        id=f"criticism/{effect.name}{suffix}",
        cause=effect.name,
        sensor="gyro" if "gyro" in effect.name or effect.rings else "accel",
        sentence=told,
        consequence="The model without it is not the whole truth; see what the extension gains.",
        action="It is added to the model by the extension.",
        severity=2,
        p_value=p_value,
    )


def _unexplained(
    said: Evidence, columns: Mapping[str, list[int]], found: list[Score], suffix: str
) -> Iterator[Finding]:
    """What is left when everything that was named is taken out."""
    named = [i for score in found if score.named for i in columns[score.effect]]
    for sensor, reduced in zip(said.labels, said.sensors, strict=True):
        rest, degrees, p_value = said.left_over(reduced, named)
        if p_value < INCONSISTENT and rest > EXCESS * degrees:
            yield Finding(
                id=f"criticism/unexplained/{sensor}{suffix}",
                cause="unexplained",
                sensor=sensor,
                size=float(np.sqrt(rest / degrees)),
                unit="sigma",
                p_value=p_value,
                sentence=f"The residuals of the {SENSOR[sensor]} are"
                f" {np.sqrt(rest / degrees):.1f} times what noise would leave, and no effect of the"
                " catalogue explains it.",
                consequence="The joint estimate holds it as a scatter between manoeuvres.",
                action="Look at the residuals of each manoeuvre, and how the positions were set.",
                severity=2,
            )


# ---- the spectrum


def _heard(effect: Effect, heard: list[Oscillating], rings: list[Ringing]) -> Score:
    trials = max(len(rings), 1)
    best = min((ring.line.p_value * trials for ring in rings), default=1.0)
    ratio = max((r.line.amplitude / r.line.sigma_amplitude for r in rings), default=0.0)
    return Score(effect.name, float(ratio**2), 3 if rings else 0, min(best, 1.0), bool(heard))


def _oscillation(heard: list[Oscillating], rings: list[Ringing], solution: Solution) -> str:
    if not rings:
        return (
            "This campaign cannot show an oscillation: no whole turn at a steady rate was recorded."
        )
    if not heard:
        return "No oscillation stands out of the noise of the turns."
    one = heard[0]
    arc = degrees(one.amplitude / (2 * pi * one.frequency)) * 3600
    return (
        f"The case oscillates about {one.axis} while the table turns: {one.frequency:.3f} ±"
        f" {one.frequency_sigma:.1g} Hz, {one.amplitude:.5f} ± {one.amplitude_sigma:.1g} rad/s"
        f" ({arc:.1f}″), in {', '.join(one.manoeuvres)}. The other axes see it through their"
        " cross terms. Over a whole turn it adds no angle."
    )


def _of_oscillation(
    effect: Effect, heard: list[Oscillating], rings: list[Ringing], suffix: str
) -> list[Row]:
    sigmas = [ring.line.sigma_amplitude for ring in rings]
    visible = {"amplitude": SUFFICES * float(np.median(sigmas))} if rings else {}
    values: dict[str, tuple[float, float]] = {}
    if heard:
        one = heard[0]
        values["frequency"] = (one.frequency, one.frequency_sigma)
        values["amplitude"] = (one.amplitude, one.amplitude_sigma)
    rows = []
    for parameter in effect.parameters:
        value, sigma = values.get(parameter.name, (None, None))
        rows.append(
            {
                "id": f"criticism/{effect.name}{suffix}/{parameter.name}",
                "effect": effect.name,
                "parameter": parameter.name,
                "value": value,
                "sigma": sigma,
                "visible": visible.get(parameter.name),
                "unit": parameter.unit,
                "meaning": parameter.meaning,
            }
        )
    return rows


def _lines(rings: list[Ringing]) -> pd.DataFrame:
    rows = [
        {
            "manoeuvre": ring.manoeuvre,
            "axis": ring.axis,
            "frequency": ring.line.frequency,
            "frequency_sigma": ring.line.sigma_frequency,
            "amplitude": ring.line.amplitude,
            "amplitude_sigma": ring.line.sigma_amplitude,
            "p_value": ring.line.p_value,
        }
        for ring in rings
    ]
    return pd.DataFrame(rows) if rows else tables.LINES.empty()


STAGE = Stage(
    criticism,
    reads={
        "simulated": tables.SIMULATED,
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
        "scores": tables.SCORES,
        "effects": tables.EFFECTS,
        "lines": tables.LINES,
        "findings": tables.FINDINGS,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
