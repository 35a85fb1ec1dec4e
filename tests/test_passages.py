"""The motions that carry an attitude from one rest to the next."""

import numpy as np

from inertial.campaign.passages import RecordedPassage, without_walks
from inertial.campaign.records import Part
from inertial.estimation.attitude import Passage


def recorded(rates: np.ndarray, seconds: float) -> RecordedPassage:
    """A motion with rates (k, 3), rad/s, in as many equal pieces of its time."""
    step = np.full(len(rates), seconds / len(rates))
    passage = Passage(0, rates, step, np.full(3, 1e-4))
    return RecordedPassage(Part("a to b", "between"), "log", passage, step, step)


def test_a_walk_between_two_rests_carries_no_attitude():
    """To and fro with an amplitude of 0.5 rad at 1 Hz: 2 rad in a second, 120 in a minute."""
    quarter = np.zeros((100, 3))
    quarter[20:80, 0] = np.pi / 2 / 2 / 0.6
    time = np.arange(6000) / 100
    walk = np.zeros((6000, 3))
    walk[:, 1] = 0.5 * 2 * np.pi * np.sin(2 * np.pi * time)
    moves = [recorded(quarter, 2.0) for _ in range(9)]
    kept, left_out = without_walks([*moves, recorded(walk, 60.0)], [])
    assert kept == moves
    (walked,) = left_out
    turned = float(walked.reason.split("°")[0].split()[-1])
    assert abs(turned / np.degrees(0.5 * 4 * 60) - 1) < 0.01


def test_a_session_that_turns_by_whole_rounds_keeps_them():
    rounds = np.zeros((100, 3))
    rounds[10:, 2] = 4 * 2 * np.pi / 10 / 0.9
    moves = [recorded(rounds, 10.0) for _ in range(3)]
    assert without_walks(moves, []) == (moves, [])
