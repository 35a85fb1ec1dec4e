"""What should agree: rests and turns, both ways of turning, methods, rates, published and ours."""

from collections.abc import Iterator

import pandas as pd

from inertial.campaign.estimates import by_mount
from inertial.campaign.noise_levels import NoiseLevels
from inertial.campaign.rate_segments import gyro_inputs
from inertial.campaign.records import known_of, manoeuvres_of, performed_of, rows_of
from inertial.tables.stage import Stage, Tables
from stages.comparison.declared import DECLARED
from stages.comparison.difference import Difference, Results, table_of
from stages.comparison.fencepost_error import off_by_a_sample
from stages.comparison.methods_compared import against_published, method_against_method
from stages.comparison.rate_segments_compared import forward_against_backward, static_against_turns
from stages.comparison.straight_line import straight_line


def comparison(
    blocks: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    performed: pd.DataFrame,
    noise: pd.DataFrame,
    known: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    growing: pd.DataFrame,
    motions: pd.DataFrame,
    published: pd.DataFrame,
    *,
    level: float,
) -> Tables:
    """Every difference in units of its sigma, with the verdict in a sentence."""
    given, done, levels = known_of(known), performed_of(performed), NoiseLevels(noise)
    scatter = {row["method"]: row["scatter"] for row in rows_of(gyroscope_fit)}

    plans = dict(by_mount(manoeuvres_of(manoeuvres)))
    inputs_of = {
        suffix: gyro_inputs(blocks, plan, done, levels, given) for suffix, plan in plans.items()
    }

    def of_mount(suffix: str, gyro: Results, accelerometer: Results) -> Iterator[Difference]:
        inputs = inputs_of[suffix]
        yield from static_against_turns(inputs, levels, gyro)
        between = scatter.get(f"joint{suffix}", 0.0)
        yield from forward_against_backward(inputs, levels, gyro, between)
        for method in ("six_position", "pooled_positions"):
            yield from method_against_method(accelerometer, method)
        for method in ("turns", "turn_and_stop", "stops", "rate_table"):
            yield from method_against_method(gyro, method)
        yield from against_published(published, {r.stage: r for r in (accelerometer, gyro)})
        yield from off_by_a_sample(published, gyro, growing, motions, level)

    found = [
        difference
        for suffix in plans
        for difference in of_mount(
            suffix,
            Results("gyroscope", gyroscope_parameters, suffix),
            Results("accelerometer", accelerometer_parameters, suffix),
        )
    ]
    found += straight_line(
        [run for inputs in inputs_of.values() for run in inputs.steadies],
        next(iter(inputs_of.values())).earth,
        [scatter.get(f"joint{suffix}") or 0.0 for suffix in plans],
    )
    return {"differences": table_of(found, level)}


STAGE = Stage(comparison, DECLARED)
