"""`make draft`: gyros whose columns are exchanged or reversed, moved by an unsteady hand."""

import numpy as np
import pytest
from drafting import Rates, comments, drafted, moved, told, written
from scipy.ndimage import gaussian_filter1d

QUARTERS = [(1, 0, 0), (1, 0, 0), (0, 0, 1), (0, 1, 0), (0, 0, 1), (1, 0, 0), (0, 1, 0)]
MOVING = 3.0  # °/s


def turned(axis: tuple[float, ...], turns: float, seconds: float) -> Rates:
    """A turn of least jerk about an axis, as a hand makes it, in steps of 10 ms."""
    place = (np.arange(round(100 * seconds)) + 0.5) / round(100 * seconds)
    rate = 2 * np.pi * turns / seconds * 30 * place**2 * (1 - place) ** 2
    return [(0.01, tuple((one * np.array(axis)).tolist())) for one in rate]


def by_hand(unsteady: float) -> np.ndarray:
    """Eleven static positions and a round about each axis; the hand accelerates, m/s², rms."""
    rates: Rates = [(7, (0, 0, 0))]
    for axis in QUARTERS:
        rates += [*turned(axis, 1 / 4, 2), (7, (0, 0, 0))]
    for axis in np.eye(3).tolist():
        rates += [*turned(tuple(axis), 1, 6), (5, (0, 0, 0))]
        rates += [*turned((axis[2], axis[0], axis[1]), 1 / 4, 2), (5, (0, 0, 0))]
    log = moved(rates)
    shaken = gaussian_filter1d(np.random.default_rng(1).standard_normal((len(log), 3)), 10, axis=0)
    moves = np.linalg.norm(log[:, 4:], axis=1) > MOVING
    log[moves, 1:4] += unsteady * (shaken / shaken.std())[moves]
    return log


@pytest.mark.parametrize("unsteady", [0.0, 1.0])
@pytest.mark.parametrize(
    ("order", "signs", "axes"),
    [
        ((1, 0, 2), (1, 1, 1), ["y", "x", "z"]),
        ((1, 2, 0), (1, 1, 1), ["y", "z", "x"]),
        ((0, 2, 1), (1, -1, 1), ["x", "-z", "y"]),
        ((0, 1, 2), (1, -1, 1), ["x", "-y", "z"]),
    ],
)
def test_exchanged_axes_of_gyros_are_found_and_asked_about(unsteady, order, signs, axes, tmp_path):
    """Their unit is that of gyros; it was "no usual unit", for the axes were those named."""
    log = by_hand(unsteady)
    rate = log[:, 4:][:, order] * np.array(signs)
    text = "t,ax,ay,az,gx,gy,gz\n" + written([log[:, :4], rate])
    folder = drafted({"log.csv": text}, tmp_path)
    instrument = told(folder)["instrument"]
    assert instrument["format"]["gyro"] == {"columns": ["gx", "gy", "gz"], "unit": "deg/s"}
    assert instrument["gyro"]["axes"] == axes
    assert "which sensor is wired otherwise" in comments(folder)


def test_gyros_as_named_are_left_so(tmp_path):
    log = by_hand(1.0)
    folder = drafted({"log.csv": "t,ax,ay,az,gx,gy,gz\n" + written([log])}, tmp_path)
    assert "gyro" not in told(folder)["instrument"]
    assert "wired otherwise" not in comments(folder)


def test_three_reversed_gyros_may_be_left_handed_axes(tmp_path):
    log = by_hand(0.0)
    log[:, [2, 5]] *= -1  # the y axis of both sensors
    text = "t,ax,ay,az,gx,gy,gz\n" + written([log])
    said = comments(drafted({"log.csv": text}, tmp_path))
    assert "gyro.axes: in log.csv all three gyros turn gravity's direction backwards" in said
    assert "axes: [x, -y, z]" in said and "is clockwise positive?" in said
