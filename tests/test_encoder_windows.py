"""Turns that are recorded in part: the encoder's angle makes any window of them a rate segment.

One IMU at rest six times and turned by parts of a turn: logs that end in the steady part or in a
ramp, one with a gap in its ramp, steady windows of 150°. Drawn anew each time: M, biases, the
eccentricity of the encoder, its latency, the azimuth.
"""

from copy import deepcopy

import chain
import numpy as np
import pytest

import laboratory

ARC_SECOND = np.pi / 648_000
RATE_HZ = 200
ECCENTRICITY = 20.0  # arcsec, one sigma of sine and cosine
AXES = "xyz"


def drawn(seed, *, encoder=True):
    """A description of such a campaign, and its gyros: M, bias, scale of the encoder."""
    rng = np.random.default_rng([20231118, seed])
    document = deepcopy(laboratory.read(chain.ROOT / "data/simulated/encoder.yaml").document)
    matrix = np.eye(3) + np.diag(3e-4 * rng.normal(size=3)) + 2e-3 * rng.normal(size=(3, 3))
    bias = 2e-6 * rng.normal(size=3)
    document["truth"]["gyro"] = {"bias_rad_s": bias.tolist(), "matrix": matrix.tolist()}
    sine, cosine = ECCENTRICITY * rng.normal(size=2)
    document["effects"] = {
        "table_eccentricity": {"sin_arcsec": float(sine), "cos_arcsec": float(cosine)},
        "gyro_latency": {"lag_ms": float(rng.uniform(1, 8))},
        "table_ripple": {"order": 12, "amplitude_arcsec": 3},
    }
    document["encoder"] = {"count_arcsec": 1.0, "latency_ms": float(rng.uniform(0, 4))}
    plan = document["campaign"]["plan"][:6]
    faults = []

    def turn(name, up, degrees, **more):
        rates = {"rate_deg_s": 20, "accel_deg_s2": 10}
        log = f"{name}.csv"
        item = {"id": name, "do": "turn", "up": up, "degrees": degrees, **rates, "log": log}
        plan.append(item | more)

    def lost(name, start, end):
        first, samples = int(start * RATE_HZ), int((end - start) * RATE_HZ)
        faults.append({"lose": {"log": f"{name}.csv", "line": first + 1, "samples": samples}})

    for axis in AXES:
        for sense, up in ((1, f"+{axis}"), (-1, f"+{axis}")):
            name = f"{axis}-{'forward' if sense > 0 else 'backward'}"
            turn(name, up, 360 * sense)
            # 5 s at rest, a ramp of 2 s, 16 s steady, a ramp, 5 s at rest: 30 s.
            if axis == "x":
                lost(name, 14.3 if sense > 0 else 11.1, 30)  # it ends in the steady part
            if axis == "y":
                lost(name, *((6.1, 9.3) if sense > 0 else (24.1, 30)))  # from ramp to steady
    for turned in plan[-2:]:  # z: the steady part alone, of 150°
        del turned["accel_deg_s2"], turned["rate_deg_s"]
        turned |= {
            "seconds": 7.5,
            "recorded": "steady",
            "degrees": 150 if turned["degrees"] > 0 else -150,
        }
    document["campaign"]["plan"] = plan
    document["faults"] = faults
    document["seed"] = int(rng.integers(1 << 30))
    if not encoder:
        del document["encoder"]
    return document, matrix, bias


def closure(seed):
    """By how many sigmas the twelve parameters of a draw are off, and these sigmas."""
    document, matrix, bias = drawn(seed)
    tables = chain.in_memory_of(document)
    off = matrix - np.eye(3)
    truth = {
        f"scale_{row}" if row == column else f"cross_{row}{column}": off[i, j]
        for i, row in enumerate(AXES)
        for j, column in enumerate(AXES)
    }
    truth |= {f"bias_{axis}": bias[i] for i, axis in enumerate(AXES)}
    found = tables.parameters("gyroscope").loc[list(truth)]
    return (
        (found["value"] - np.array(list(truth.values()))) / found["sigma"],
        found["sigma"],
        tables,
    )


def test_parts_of_turns_close_with_the_laboratory():
    """Of 50 draws the pulls have an rms of 1.02, of scale factors 0.98, of cross terms 1.05."""
    off, sigma, tables = closure(1)
    assert np.abs(off).max() < 4
    assert 0.5 < np.sqrt(np.mean(off**2)) < 1.6
    scales = sigma[["scale_x", "scale_y", "scale_z"]]
    assert (scales < 8e-6).all() and (sigma[sigma.index.str.startswith("cross")] < 2e-5).all()
    used = tables["gyroscope/fit_manoeuvres"]
    used = set(used[used["used"] & (used["method"] == "joint")]["manoeuvre"])
    assert {f"{axis}-{way}" for axis in AXES for way in ("forward", "backward")} <= used
    # Refused as turns, for they are not recorded from rest to rest.
    done = tables["segment/performed"].set_index("manoeuvre")
    assert not (done.loc["x-forward":"y-backward", ["complete", "bridged"]]).any(axis=None)


def test_without_the_encoder_they_say_nothing_of_the_scale_factors():
    found = chain.in_memory_of(drawn(1, encoder=False)[0]).parameters("gyroscope")
    sigma = found["sigma"].reindex(["scale_x", "scale_y"])
    assert (sigma.isna() | (sigma > 5e-3)).all()  # by the earth's rate alone
    assert found.loc["scale_z", "sigma"] > 1e-3  # by the rate that was set, to 3000 ppm


@pytest.mark.parametrize(("encoder", "low", "high"), [(True, 1.9, 2.3), (False, 2.8, 3.5)])
def test_the_encoder_gives_the_angle_over_a_gap(encoder, low, high):
    """4 s of a steady part are lost: by the set rate, known to 100 ppm, they are 80° to 29 arcsec.

    Two turns give the scale factor to √(N² T/2 + 2″²/2)/2π, 2.03 ppm: N = 0.012 °/√h, T = 19 s.
    One alone, to which the bias is known by 30 s at rest up and down, to
    √(N² T + N² T²/60 + 2″²)/2π, 3.3 ppm, and somewhat less with what the other says of the bias.
    """
    document = deepcopy(laboratory.read(chain.ROOT / "data/simulated/encoder.yaml").document)
    plan = document["campaign"]["plan"]
    document["campaign"]["plan"] = [plan[4], plan[5], plan[10], plan[11]]
    document["campaign"]["table"]["rate_sigma_ppm"] = 100
    document["effects"] = {"table_ripple": document["effects"]["table_ripple"]}
    document["faults"] = [{"lose": {"log": "z-backward.csv", "line": 1600, "samples": 800}}]
    if not encoder:
        del document["encoder"]
    scale = chain.in_memory_of(document).parameters("gyroscope").loc["scale_z"]
    true = 6e-4 - (40e-6 if encoder else 0)
    assert scale["value"] == pytest.approx(true, abs=3.5 * scale["sigma"])
    assert low * 1e-6 < scale["sigma"] < high * 1e-6
