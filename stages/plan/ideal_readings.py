"""What ideal sensors would read at the site of the campaign, elsewhere, and under way."""

from collections.abc import Iterator
from math import copysign, pi, radians
from typing import Any

from inertial.physics.ideal_triad import at_steady_speed, in_free_fall

SPEED, HIGH = 100.0, 10_000.0  # m/s, m: of the triads under way


def ideal_readings(site: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Rows of the table; none where the latitude of the site is not known."""
    if site["latitude_deg"] is None:
        return
    latitude, height = radians(site["latitude_deg"]), site.get("height_m", 0.0)
    pole = copysign(pi / 2, latitude)
    readings = [
        ("at_rest", latitude, height, 0.0, at_steady_speed(latitude, height)),
        ("in_free_fall", latitude, height, 0.0, in_free_fall(latitude)),
        ("at_equator", 0.0, height, 0.0, at_steady_speed(0.0, height)),
        ("at_pole", pole, height, 0.0, at_steady_speed(pole, height)),
    ]
    if latitude != pole:  # where there is neither north nor east
        for name, velocity in (("north", (SPEED, 0.0, 0.0)), ("east", (0.0, SPEED, 0.0))):
            for level in (height, HIGH):
                read = at_steady_speed(latitude, level, velocity)
                readings.append((f"under_way_{name}", latitude, level, SPEED, read))
    for situation, phi, level, speed, read in readings:
        place = {"situation": situation, "latitude": phi, "height": level, "speed": speed}
        for sensor, values in (("accel", read.force), ("gyro", read.rate)):
            components = dict(zip(("north", "east", "down"), map(float, values), strict=True))
            yield place | {"sensor": sensor} | components
