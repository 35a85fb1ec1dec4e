"""In a turn about a level axis the accelerometers feel every error of its angle.

Readings are made here of six rests, and of whole turns about y, there and back, in means of 30°
with a rest before and one behind. The table stops to the sigma of its angle, and between the stops
the angle is known to the random walk of a gyro. Part of the tilt of a position is fixed to the
laboratory, the other one to the case, with an azimuth of the axis of the turn in it.
"""

from dataclasses import replace

import numpy as np
from scipy.spatial.transform import Rotation

from inertial.campaign.records import Manoeuvre
from inertial.campaign.static_positions import turn_errors
from inertial.estimation.accelerometers import Reference, StaticForce, fit
from inertial.physics.motion import level_axes

GRAVITY, NOISE, ARC_SECOND = 9.8, 5e-5, np.radians(1 / 3600)
ANGLE_SIGMA, WALK, POSITION_SIGMA = np.array([10, 5, 2]) * ARC_SECOND
Z, Y = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])
UPS = [sign * axis for axis in np.eye(3) for sign in (1, -1)]
DRAWS = 40


def turn(name: str, angle: float) -> Manoeuvre:
    of_log = {"log": "", "mount": "", "mark": None, "recorded": "whole", "label": None}
    no_span = dict.fromkeys(["from_s", "to_s", "from_row", "to_row"])
    known = {"about": Y, "angle": angle, "angle_sigma": ANGLE_SIGMA, "rate": 0.5}
    own = {"position": name, "up": Z, "acceleration": None, "seconds": None}
    return Manoeuvre(name=name, do="turn", **of_log, **no_span, **known, **own)


def readings(random: np.random.Generator) -> tuple[list[StaticForce], np.ndarray]:
    """Means, and M and the bias that are drawn."""
    matrix, bias = np.eye(3) + random.normal(0, 1e-3, (3, 3)), random.normal(0, 0.01, 3)
    statics = []

    def read(position, up, actual, errors=None, **turned):
        mean = GRAVITY * matrix @ actual + bias + random.normal(0, NOISE, 3)
        known = {"turn_errors": errors or {}, **turned}
        statics.append(StaticForce(position, up, mean, np.full(3, NOISE), **known))

    def tilt():
        return Rotation.from_rotvec(random.normal(0, POSITION_SIGMA, 3))

    for number, up in enumerate(UPS):
        read(f"rest {number}", up, tilt().apply(up))
    for name, sign in (("there", 1), ("back", -1)):
        m, whole, of_axis = turn(name, sign * 2 * np.pi), tilt(), tilt()
        of_case = whole * of_axis.inv() * Rotation.from_rotvec(random.normal(0, POSITION_SIGMA) * Z)
        begun, ended = random.normal(0, ANGLE_SIGMA / np.sqrt(2), 2)
        walked = np.cumsum([0.0, *random.normal(0, WALK / np.sqrt(24), 24)])
        for half in [0, *range(1, 24, 2), 24]:
            place = half / 24
            planned = sign * 2 * np.pi * place
            angle = planned + (1 - place) * begun + place * ended
            angle += walked[half] - place * walked[-1]
            at, now = (Rotation.from_rotvec(-by * Y) for by in (planned, angle))
            case = np.array(level_axes(Z))
            turned = (
                {"turning": True, "level": at.apply(case), "case": case} if 0 < place < 1 else {}
            )
            read(
                name,
                at.apply(Z),
                of_case.apply(now.apply(of_axis.apply(Z))),
                turn_errors(m, place, WALK),
                **turned,
            )
    return statics, np.append(matrix.ravel(), bias)


def test_the_truth_comes_back_within_its_sigma_and_nothing_is_left():
    pulls, chances, without = [], [], []
    reference = Reference(GRAVITY, 1e-6, POSITION_SIGMA)
    for seed in range(DRAWS):
        statics, true = readings(np.random.default_rng(seed))
        fitted = fit(statics, reference)
        pulls.append((fitted.estimate.values[:12] - true) / fitted.estimate.sigma[:12])
        chances.append(fitted.p_value)
        exact = [replace(static, turn_errors={}) for static in statics]
        without.append(fit(exact, reference).p_value)
    assert 0.9 < np.sqrt(np.mean(np.square(pulls))) < 1.1
    assert np.median(chances) > 0.2 and np.mean(np.array(chances) < 0.01) < 0.1
    assert np.median(without) < 1e-10
