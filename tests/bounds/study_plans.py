"""The plans a to e of the design study, and the noise of two instruments (its section 6)."""

from typing import Any

AXES = "xyz"
MARKS = {"x": "+y", "y": "+z", "z": "+x"}  # level where the axis points up or down
ARCSECONDS = 2.0  # of positions and angles


def rest(name: str, up: str, seconds: float, position: str | None = None) -> dict[str, Any]:
    own = {"id": name, "do": "rest", "up": up, "mark": MARKS[up[1]], "seconds": seconds}
    return own | {"position": position or name}  # else each is set anew


def turn(
    name: str, up: str, degrees: float, rate: float, ramp: float, position: str | None = None
) -> dict[str, Any]:
    own = {"id": name, "do": "turn", "up": up, "mark": MARKS[up[1]], "degrees": degrees}
    own |= {"rate_deg_s": rate, "accel_deg_s2": ramp}
    return own | {"position": position or name}  # else each is set anew


def six_positions(seconds: float = 300) -> list[dict[str, Any]]:
    return [
        rest(f"{axis}-{way}", sign + axis, seconds)
        for axis in AXES
        for way, sign in (("up", "+"), ("down", "-"))
    ]


def six_turns() -> list[dict[str, Any]]:
    return [
        turn(f"{axis}-{way}", "+" + axis, degrees, 10, 10)
        for axis in AXES
        for way, degrees in (("forward", 360), ("backward", -360))
    ]


def turn_and_stop() -> list[dict[str, Any]]:
    """S3: from each of six positions there and back, up at 6 °/s, down at 12 °/s."""
    plan = []
    for axis in AXES:
        for way, sign, rate in (("up", "+", 6), ("down", "-", 12)):
            name, up = f"{axis}-{way}", sign + axis
            plan += [
                rest(f"{name}-before", up, 120, name),
                turn(f"{name}-forward", up, 360, rate, rate, name),
                turn(f"{name}-back", up, -360, rate, rate, name),
                rest(f"{name}-after", up, 120, name),
            ]
    return plan


def rates() -> list[dict[str, Any]]:
    """S4: whole turns both ways at five rates, each axis up."""
    return [
        turn(f"{axis}{sign}{rate}", "+" + axis, float(f"{sign}360"), rate, 20, axis)
        for axis in AXES
        for rate in (10, 20, 40, 60, 80)
        for sign in "+-"
    ]


def tumbles() -> list[dict[str, Any]]:
    """Every 20° about each horizontal axis, 20 s each."""
    return [
        {"id": f"about-{axis}", "do": "tumble", "about": "+" + axis, "up": MARKS[axis]}
        | {"mark": "+" + axis, "step_degrees": 20, "steps": 18, "and_back": False, "seconds": 20}
        for axis in AXES
    ]


PLANS = {
    "a": six_positions(),
    "b": six_positions() + six_turns(),
    "c": turn_and_stop(),
    "d": rates(),
    "e": tumbles(),
}
# Angle random walk, °/√h, and velocity random walk, m/s/√h, of the data sheets.
NOISE = {"FSAS": (0.1, 0.03), "STIM300": (0.15, 0.06)}


def campaign(plan: str) -> dict[str, Any]:
    """The campaign file of a plan: Wuhan, the azimuth of the table known."""
    return {
        "campaign": 1,
        "instrument": "span-cpt",
        "serial": "unknown",
        "date": "unknown",
        "site": {"latitude_deg": 30.5278, "gravity_m_s2": 9.7936174, "gravity_sigma_m_s2": 1e-9},
        "table": {
            "name": "three-axis",
            "heading_deg": 25,
            "position_sigma_arcsec": ARCSECONDS,
            "angle_sigma_arcsec": ARCSECONDS,
        },
        "log": "session.asc",
        "plan": PLANS[plan],
    }
