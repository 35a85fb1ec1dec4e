"""Whether two results differ by one rotation of the IMU in its mounting.

An IMU that is turned by θ against the case reads M exp(−θ×) · truth. So what the nine elements of M
of each sensor differ by may be one vector, the same in both sensors.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.linalg import block_diag
from scipy.spatial.transform import Rotation

from inertial.arrays import Array
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.estimation.probability import chi2_sf
from inertial.estimation.triad import linear_names
from inertial.sensors import PLURAL, SENSORS
from inertial.text.messages import _
from inertial.text.numbers import p_is, plus_minus, significant
from inertial.text.parameters import AXES, CROSS, sign_of
from inertial.text.units import ARC_SECOND
from overviews.compare.pair import Compared, Pair

ELEMENTS = linear_names()[:9]
ROUNDS = 5  # of Gauss and Newton; a rotation of degrees converges in three
MIN_SHARE = 0.9  # of χ², from which a rotation is the main difference


@dataclass(frozen=True)
class Remounted:
    """A rotation that explains what the matrices of both sensors differ by.

    rotation, sigma : (3,), rad, of the second against the first, in the axes of the case
    before, after : χ² of the elements of both matrices, `count` of them, without and with it
    still : the elements that differ by more than chance beside it
    """

    mount: str
    rotation: Array
    sigma: Array
    before: float
    after: float
    count: int
    still: tuple[Compared, ...]


def remounted(pair: Pair) -> Iterator[Remounted]:
    """The rotation of each mount, where one is significant and nearly all of the difference.

    Only where all cross terms of both sensors are known in both results, and no difference follows
    from others.
    """
    if not all(pair.together(sensor) for sensor in SENSORS):
        return
    for mount in dict.fromkeys(one.key[0] for one in pair.compared):
        rows = [
            [
                one
                for one in pair.of(sensor)
                if one.key[0] == mount and one.key[2] in ELEMENTS and one.in_sigmas is not None
            ]
            for sensor in SENSORS
        ]
        if all({*CROSS} <= {one.key[2] for one in own} for own in rows):
            found = _rotation(pair, mount, rows)
            drop = found.before - found.after
            if chi2_sf(drop, 3) < pair.level and drop > MIN_SHARE * found.before:
                yield found


def _rotation(pair: Pair, mount: str, rows: list[list[Compared]]) -> Remounted:
    """The rotation by least squares, from the elements of both sensors that are known."""
    every = [one for own in rows for one in own]
    weights = np.linalg.inv(block_diag(*(pair.covariance_of_differences(own) for own in rows)))
    first = [_matrix(own) for own in rows]
    places = [[ELEMENTS.index(one.key[2]) for one in own] for own in rows]
    difference = np.array([one.difference for one in every], np.float64)

    def elements(matrices: list[Array]) -> Array:
        """Those that are known, (n,), of matrices of both sensors."""
        pairs = zip(matrices, places, strict=True)
        return np.concatenate([matrix.ravel()[own] for matrix, own in pairs])

    turned = Rotation.identity()
    for _round in range(ROUNDS):
        moved = [matrix @ turned.as_matrix() for matrix in first]
        remaining = difference - elements(moved) + elements(first)
        crosses = [np.cross(np.eye(3), axis) for axis in np.eye(3)]  # e× of each axis
        design = np.column_stack([elements([-m @ cross for m in moved]) for cross in crosses])
        covariance = np.asarray(np.linalg.inv(design.T @ weights @ design))
        turned = turned * Rotation.from_rotvec(-covariance @ design.T @ weights @ remaining)
    left = np.linalg.inv(weights) - design @ covariance @ design.T
    sigmas = np.sqrt(np.diag(left).clip(1e-300))
    chances = [normal_p_value(r / s) for r, s in zip(remaining, sigmas, strict=True)]
    still = holm_rejections(chances, pair.level)
    return Remounted(
        mount,
        -turned.as_rotvec(),
        np.sqrt(np.diag(covariance)),
        float(difference @ weights @ difference),
        float(remaining @ weights @ remaining),
        len(every),
        tuple(one for one, beyond in zip(every, still, strict=True) if beyond),
    )


def _matrix(rows: list[Compared]) -> Array:
    """M of the first result, (3, 3); an element that is not known is that of no error."""
    matrix = np.eye(3).ravel()
    for one in rows:
        assert one.first is not None  # it is compared
        matrix[ELEMENTS.index(one.key[2])] += one.first["value"]
    return matrix.reshape(3, 3)


def in_words(found: Remounted) -> str:
    """What the rotation is and explains, in sentences."""
    angles = [
        f"{axis} {plus_minus(angle / ARC_SECOND, sigma / ARC_SECOND)}″"
        for axis, angle, sigma in zip(AXES, found.rotation, found.sigma, strict=True)
    ]
    said = _(
        "Both sensors are turned alike against the axes of the case, about {angles}: the IMU was "
        "mounted in another way. Of the {count} elements of both matrices χ² is {before}, and "
        "given that rotation {after} ({p}).",
        angles=", ".join(angles),
        count=found.count,
        before=significant(found.before, 3),
        after=significant(found.after, 3),
        p=p_is(float(chi2_sf(found.after, found.count - 3))),
    )
    if not found.still:
        return said + _(" Beside it no element differs by more than chance.")
    return said + _(
        " Beside it {elements} still differ by more than chance.",
        elements=", ".join(_name(one) for one in found.still),
    )


def _name(one: Compared) -> str:
    return _("{element} of the {sensor}", element=sign_of(one.key[2]), sensor=PLURAL[one.key[1]])
