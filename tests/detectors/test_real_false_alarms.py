"""What the detectors once said of real recordings that is not so, and what they did not see."""

import chain
import h5py
import numpy as np
import pytest
from diagnosis.test_real_recordings import BY_HAND, GYRO, campaign, columns
from scipy.io import loadmat

from inertial.tables.campaign_files import logs_of

ACCELEROMETER = {"columns": [1, 2, 3], "unit": "m/s2"}


@pytest.fixture
def raw(tmp_path):
    folder = tmp_path / "raw"
    folder.mkdir()
    return folder


def found(raw, until="segment"):
    return chain.run(raw, raw.parent / "derived", until)


def causes(results, stage="quality"):
    return set(results[f"{stage}/findings"]["cause"])


def test_whu_reads_015_per_cent_more_once_a_second_on_every_gyro_that_turns(recordings, raw):
    """SOURCE.md: stamped xxx.010, 22 to 28 counts more of 16,085, in all six turns."""
    text = (chain.ROOT / "tests/campaigns/whu.yaml").read_bytes()
    (raw / "campaign.yaml").write_bytes(text)
    for log in logs_of(raw / "campaign.yaml"):
        (raw / log).write_bytes((recordings / "whu_xwgi7681_excerpt" / log).read_bytes())
    results = found(raw, "quality")
    (glitch,) = results["quality/findings"].query("cause == 'periodic_glitch'").itertuples()
    assert "At 0.010 s of every 1 s (of 0.5 s as well" in glitch.sentence
    assert "6 samples" in glitch.sentence and glitch.sensor == "gyro"
    # 22 to 28 counts of 1.085e-7 rad in 0.01 s
    assert 22 < glitch.size / 1.0850694444e-5 < 28
    assert glitch.p_value < 1e-4
    masks = results["quality/masks"]
    assert len(set(masks["log"])) == 6 and set(masks["finding"]) == {glitch.id}
    assert "spike" not in causes(results)


def test_mikoff_4_is_struck_and_loses_four_records(recordings, raw):
    """It was called a sign flip, which masked 12,312 of 15,968 records."""
    (raw / "log.txt").write_bytes((recordings / "mikoff_mpu9150/imu4.log").read_bytes())
    form = columns(accelerometer=ACCELEROMETER, gyro=GYRO) | {"delimiter": " "}
    campaign(raw, {"name": "mpu9150", "rate_hz": 100, "format": form}, BY_HAND, log="log.txt")
    results = found(raw)
    assert "impact" in causes(results)
    assert not causes(results) & {"sign_flip", "axis_swap"}
    masks = results["quality/masks"]
    assert (masks["to_record"] - masks["from_record"]).sum() < 20
    assert results["segment/repairs"].empty


def test_gesture_has_large_biases_and_no_other_count_size(recordings, raw):
    """0.4 and 0.5 g, SOURCE.md."""
    log = loadmat(recordings / "gesture_multipos/caldata.mat")["cal_data"]
    np.savetxt(raw / "log.csv", log[:, 1:7], fmt="%d", delimiter=",")
    counts = ACCELEROMETER | {"counts_per_unit": 209}
    rates = {"counts_per_unit": 16.4, "unit": "deg/s", "columns": [4, 5, 6]}
    form = columns(delimiter=",", accelerometer=counts, gyro=rates)
    campaign(raw, {"name": "gesture", "rate_hz": 100, "format": form}, BY_HAND, log="log.csv")
    results = found(raw)
    assert "wrong_scale_factor" not in causes(results)
    assert results["segment/repairs"].empty


@pytest.mark.parametrize("number", [1, 2, 3])
def test_snu_is_put_down_hard_and_has_no_spikes(recordings, raw, number):
    """30 to 45 m/s² where it is put down, SOURCE.md."""
    log = np.loadtxt(recordings / f"snu_multipos/imu_good{number}.txt")[:, :7]
    assert np.linalg.norm(log[:, 1:4], axis=1).max() > 30
    np.savetxt(raw / "log.csv", log, fmt="%.9f", delimiter=",")
    time = {"column": 1, "unit": "s"}
    force, rate = (
        {"columns": c, "unit": u} for c, u in (([2, 3, 4], "m/s2"), ([5, 6, 7], "rad/s"))
    )
    form = columns(delimiter=",", accelerometer=force, gyro=rate) | {"time": time}
    campaign(raw, {"name": "snu", "rate_hz": 100, "format": form}, BY_HAND, log="log.csv")
    assert "spike" not in causes(found(raw, "quality"))


def sunsided(recordings, raw, plan, sign):
    """Its accelerometers and gyros side by side, in order; `sign`: of the accelerometers."""
    place = recordings / "sunsided_mpu6050"
    for one in plan:
        force, rate = (
            h5py.File(place / f"{one['id']}-{name}.mat")[f"{short}Buffer"][()].T[:, 1:]
            for name, short in (("accelerometer", "accel"), ("gyroscope", "gyro"))
        )
        table = np.hstack([sign * force, rate])
        np.savetxt(raw / f"{one['id']}.csv", table, fmt="%.7f", delimiter=",")
    form = columns(
        delimiter=",",
        accelerometer={"columns": [1, 2, 3], "unit": "g"},
        gyro={"columns": [4, 5, 6], "unit": "deg/s"},
    )
    placed = [one | {"log": f"{one['id']}.csv"} for one in plan]
    campaign(raw, {"name": "mpu6050", "rate_hz": 100, "format": form}, placed)


TURNS = {
    "rotate-ccw-around-x-pointing-forward": {"up": "+z", "about": "+x"},
    "rotate-ccw-around-x-pointing-up": {"up": "+x"},
    "rotate-ccw-around-y-pointing-left": {"up": "+z", "about": "+y"},
    "rotate-ccw-around-z-pointing-up": {"up": "+z"},
}


def test_sunsided_turns_gravity_otherwise_than_its_gyros_tell(recordings, raw):
    """Two gyros are reversed beside the accelerometers, x among them; or one accelerometer is."""
    plan = [{"id": name, "do": "positions", "seconds": 1} for name in TURNS]
    sunsided(recordings, raw, plan, 1)
    repairs = found(raw)["segment/repairs"].set_index("id")
    assert set(repairs["state"]) == {"rival"}
    words = repairs["condition"]
    assert words["signs/gyro/by-gravity"].endswith("x reads −x and y reads −y")
    assert words["signs/accel/by-gravity"].endswith("z reads −z")


def test_sunsided_has_its_x_gyro_reversed_by_turns_of_a_stated_angle(recordings, raw):
    """Its log tells gravity, so its accelerometers are taken with the other sign."""
    turn = {"do": "turn", "degrees": 720, "degrees_sigma": 10}
    plan = [{"id": name, **turn, **own} for name, own in TURNS.items()]
    for name, up in (("x-pointing-forward", "+z"), ("z-pointing-front-and-x-up", "+x")):
        plan.append({"id": f"unmoved-with-{name}", "do": "rest", "up": up, "seconds": 60})
    sunsided(recordings, raw, plan, -1)
    results = found(raw)
    repairs = results["segment/repairs"].set_index("id")
    assert repairs.loc["signs/gyro", "state"] == "applied"
    assert repairs.loc["signs/gyro", "condition"].endswith("x reads −x")


def test_sunsided_has_stamps_in_bursts_and_no_gaps(recordings, raw):
    """There were 4,112 times "120 samples are missing"; its mean rate is right, SOURCE.md."""
    place = recordings / "sunsided_mpu6050"
    name = "unmoved-with-x-pointing-forward"
    force = h5py.File(place / f"{name}-accelerometer.mat")["accelBuffer"][()].T
    rate = h5py.File(place / f"{name}-gyroscope.mat")["gyroBuffer"][()].T[:, 1:]
    np.savetxt(raw / "log.csv", np.hstack([force, rate]), fmt="%.7f", delimiter=",")
    form = columns(
        delimiter=",",
        accelerometer={"columns": [2, 3, 4], "unit": "g"},
        gyro={"columns": [5, 6, 7], "unit": "deg/s"},
    ) | {"time": {"column": 1, "unit": "s"}}
    campaign(raw, {"name": "mpu6050", "rate_hz": 100, "format": form}, BY_HAND, log="log.csv")
    results = found(raw, "quality")
    assert results["quality/gaps"].empty and "gap" not in causes(results)
