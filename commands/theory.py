"""docs/theory.md, computed: what an ideal triad of gyros and accelerometers reads on the earth.

python -m commands.theory        writes the page; a test compares it with the code
"""

from collections.abc import Iterable, Iterator
from math import pi, radians
from pathlib import Path

import numpy as np
from jinja2 import Environment, StrictUndefined

from inertial.physics.forward import IdealReading, at_steady_speed, in_free_fall
from inertial.physics.site import ANOMALY_SIGMA, EARTH_RATE, normal_gravity
from inertial.text.numbers import fixed
from inertial.text.units import DEGREE_PER_HOUR

PAGE = Path(__file__).parent.parent / "docs/theory.md"
TEMPLATE = Path(__file__).parent / "theory.md.jinja"
LATITUDES = (90, 75, 60, 45, 30, 15, 0, -45)  # degrees
HEIGHTS = (0, 1000, 5000, 10_000)  # m
# WGS 84, gravity on the ellipsoid, m/s² (NIMA TR8350.2, table 3.4).
PUBLISHED = ((0, 9.7803253359), (90, 9.8321849379))
NED, ENU = ("N", "E", "D"), ("E", "N", "U")


def page() -> str:
    """The whole page."""
    middle = radians(45)
    rest, east = (at_steady_speed(middle, 0.0, (0.0, speed, 0.0)) for speed in (0.0, 250.0))
    dynamic = np.linalg.norm(east.rate - rest.rate) / np.linalg.norm(rest.rate)
    template = Environment(undefined=StrictUndefined, keep_trailing_newline=True).from_string(
        TEMPLATE.read_text(encoding="utf-8")
    )
    return template.render(
        earth_rate=f"{EARTH_RATE * 1e5:.6f}",
        earth_rate_per_hour=fixed(EARTH_RATE / DEGREE_PER_HOUR, 4),
        anomaly=fixed(ANOMALY_SIGMA * 1e3, 1),
        tables="\n".join([*_at_rest(), *_situations(), *_gravity()]),
        faster=fixed((EARTH_RATE / DEGREE_PER_HOUR / 15 - 1) * 100, 2),
        lost=fixed((normal_gravity(middle, 0.0) - normal_gravity(middle, 100.0)) * 1e4, 2),
        dynamic=fixed(float(dynamic) * 100, 0),
        coriolis=fixed(float(np.linalg.norm(east.force - rest.force)) * 1e3, 1),
    )


def _at_rest() -> Iterator[str]:
    yield "## At rest on the level, height 0\n"
    yield (
        "Gyros in °/h, accelerometers in m/s². East reads zero everywhere; so do, of the "
        "accelerometers, north and east.\n"
    )
    heads = ("latitude, °", "gyro N", "gyro D", "gyro U", "accelerometer D", "accelerometer U")
    yield from _head(heads)
    for latitude in LATITUDES:
        read = at_steady_speed(radians(latitude), 0.0)
        north, _, down = read.rate / DEGREE_PER_HOUR
        numbers = (fixed(north, 4), fixed(down, 4), fixed(-down, 4))
        yield _line(
            (fixed(latitude, 0), *numbers, fixed(read.force[2], 6), fixed(-read.force[2], 6))
        )
    yield ""


def _situations() -> Iterator[str]:
    middle = radians(45)
    cases = {
        "at rest on the level, 45°": at_steady_speed(middle, 0.0),
        "in free fall, 45°": in_free_fall(middle),
        "at rest at the equator": at_steady_speed(0.0, 0.0),
        "at rest at the north pole": at_steady_speed(pi / 2, 0.0),
        "at rest at the south pole": at_steady_speed(-pi / 2, 0.0),
        "100 m/s to the north, 45°": at_steady_speed(middle, 0.0, (100.0, 0.0, 0.0)),
        "100 m/s to the east, 45°": at_steady_speed(middle, 0.0, (0.0, 100.0, 0.0)),
        "250 m/s to the north at 10 km, 45°": at_steady_speed(middle, 1e4, (250.0, 0.0, 0.0)),
        "250 m/s to the east at 10 km, 45°": at_steady_speed(middle, 1e4, (0.0, 250.0, 0.0)),
        "10 m/s upward at 10 km, 45°": at_steady_speed(middle, 1e4, (0.0, 0.0, -10.0)),
    }
    for frame, axes in (("NED", NED), ("ENU", ENU)):
        yield f"## Situations in {frame}\n"
        yield "Gyros in °/h, accelerometers in m/s².\n"
        yield from _head(
            ("", *(f"gyro {axis}" for axis in axes), *(f"accelerometer {axis}" for axis in axes))
        )
        for name, ned in cases.items():
            yield _line((name, *_six(ned if frame == "NED" else ned.in_enu)))
        yield ""


def _six(read: IdealReading) -> Iterator[str]:
    yield from (fixed(each, 4) for each in read.rate / DEGREE_PER_HOUR)
    yield from (fixed(each, 6) for each in read.force)


def _gravity() -> Iterator[str]:
    yield "## Normal gravity, m/s²\n"
    yield from _head(("latitude, °", *(f"{height} m" for height in HEIGHTS), "published, 0 m"))
    published = dict(PUBLISHED)
    for latitude in LATITUDES:
        if latitude >= 0:
            values = [fixed(normal_gravity(radians(latitude), height), 7) for height in HEIGHTS]
            known = f"{published[latitude]:.7f}" if latitude in published else ""
            yield _line((str(latitude), *values, known))
    yield ""


def _head(cells: Iterable[str]) -> Iterator[str]:
    cells = tuple(cells)
    yield _line(cells)
    yield "|---" + "|---:" * (len(cells) - 1) + "|"


def _line(cells: Iterable[str]) -> str:
    return f"| {' | '.join(cells)} |"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
