"""Rests step by step about a level axis, and an IMU that is bolted to the table anew."""

from collections.abc import Callable
from math import cos, radians, sin
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from laboratory import Recording, SpecificationError, perform, specify

Performed = Callable[..., Recording]
Document = dict[str, Any]

GRAVITY, EARTH, LATITUDE = 9.7936174, 7.292115e-5, radians(30.5278)
ALSO = {"handling": {"still_s": 1, "step": {"rate_deg_s": 60, "accel_deg_s2": 120}}}


def tumble(**changes: Any) -> Document:
    """Five rests of 2 s, 50° apart, about x, which points north; and back."""
    return {
        "id": "over",
        "do": "tumble",
        "up": "+z",
        "mark": "+x",
        "about": "+x",
        "step_degrees": 50,
        "steps": 5,
        "and_back": True,
        "seconds": 2,
    } | changes


def test_every_rest_stands_a_step_further(performed: Performed) -> None:
    """The case turns by +angle about x: z leans from up to south of east … and y comes up."""
    truth = performed(tumble(), also=ALSO).truth["all.asc"]
    there, back = [f"over-{k:02d}" for k in range(5)], [f"over-back-{k:02d}" for k in range(5)]
    assert list(truth.rows) == there + back[::-1]
    for name, rows in truth.rows.items():
        angle = radians(50 * int(name[-2:]))
        force, rate = truth.force[rows.start : rows.stop], truth.rate[rows.start : rows.stop]
        expected = GRAVITY * np.array([0, sin(angle), cos(angle)])
        assert force == pytest.approx(np.broadcast_to(expected, force.shape), abs=1e-12)
        upwards = EARTH * sin(LATITUDE) * np.array([0, sin(angle), cos(angle)])
        expected = upwards + np.array([EARTH * cos(LATITUDE), 0, 0])
        assert rate == pytest.approx(np.broadcast_to(expected, rate.shape), abs=1e-15)


def test_the_gyros_feel_every_step_and_that_it_goes_on_before_it_comes_back(
    performed: Performed,
) -> None:
    """60 deg/s at 120 deg/s²: 50° in 1.33 s, and 0.1 s to settle; the axis is x all the way."""
    truth = performed(tumble(), also=ALSO).truth["all.asc"]
    assert len(truth.time) == 10 * 200 + 10 * 144
    angle = np.degrees(np.cumsum(truth.rate[:, 0] - EARTH * cos(LATITUDE)) * 0.01)
    assert angle.max() == pytest.approx(250, abs=1e-9)  # beyond the last rest, at 200°
    ends = [angle[rows.stop - 1] for rows in truth.rows.values()]
    assert ends == pytest.approx([0, 50, 100, 150, 200, 200, 150, 100, 50, 0], abs=1e-9)
    assert np.abs(np.diff(angle)).max() == pytest.approx(0.6, abs=1e-9)


def test_without_a_mark_the_rests_still_share_one_azimuth(
    ideal: Callable[..., Document],
) -> None:
    plan = tumble()
    del plan["mark"]
    placements = perform(specify(ideal(plan, also=ALSO))).placements.values()
    axes = np.array([placement.attitude @ [1, 0, 0] for placement in placements])
    assert axes == pytest.approx(np.broadcast_to(axes[0], axes.shape), abs=1e-12)
    assert abs(axes[0] @ [0, 1, 0]) < 0.999  # drawn, not north


def test_errors_of_positions_are_walked_through(ideal: Callable[..., Document]) -> None:
    """Between rests that are off by 10′ the gyros turn from one to the next exactly."""
    document = ideal(tumble(step_degrees=180, steps=3), also=ALSO)
    document["campaign"]["table"]["position_sigma_arcsec"] = 600
    recording = perform(specify(document))
    truth = recording.truth["all.asc"]
    spun = truth.rate - 0
    rows = list(truth.rows.values())
    stood = [placement.attitude for placement in recording.placements.values()]
    for before, after, one, other in zip(rows, rows[1:], stood, stood[1:], strict=False):
        attitude = Rotation.from_matrix(one)
        for rate in spun[before.stop : after.start]:
            earth = attitude.inv().apply([0, EARTH * cos(LATITUDE), EARTH * sin(LATITUDE)])
            attitude = attitude * Rotation.from_rotvec((rate - earth) * 0.01)
        assert (attitude.inv() * Rotation.from_matrix(other)).magnitude() < 2e-6


def test_an_imu_that_is_bolted_on_askew(ideal: Callable[..., Document]) -> None:
    """Turned by 5 mrad about x against what the plan names: y reads the sine of it, upwards."""
    rest = {"do": "rest", "up": "+z", "mark": "+x", "seconds": 2}
    plan = [rest | {"id": "a", "log": "a"}, rest | {"id": "b", "log": "b", "mount": "second"}]
    document = ideal(*plan)
    document["truth"]["mounts"] = {"second": {"rotation_mrad": [5, 0, 0]}}
    truth = perform(specify(document)).truth
    assert truth["a"].force.mean(axis=0) == pytest.approx([0, 0, GRAVITY], abs=1e-12)
    expected = GRAVITY * np.array([0, sin(0.005), cos(0.005)])
    assert truth["b"].force.mean(axis=0) == pytest.approx(expected, abs=1e-12)


def test_a_turn_of_a_case_askew_is_about_the_axis_of_the_table(
    ideal: Callable[..., Document],
) -> None:
    """Reading = R(v)ᵀ · what the plan's axes feel: the table's rate stands askew in the case."""
    turn = {"id": "t", "do": "turn", "up": "+z", "mark": "+x", "degrees": 360, "mount": "m"}
    document = ideal(turn | {"rate_deg_s": 40, "accel_deg_s2": 40})
    document["handling"] = {"still_s": 1}
    straight = perform(specify(document)).truth["all.asc"]
    document["truth"]["mounts"] = {"m": {"rotation_mrad": [5, -3, 8]}}
    askew = perform(specify(document)).truth["all.asc"]
    rotation = Rotation.from_rotvec([0.005, -0.003, 0.008])
    assert askew.rate == pytest.approx(rotation.inv().apply(straight.rate), abs=1e-12)
    assert askew.force == pytest.approx(rotation.inv().apply(straight.force), abs=1e-11)


WRONG: list[tuple[Document, str]] = [
    (tumble(about="+z"), r"plan\[0\].about: found \+z; expected an axis across up"),
    ({k: v for k, v in tumble().items() if k != "steps"}, r"plan\[0\].steps: found nothing"),
    ({k: v for k, v in tumble().items() if k != "seconds"}, r"plan\[0\].seconds: found nothing"),
    (tumble(degrees=90), r"plan\[0\].degrees: found 90; expected nothing: a tumble"),
    (
        {"id": "still", "do": "rest", "up": "+z", "seconds": 2, "steps": 2},
        r"plan\[0\].steps: found 2; expected nothing: a rest",
    ),
]


@pytest.mark.parametrize(("manoeuvre", "message"), WRONG)
def test_tumbles_that_cannot_be_made(
    ideal: Callable[..., Document], manoeuvre: Document, message: str
) -> None:
    with pytest.raises(SpecificationError, match=message):
        specify(ideal(manoeuvre, also=ALSO))


def test_what_a_tumble_and_a_mount_need_is_said(ideal: Callable[..., Document]) -> None:
    with pytest.raises(SpecificationError, match=r"handling.step: found nothing"):
        specify(ideal(tumble(), also={"handling": {"still_s": 1}}))
    document = ideal(tumble(), also=ALSO)
    document["truth"]["mounts"] = {"other": {"rotation_mrad": [0, 0, 0]}}
    with pytest.raises(SpecificationError, match=r"truth.mounts.other: .*as mounted"):
        specify(document)
    rest = {"do": "rest", "up": "+z", "seconds": 2}
    two = ideal(rest | {"id": "a"}, rest | {"id": "b", "mount": "other"})
    with pytest.raises(SpecificationError, match=r"plan\[1\].log: .*another log for another"):
        specify(two)
