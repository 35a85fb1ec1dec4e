"""A bias that jumps within one rest, and is what it was after it, is one cause by that name."""

import chain
import numpy as np
import pytest
from hidden import hidden_plans

SENSORS = {"accel": "size_m_s2", "gyro": "size_rad_s"}
SLOW = pytest.mark.slow


@pytest.mark.parametrize(
    ("plan", "rest", "log", "channel", "lines", "size"),
    [
        # Too small beside the noise of a reading to be seen in it: a law with two levels.
        pytest.param(
            *("positions", "x-down", "x-down", "gyro_z", (14_000, 30_000), 1.9e-5),
            marks=SLOW,
        ),
        # It was beside a law of no effect, whose cause was to be looked for.
        pytest.param(
            *("positions", "x-down", "x-down", "accel_y", (9_000, 20_000), 2e-3),
            marks=SLOW,
        ),
        # It was a jump that stays, which a power of the force along z makes up for.
        ("stops", "y-down-after", "y-down", "gyro_x", (23_218, 26_800), -1.4e-4),
        # It was a creep of the fixture, and no sensor was usable.
        pytest.param(
            *("stops", "x-down-after", "x-down", "accel_z", (18_074, 23_914), 2e-3),
            marks=SLOW,
        ),
        # The unknown heading takes up its mean: it was a structure without a name.
        pytest.param(
            *("positions", "z-up", "z-up", "gyro_y", (12_000, 30_000), 2e-4),
            marks=SLOW,
        ),
    ],
)
def test_it_is_named_once_and_moves_no_parameter(plan, rest, log, channel, lines, size):
    sensor, axis = channel.split("_")
    place = {"log": f"{log}.asc", "channel": channel, "line": lines[0] + 1}
    step = place | {"samples": lines[1] - lines[0], SENSORS[sensor]: size}
    document = hidden_plans.PLANS[plan](effects={}, faults=[{"step": step}], seed=20_261_130)
    results = chain.in_memory_of(document, "diagnosis", chain.BESIDE)
    (cause,) = results["diagnosis/causes"].to_dict("records")
    found = [cause[key] for key in ("cause", "verdict", "sensor", "axis", "manoeuvre")]
    assert found == ["bias_jump", "found", sensor, axis, rest]
    assert cause["cure"] in ("modelled", "left_out")
    assert cause["size"] == pytest.approx(size, rel=0.15)
    assert rest in cause["action"] and "no effect of the catalogue" not in cause["sentence"]
    verdicts = results["diagnosis/verdict"].set_index("sensor")["verdict"]
    assert verdicts.pop(sensor) == "usable_within_limits"
    assert verdicts.tolist() == ["usable"]
    own = results["diagnosis/result"].query(f"sensor == '{sensor}' and effect.isna()")
    truth = document["truth"]["gyro" if sensor == "gyro" else "accelerometer"]
    bias = own.set_index("parameter").loc[[f"bias_{axis}" for axis in "xyz"]]
    off = bias["value"] - truth["bias_rad_s" if sensor == "gyro" else "bias_m_s2"]
    assert np.all(np.abs(off) < 3.5 * bias["sigma"])
