"""Turns that the plan counts the other way, in a log that shows gravity turn between positions."""

import chain
import numpy as np
import pytest
from diagnosis.test_real_recordings import campaign, columns
from moved_by_hand import FACES, attitudes, by_hand

GRAVITY, RATE = 9.80943, 100  # m/s² at 50°; Hz
BIAS = np.array([0.003, -0.002, 0.001])  # rad/s


def session(seed):
    """Six faces up in one log, each with a rest and a turn there and back about the upward axis.

    Forces, m/s², and rates, rad/s, (n, 3), as an ideal IMU reads them but for bias and noise.
    """
    rng = np.random.default_rng(seed)
    stands = attitudes(rng, FACES, 0.0)
    ramp = np.radians(20) * np.linspace(0.005, 0.995, RATE)  # a second of 20 °/s²
    turn = np.concatenate([ramp, np.full(17 * RATE, np.radians(20)), ramp[::-1]])
    still = np.zeros(15 * RATE)
    course = np.concatenate([still, turn, still[: 3 * RATE], -turn, still])
    ups, rates = [], []
    for up, here, there in zip(FACES, stands, [*stands[1:], None], strict=True):
        ups.append(np.tile(up, (len(course), 1)))
        rates.append(np.outer(course, up))
        if there is not None:
            way = by_hand(rng, here, there)[::10]
            rates.append((way[:-1].inv() * way[1:]).as_rotvec() * RATE)
            ups.append(way[:-1].inv().apply([0, 0, 1]))
    noise = rng.standard_normal((2, sum(map(len, rates)), 3))
    return (
        GRAVITY * np.concatenate(ups) + 0.01 * noise[0],
        np.concatenate(rates) + BIAS + 0.0005 * noise[1],
    )


def plan(other_way):
    """The plan of this session, of some upward axes with the turns the other way."""
    rows = []
    for up in FACES:
        axis = "xyz"[np.argmax(np.abs(up))]
        name = f"{'+' if up.sum() > 0 else '-'}{axis}"
        label = f"{'up' if up.sum() > 0 else 'down'}-{axis}"
        sign = -1 if name in other_way else 1
        turning = {"do": "turn", "up": name, "position": name, "rate_deg_s": 20}
        rows.append({"id": f"{label}-rest", "do": "rest", "up": name, "position": name})
        rows[-1]["seconds"] = 14
        rows += [
            {"id": f"{label}-{way}", "degrees": sign * degrees, "accel_deg_s2": 20} | turning
            for way, degrees in (("there", 360), ("back", -360))
        ]
    return rows


@pytest.mark.slow
@pytest.mark.parametrize(
    ("other_way", "about", "count"),
    [
        ({"+y", "-y"}, "y", 4),
        ({"-x", "-y", "-z"}, "negative", 6),
        ({"+x", "-x", "+y", "-y", "+z", "-z"}, "", 12),
    ],
)
def test_turns_of_one_kind_that_are_planned_the_other_way_are_named_and_taken_so(
    tmp_path, other_way, about, count
):
    """And not a gyro with another sign: it would turn gravity the other way too."""
    raw = tmp_path / "raw"
    raw.mkdir()
    np.savetxt(raw / "log.csv", np.hstack(session(5)), fmt="%.6f", delimiter=",")
    form = columns(
        delimiter=",",
        accelerometer={"columns": [1, 2, 3], "unit": "m/s2"},
        gyro={"columns": [4, 5, 6], "unit": "rad/s"},
    )
    table = {"name": "by numbers", "position_sigma_arcsec": 60, "angle_sigma_arcsec": 60}
    instrument = {"name": "own", "rate_hz": 100, "format": form}
    campaign(raw, instrument, plan(other_way), log="log.csv", table=table)
    results = chain.run(raw, tmp_path / "derived", "gyroscope")
    (repair,) = results["segment/repairs"].itertuples()
    assert repair.id == "/".join(["sense_of_table", *([about] if about else [])])
    assert (repair.repair, repair.state) == ("sense_of_table", "applied")
    (told,) = results["segment/findings"].query("cause == 'wrong_direction'").itertuples()
    assert told.count == count and "turn gravity as the accelerometers" in told.sentence
    assert results["segment/performed"]["complete"].all()
    solved = results.parameters("gyroscope")
    scales = solved.loc[["scale_x", "scale_y", "scale_z"]]
    assert (np.abs(scales["value"]) < 5 * scales["sigma"]).all()
    assert (scales["sigma"] < 1e-3).all()
