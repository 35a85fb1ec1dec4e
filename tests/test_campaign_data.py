"""A campaign of two mounts: each has its own manoeuvres, parameters and positions."""

import chain
import numpy as np
import pytest

MOUNTING = (8e-3, -6e-3, 4e-3)  # rad, of the second mount against the first


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    document = chain.short()
    plan = document["campaign"]["plan"]
    again = [m | {"id": f"b-{m['id']}", "log": f"b-{m['log']}", "mount": "second"} for m in plan]
    document["campaign"]["plan"] = [m | {"mount": "first"} for m in plan] + again
    turned = [1e3 * angle for angle in MOUNTING]
    rotations = {"first": [0, 0, 0], "second": turned}
    document["truth"]["mounts"] = {n: {"rotation_mrad": r} for n, r in rotations.items()}
    folder = tmp_path_factory.mktemp("mounts")
    return chain.run(chain.simulate(document, folder / "raw"), folder / "derived")


@pytest.fixture(scope="module")
def mounts(results):
    return chain.mounts(results)


def test_each_mount_has_its_own_manoeuvres(mounts):
    assert [data.mount for data in mounts] == ["first", "second"]
    for data in mounts:
        names = {m.name for m in data.plan}
        assert {position.manoeuvre.name for position in data.gyro_positions[0]} == names
        rests = [name for name in names if "-up" in name or "-down" in name]
        assert len(data.accelerometer_positions[0]) == 6 + 2 * (len(names) - len(rests))
        assert data.named("joint") == f"joint@{data.mount}"


def test_each_mount_has_its_own_result(mounts):
    """The second case is turned, so M of it is M of the first times a rotation."""
    first, second = (data.result for data in mounts)
    for one, other in ((first.gyro, second.gyro), (first.accelerometer, second.accelerometer)):
        between = np.linalg.inv(one.matrix) @ other.matrix
        off = np.array([between[2, 1], between[0, 2], between[1, 0]])
        np.testing.assert_allclose(np.abs(off), np.abs(MOUNTING), rtol=0.05)
    for data in mounts:
        positions = {
            position
            for position, quantity, _ in data.result.position_parameters
            if quantity == "tilt"
        }
        assert positions and positions <= {m.position for m in data.plan}


def test_times_are_not_compared_where_one_goes_back(results, mounts):
    """As seconds of the week do; a warm-up would be exp(604800/τ) times as large."""
    assert all(data.shared_clock for data in mounts)
    blocks = results["segment/blocks"].copy()
    own = np.flatnonzero(blocks["log"] == "z-up.asc")
    blocks.loc[own[len(own) // 2 :], "time"] -= 604800.0
    assert not any(data.shared_clock for data in chain.mounts(results, blocks=blocks))
