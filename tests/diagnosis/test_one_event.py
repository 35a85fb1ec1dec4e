"""What is said of one event once, and to which of two mountings the parameters belong."""

from types import SimpleNamespace

import numpy as np
import pandas as pd
import pytest
from test_explanations import at, effect, finding, of

from inertial.campaign.competition import ExplainedFindings, compete
from stages.diagnosis.one_event import mountings_of, rotations, with_consequences

ATTITUDES = {"z-up": (0, 0, 1), "z-down": (0, 0, -1), "x-up": (1, 0, 0), "x-down": (-1, 0, 0)}
ATTITUDES |= {"y-up": (0, 1, 0), "y-down": (0, -1, 0)}
LASTS = 40.0  # s, a rest, or the turn after it
ABOUT_Z, ABOUT_X = np.array([0, 0, 1.6e-3]), np.array([1.6e-3, 0, 0])


def six_positions() -> SimpleNamespace:
    """The tables of six rests, one after another, with a turn about the axis that is up."""
    plan, segments = [], []
    for i, (name, up) in enumerate(ATTITUDES.items()):
        for k, do in enumerate(("rest", "turn")):
            own = {"manoeuvre": f"{name}-{do}", "do": do, "log": "session.csv", "phase": do}
            start = (2 * i + k) * LASTS
            segments.append(own | {"from_s": start, "to_s": start + LASTS - 0.01})
            vectors = {"up": up, "about": up if do == "turn" else (np.nan,) * 3}
            for what, vector in vectors.items():
                own |= {f"{what}_{axis}": part for axis, part in zip("xyz", vector, strict=True)}
            plan.append(own)
    clock = {"log": "session.csv", "clock": "log", "interval": 0.01}
    clock |= {"began": 0.0, "from_s": 0.0, "to_s": 480.0, "epoch_gps": None}
    return SimpleNamespace(
        manoeuvres=pd.DataFrame(plan),
        segments=pd.DataFrame(segments),
        clocks=pd.DataFrame([clock]),
    )


def result(sensor: str, *, modelled: bool = False, method: str = "joint") -> SimpleNamespace:
    chosen = SimpleNamespace(method=method)
    return SimpleNamespace(sensor=sensor, mount="", chosen=chosen, models=lambda effects: modelled)


def said(seconds: float, rotation: np.ndarray, *results: SimpleNamespace) -> str:
    tables = six_positions()
    mountings = mountings_of(results, tables.manoeuvres, tables.segments, tables.clocks)
    shift = at(effect("mounting_shift", "accel"), seconds, 1.0, 338)
    cause = SimpleNamespace(main=shift, members=[ExplainedFindings(shift, (shift,))])
    return mountings.described({"consequence": "It is off."}, cause, rotation)["consequence"]


@pytest.mark.parametrize(
    ("seconds", "rotation", "sensor", "expected"),
    [
        # In the rest x-up, the third: about z no turn before it is changed, and all after it are.
        (180.0, ABOUT_Z, "gyro", "gyros are those of the mounting after it"),
        (180.0, ABOUT_Z, "accel", "accelerometers are those of the mounting after it"),
        # About x the turns about z, before it, are changed, and those about y, after it.
        (180.0, ABOUT_X, "gyro", "gyros are of neither mounting: 2 of their manoeuvres are before"),
        # In the last turn, about y: about z it is too late for any other manoeuvre.
        (460.0, ABOUT_Z, "gyro", "gyros are those of the mounting before it"),
    ],
)
def test_the_parameters_are_those_of_the_mounting_that_the_manoeuvres_had(
    seconds, rotation, sensor, expected
):
    assert expected in said(seconds, rotation, result(sensor))


def test_a_shift_in_the_model_leaves_those_before_it():
    text = said(180.0, ABOUT_Z, result("gyro", modelled=True), result("accel"))
    assert "gyros are those of the mounting before it" in text
    assert "accelerometers are those of the mounting after it" in text


def test_a_mixture_is_of_no_mounting():
    assert said(180.0, ABOUT_Z, result("gyro", method="mixture")) == "It is off."


def test_what_tilts_tells_the_time_of_a_shift_better():
    """The shift is known to 200 s, by which nothing would be known of the mountings."""
    tables = six_positions()
    mountings = mountings_of([result("gyro")], tables.manoeuvres, tables.segments, tables.clocks)
    shift = at(effect("mounting_shift", "accel"), 180.0, 200.0, 338)
    tilt = at(finding("segment", "table_moving", **of("x-up-rest")), 182.0, 0.04, 379)
    for consequences, known in (((shift,), False), ((shift, tilt), True)):
        cause = SimpleNamespace(main=shift, members=[ExplainedFindings(shift, consequences)])
        text = mountings.described({"consequence": "It is off."}, cause, ABOUT_Z)["consequence"]
        assert ("after it" in text) == known
        assert ("is not known" in text) != known


def test_both_sizes_of_one_knock_are_said():
    gyro = at(effect("gyro_bias_jump", "gyro"), 124.89, 0.16)
    accel = at(effect("accel_bias_jump", "accel"), 125.0, 2.5)
    (each,) = compete([gyro, accel])
    cause = SimpleNamespace(main=each.cause, members=[each])
    row = with_consequences({"sentence": "b_x = 532 °/h."}, cause, {accel.id: "b_y = 5851 µg."})
    assert row["sentence"].startswith("b_x = 532 °/h. ")
    assert row["sentence"].endswith("b_y = 5851 µg.")


@pytest.mark.parametrize(
    ("accel", "number"),
    [((874.3, 34.9), 1), ((905.0, 35.0), 2), ((874.0, 120.0), 2)],
    ids=["the same pause", "another pause", "any of several pauses"],
)
def test_jumps_of_both_sensors_in_one_pause_are_one_event(accel, number):
    """As where the IMU is switched off and on between two logs, and nobody states it."""
    jumps = [at(effect("gyro_bias_jump", "gyro"), 874.0, 35.0)]
    jumps.append(at(effect("accel_bias_jump", "accel"), *accel))
    assert len(list(compete(jumps))) == number


def test_a_rotation_is_about_the_axes_that_show_it():
    rows = [
        {"finding": "f", "effect": "mounting_shift", "unit": "rad", "parameter": f"theta_{axis}"}
        | {"value": value, "sigma": sigma}
        for axis, value, sigma in (("x", -0.094, 0.057), ("y", -3e-6, 4e-5), ("z", -1.6e-3, 7e-5))
    ]
    assert np.array_equal(rotations(rows, 3.0)["f"], [0, 0, -1.6e-3])
