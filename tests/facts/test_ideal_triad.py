"""What ideal sensors read on the earth, held against potential and motion in inertial space.

Shares nothing with the code but the constants of the ellipsoid: gravity is the gradient of the
closed potential of the level ellipsoid (Hofmann-Wellenhof & Moritz 2006, Physical Geodesy, 2.7),
forces and rates are differences of position and attitude in inertial space.
"""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from commands.theory import PAGE, page
from inertial.physics.forward import at_steady_speed, in_free_fall
from inertial.physics.site import normal_gravity

RATE = 7.292115e-5  # rad/s
STEP = 100.0  # m, of a gradient
SECONDS = 3.0  # of a difference in time


@dataclass(frozen=True)
class Ellipsoid:
    """A level ellipsoid: GM in m³/s², semi-major axis in m, flattening."""

    gm: float
    a: float
    f: float

    def position(self, latitude, longitude, height):
        e2 = self.f * (2 - self.f)
        n = self.a / np.sqrt(1 - e2 * np.sin(latitude) ** 2)
        level = (n + height) * np.cos(latitude)
        z = (n * (1 - e2) + height) * np.sin(latitude)
        return np.array([level * np.cos(longitude), level * np.sin(longitude), z])

    def potential(self, at):
        """Of gravitation alone, m²/s²."""
        b = self.a * (1 - self.f)
        e = np.sqrt(self.a**2 - b**2)

        def q(u):  # as a series, for its closed form loses ten digits
            n = np.arange(1, 12)
            terms = (-1.0) ** (n + 1) * n / ((2 * n + 1) * (2 * n + 3)) * (e / u) ** (2 * n + 1)
            return 2 * np.sum(terms)

        d = at @ at - e**2
        u = np.sqrt(d / 2 * (1 + np.sqrt(1 + 4 * e**2 * at[2] ** 2 / d**2)))
        form = (RATE * self.a) ** 2 / 2 * q(u) / q(b) * ((at[2] / u) ** 2 - 1 / 3)
        return self.gm / e * np.arctan(e / u) + form

    def gravitation(self, at):
        steps = STEP * np.eye(3)
        return np.array([self.potential(at + s) - self.potential(at - s) for s in steps]) / 2 / STEP

    def gravity(self, latitude, height):
        """North and down."""
        at = self.position(latitude, 0.0, height)
        x, _, z = self.gravitation(at) + RATE**2 * at * (1, 1, 0)
        sine, cosine = np.sin(latitude), np.cos(latitude)
        return z * cosine - x * sine, -z * sine - x * cosine


GRS80 = Ellipsoid(3.986005e14, 6378137.0, 1 / 298.257222101)
WGS84 = Ellipsoid(3.986004418e14, 6378137.0, 1 / 298.257223563)


def test_the_closed_potential_gives_the_published_values():
    """Moritz 2000, Geodetic Reference System 1980, J. Geod. 74, 128-133."""
    for degrees, published in ((0, 9.7803267715), (45, 9.806199203), (90, 9.8321863685)):
        north, down = GRS80.gravity(np.radians(degrees), 0.0)
        assert down == pytest.approx(published, abs=3e-9)
        assert north == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("degrees", [0, 20, -45, 70, 90])
def test_normal_gravity_is_the_gradient_of_the_potential(degrees):
    latitude = np.radians(degrees)
    for height, error in ((0.0, 3e-9), (1000.0, 1.1e-7), (10_000.0, 8e-7)):
        north, down = WGS84.gravity(latitude, height)
        assert normal_gravity(latitude, height) == pytest.approx(down, abs=error)
        # The component that the ideal triad leaves out.
        assert north == pytest.approx(-8.14e-9 * height * np.sin(2 * latitude), abs=2e-7)


def moved(latitude, height, velocity):
    """Rate and specific force in NED by central differences over the path in inertial space."""
    north, east, down = velocity
    e2 = WGS84.f * (2 - WGS84.f)

    def speed(_, at):
        phi, _, h = at
        root = np.sqrt(1 - e2 * np.sin(phi) ** 2)
        n, m = WGS84.a / root, WGS84.a * (1 - e2) / root**3
        return [north / (m + h), east / ((n + h) * np.cos(phi)), -down]

    def there(time):
        at = [latitude, 0.3, height]
        if time:
            at = solve_ivp(speed, (0, time), at, rtol=1e-13, atol=1e-15).y[:, -1]
        phi, lam, h = at
        turned = Rotation.from_euler("z", RATE * time)
        axes = Rotation.from_euler("ZY", [lam, -phi - np.pi / 2])
        return turned.apply(WGS84.position(phi, lam, h)), turned * axes

    (before, first), (here, axes), (after, last) = (there(t) for t in (-SECONDS, 0.0, SECONDS))
    acceleration = (after - 2 * here + before) / SECONDS**2
    force = axes.inv().apply(acceleration - WGS84.gravitation(here))
    return (first.inv() * last).as_rotvec() / (2 * SECONDS), force


@pytest.mark.parametrize(
    ("degrees", "height", "velocity"),
    [
        (0, 0, (0, 0, 0)),
        (-35, 500, (0, 0, 0)),
        (45, 0, (100, 0, 0)),
        (45, 0, (0, 100, 0)),
        (-60, 0, (0, -250, 0)),
        (30, 10_000, (150, 200, -10)),
    ],
)
def test_rates_and_forces_are_those_of_the_motion_in_inertial_space(degrees, height, velocity):
    latitude = np.radians(degrees)
    read = at_steady_speed(latitude, height, velocity)
    rate, force = moved(latitude, float(height), velocity)
    np.testing.assert_allclose(read.rate, rate, atol=1e-12)
    left_out = 8.1e-9 * height * np.sin(2 * latitude)
    np.testing.assert_allclose(read.force, force - (left_out, 0, 0), atol=1e-6)


def test_at_the_poles_the_earth_turns_about_the_vertical_alone():
    for sign in (1, -1):
        read = at_steady_speed(sign * np.pi / 2, 0.0)
        np.testing.assert_allclose(read.rate, [0, 0, -sign * RATE], atol=1e-18)
        np.testing.assert_allclose(read.force, [0, 0, -9.8321849379], atol=1e-9)


def test_the_sign_of_the_course_notes():
    """S1 writes f_u = −9.8 for the upward component; −9.8 is the downward one."""
    read = at_steady_speed(np.radians(30), 0.0)
    assert read.force[2] == pytest.approx(-9.8, abs=0.05)
    assert read.in_enu.force[2] == pytest.approx(9.8, abs=0.05)
    np.testing.assert_allclose(read.in_enu.rate * 206264.806, [0, 13.026, 7.5205], atol=1e-3)
    assert not in_free_fall(0.5).force.any()


def test_the_page_is_that_of_the_code():
    assert PAGE.read_text(encoding="utf-8") == page(), "run `make docs`"
