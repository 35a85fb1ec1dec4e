"""Sizes after selection in the fit of each sensor, and of another member of a class."""

import numpy as np
import pytest

from inertial.estimation.effect_information import EffectInformation
from inertial.estimation.least_squares import Estimate
from inertial.model_selection.size_after_selection import selected
from inertial.physics.effect import Effect, Parameter
from stages.extension.models import SensorEvidence, selected_sizes
from stages.extension.named_effects import Member, NamedClass


class Hidden(Effect):
    name = "hidden"
    parameters = (Parameter("p", "1", 1.0, ""), Parameter("q", "1", 1.0, ""))


class Mate(Effect):
    name = "mate"
    parameters = (Parameter("r", "1", 1.0, ""),)


NAMES = (*Hidden().columns, *Mate().columns)
THRESHOLD, DRAWS = 18.0, 6_000
NOTHING = Estimate(np.zeros(0), np.zeros((0, 0)), np.zeros(0, bool), 0.0, 1, 0.0, 1)


@pytest.mark.slow
def test_each_sensor_follows_what_both_have_named():
    """The named effect is judged by both sensors; each is fitted alone, and so is a mate."""
    rng = np.random.default_rng(1)
    designs = {"gyro": rng.normal(size=(9, 3)), "accel": 0.7 * rng.normal(size=(7, 3))}
    information = {sensor: design.T @ design for sensor, design in designs.items()}
    total = sum(information.values())[:2, :2]
    truth = np.array([1.0, 0.6, 0.0])
    truth *= 5.0 / np.sqrt(truth[:2] @ total @ truth[:2])
    bias: dict[str, list[np.ndarray]] = {"plain": [], "corrected": []}
    for _ in range(DRAWS):
        rights = {
            sensor: information[sensor] @ truth + design.T @ rng.normal(size=len(design))
            for sensor, design in designs.items()
        }
        right = sum(rights.values())[:2]
        drop = float(right @ np.linalg.solve(total, right))
        if drop < THRESHOLD:
            continue
        evidence = {
            sensor: SensorEvidence(
                NOTHING, EffectInformation(NAMES, information[sensor], rights[sensor], 0.0, 9), 0.0
            )
            for sensor in designs
        }
        named = NamedClass("", (Member(Hidden(), 1.0),), (), selected(drop, 2, THRESHOLD))
        sizes = selected_sizes(evidence, [named])
        plain, moved = [], []
        for sensor in designs:
            for own in ([0, 1], [2]):
                block = information[sensor][np.ix_(own, own)]
                true = np.linalg.solve(block, information[sensor][own] @ truth)
                estimate = np.linalg.solve(block, rights[sensor][own])
                follows = sizes._follows(evidence[sensor].effects, [NAMES[i] for i in own])
                sigma = np.sqrt(np.diag(np.linalg.inv(block)))
                plain += [*((estimate - true) / sigma)]
                moved += [*((estimate + follows @ sizes.shift - true) / sigma)]
        bias["plain"].append(np.array(plain))
        bias["corrected"].append(np.array(moved))
    before, after = (np.mean(bias[key], axis=0) for key in ("plain", "corrected"))
    assert np.abs(before).max() > 0.15  # sigma, of some parameter
    assert np.abs(after).max() < 0.05
    assert len(bias["plain"]) < 0.9 * DRAWS  # many draws were not named


def test_where_no_sensor_shows_anything_nothing_moves():
    sizes = selected_sizes({"gyro": None, "accel": None}, [NamedClass("", (Member(Hidden(), 1),))])
    assert sizes.shift.tolist() == [0.0, 0.0] and sizes.change == pytest.approx(0)
