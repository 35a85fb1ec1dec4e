"""What is wrong with a campaign, and what a diagnosis must say of it, case by case.

Each case is a campaign of the simulated laboratory: the plan, what is hidden in it and how large,
the causes that are right, and the verdict on each sensor. Nothing else may be said. Sizes of
effects are told by their signal-to-noise ratio, from `tests/hidden/hidden_sizes.py`.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import chain
import numpy as np
from hidden import hidden_plans

Document = dict[str, Any]

LATITUDE, STATED_GRAVITY = 30.5278, 9.7936174  # degrees, m/s²: of the demo's site

USABLE, LIMITS, CONDITION, NOT = "usable", "usable_within_limits", "on_condition", "not_usable"
GOOD = frozenset({USABLE})
LIMITED = frozenset({LIMITS})
HARMLESS = frozenset({USABLE, LIMITS})
CONDITIONAL = frozenset({CONDITION})
LOST = frozenset({NOT})
ANY = frozenset({USABLE, LIMITS, CONDITION, NOT})

# One cause may be told by the name of the repair, of the detector, or of the effect.
GRAVITY = {"gravity", "gravity_error"}
SIGNS = {"signs", "sign_flip", "sign_flip_against_plan"}
AXES = {"axes", "axis_swap", "axis_swap_against_plan"}
COUNTS = {"count_size", "wrong_scale_factor", "wrong_scale_of_turns"}
SENSE = {"sense_of_table", "wrong_direction"}
EXCHANGED = {"exchanged_manoeuvres", "manoeuvre_swapped"}
STATED_RATE = {"stated_rate", "rate_off"}
CLOCK = {"clock_scale", "stated_rate", "rate_off"}
POSITION = {"table_position_error", "position_outlier", "position_off"}
ANGLE = {"turn_angle_error", "turn_angle", "incomplete_turn", "wrong_angle", "turn_off"}
IMPACT = {"impact", "knock", "table_moving", "spike"}
PER_LOG = {
    "bias_per_log",
    "gyro_bias_per_log",
    "turn_on_bias",
    "bias_of_each_run",
    "gyro_bias_jump",
}


@dataclass(frozen=True)
class Cause:
    """One row that must be there.

    `names`: any of them is right as the cause of a row, or as a member of its class; `alone`:
    whether it must be found alone (True), in a class (False), or either; `count`: what the row
    stands for. What is None may be anything.
    """

    names: frozenset[str]
    sensor: str | None = None
    axis: str | None = None
    manoeuvre: str | None = None
    alone: bool | None = None
    count: int | None = None
    most_moves: float | None = None


def cause(names: Collection[str], *where: str | None, **more: Any) -> Cause:
    return Cause(frozenset(names), *where, **more)


@dataclass(frozen=True)
class Case:
    """A campaign: `plan` makes its document, `hidden` what is wrong with it.

    `causes`: every row that must be there; `accel`, `gyro`: the verdicts that are right; `known`:
    whether the 24 parameters are those that the laboratory put in, or take up what is hidden.
    """

    name: str
    plan: Callable[..., Document]
    causes: Sequence[Cause]
    accel: frozenset[str] = GOOD
    gyro: frozenset[str] = GOOD
    hidden: Mapping[str, Any] = field(default_factory=dict)
    known: bool = True
    seed: int = 1801

    def document(self) -> Document:
        """What the laboratory is told."""
        return merged(self.plan(seed=self.seed), self.hidden)


def merged(document: Document, changes: Mapping[str, Any]) -> Document:
    """A document with changes of single keys; a plan is changed by the id of its manoeuvres."""
    result = dict(document)
    for key, value in changes.items():
        if key == "plan" and isinstance(value, Mapping):
            result[key] = [merged(one, value.get(one["id"], {})) for one in document[key]]
        elif isinstance(value, Mapping) and isinstance(document.get(key), Mapping):
            result[key] = merged(document[key], value)
        else:
            result[key] = value
    return result


# ---- plans


def positions(**changes: Any) -> Document:
    """The demo's plan: six rests of 300 s, six turns at 10 °/s, a log each; 214,800 samples."""
    return hidden_plans.positions(**changes)


def rates(**changes: Any) -> Document:
    """Turns at 20, 40, 80 °/s and tumbles in one log of columns; 142,565 samples."""
    return hidden_plans.rates(**changes)


def short(**changes: Any) -> Document:
    """Six rests of 20 s, six turns at 60 °/s, a log each; 19,800 samples."""
    return chain.short(**changes)


def there_and_back(**changes: Any) -> Document:
    """From six positions there and back, up at 6 °/s, down at 12 °/s, rests of 30 s; heading."""
    document = hidden_plans.stops(**changes)
    for one in document["campaign"]["plan"]:
        if one["do"] == "rest":
            one["seconds"] = 30
        else:
            one["rate_deg_s"] = one["accel_deg_s2"] = one["rate_deg_s"] / 2
    return document


def without_heading(**changes: Any) -> Document:
    """The same, the azimuth of no position being stated."""
    document = there_and_back(**changes)
    document["campaign"]["table"]["heading_deg"] = None
    for one in document["campaign"]["plan"]:
        one.pop("mark", None)
    return document


def one_attitude_each(**changes: Any) -> Document:
    """Three turns about the vertical, each gyro in one attitude only, a log each.

    The logs have no common clock, so nothing tells that they are of one run of the instrument.
    """
    document = chain.short(**changes)
    document["start"]["pause_s"] = 86_400.0
    document["handling"]["still_s"] = 20
    document["receiver"] |= {"message": "columns", "line_end": "lf"}
    document["campaign"]["instrument"] = {"name": "simulated", "rate_hz": 100}
    document["campaign"]["plan"] = [
        {"id": f"{axis}-turn", "do": "turn", "up": f"+{axis}", "log": f"{axis}.csv"}
        | {"degrees": 720, "rate_deg_s": 20, "accel_deg_s2": 20}
        for axis in "xyz"
    ]
    return document


def brief(**changes: Any) -> Document:
    """As `short`, and of the rest with x up only half a second is recorded, as in a real log."""
    document = chain.short(**changes)
    document["campaign"]["plan"][0]["seconds"] = 0.5
    return document


def unstated_gravity(**changes: Any) -> Document:
    """As `short`; gravity is that of the formula, which knows no local anomaly."""
    document = chain.short(**changes)
    document["campaign"]["site"] = {"latitude_deg": 30.5278, "height_m": 24}
    return document


PLAIN = short()["campaign"]["plan"]
LOGS = tuple(one["log"] for one in PLAIN)
TURNS = tuple(one["id"] for one in PLAIN if one["do"] == "turn")


# ---- what is hidden


def effect(**hidden: Any) -> Document:
    return {"effects": hidden}


def elsewhere(degrees: float, **hidden: Any) -> Document:
    """A latitude that is stated so much too small, and with it the gravity of the site.

    Gravity by the international formula of 1980, at the stated latitude as stated.
    """
    gravity = [
        9.780327 * (1 + 0.0053024 * np.sin(phi) ** 2 - 5.8e-6 * np.sin(2 * phi) ** 2)
        for phi in np.radians([LATITUDE, LATITUDE + degrees])
    ]
    true = STATED_GRAVITY + float(gravity[1] - gravity[0])
    return {
        **effect(latitude_error={"error_deg": degrees}, **hidden),
        "truth": {"gravity_m_s2": true},
    }


def fault(*faults: Mapping[str, Any]) -> Document:
    return {"faults": list(faults)}


def flipped(sensor: str, axes: str) -> Document:
    return fault(*({"flip": {"log": "all", "sensor": sensor, "axis": axis}} for axis in axes))


def stated(**said: Any) -> Document:
    return {"misstated": said}


def of_counts(gyro: float) -> Document:
    """The demo's instrument, its counts stated, rad: with a range that is as wide as theirs."""
    return {
        "name": "another",
        "rate_hz": 100,
        "axes": ["z", "-y", "x"],
        "format": {"kind": "rawimus"},
        "gyro": {"count_rad": float(gyro), "full_scale_deg_s": 450},
        "accelerometer": {"count_m_s": 0.05 / 2**15, "full_scale_g": 10},
    }


def turned_the_other_way(document: Document) -> Document:
    """Every turn and every tumble goes the other way than stated."""
    done, said = {}, {}
    for one in document["campaign"]["plan"]:
        if one["do"] == "turn":
            done[one["id"]], said[one["id"]] = (
                {"degrees": sign * one["degrees"]} for sign in (-1, 1)
            )
        elif one["do"] == "tumble":
            about = one["about"]
            done[one["id"]] = {"about": ("-" if about[0] == "+" else "+") + about[1]}
            said[one["id"]] = {"about": about}
    return {"campaign": {"plan": done}, "misstated": {"plan": said}}


def off(axis: str, by: float) -> list[float]:
    """The direction `axis` up, off by an angle, rad, about the next axis but one."""
    sign, place = (1 if axis[0] == "+" else -1), "xyz".index(axis[1])
    up = np.zeros(3)
    up[place], up[(place + 1) % 3] = sign * np.cos(by), np.sin(by)
    return up.tolist()


def set_off(manoeuvre: str, up: str, by: float) -> Document:
    """One position was another one than stated, by an angle, rad."""
    return {
        "campaign": {"plan": {manoeuvre: {"up": off(up, by)}}},
        "misstated": {"plan": {manoeuvre: {"up": up}}},
    }


ARC_SECOND = float(np.radians(1 / 3600))
NORMAL = 9.7936  # m/s², in Wuhan
CLIP = float(np.radians(60))  # rad/s
UPS = tuple(sign + axis for axis in "xyz" for sign in "+-")
GYROS = ("gyro_x", "gyro_y", "gyro_z")
SPIKED = {"lines": [120 + 103 * k for k in range(10)], "channel": "gyro_y", "size_rad_s": 0.6}
KNOCK = {"peak_m_s2": 60.0, "peak_rad_s": 3.0, "frequency_hz": 31.0, "decay_s": 0.08}
COUNT = 0.1 / (3600 * 256)  # rad, of the demo's gyros; taken for seconds of arc, π/180 of it
SWELL = {"channel": "accel_x", "frequency_hz": 1 / 40, "amplitude_m_s2": 5e-4}  # 20 s: half of it
NEAR_G = {"channel": "accel_z", "limit_m_s2": 9.7940}  # within the scatter of z up, 1.07e-3 m/s²

CASES: tuple[Case, ...] = (
    # ---- nothing
    Case("clean-positions", positions, ()),
    Case("clean-rates", rates, ()),
    Case(
        "gravity-by-the-formula", unstated_gravity, (), hidden={"truth": {"gravity_m_s2": 9.7938}}
    ),
    # ---- the statements of the campaign
    Case(
        "gravity-stated",
        short,
        (cause(GRAVITY, "accel"),),
        accel=CONDITIONAL,
        hidden={
            "campaign": {"site": {"gravity_m_s2": 9.8066}},
            "truth": {"gravity_m_s2": NORMAL},
        },
    ),
    Case(
        "latitude-off",
        there_and_back,
        (cause({"latitude_error"}, "gyro"),),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | LIMITED,
        hidden=elsewhere(2.0),
    ),
    Case(
        "latitude-far-off",  # 1 − cos of which is no earth rate left out
        there_and_back,
        (cause({"latitude_error"}, "gyro", alone=True),),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | LIMITED,
        hidden=elsewhere(9.0),
    ),
    Case(
        "latitude-off-without-heading",  # what the gyros tell of the azimuth tells its size
        without_heading,
        (cause({"latitude_error"}, "gyro", alone=True),),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | LIMITED,
        hidden=elsewhere(3.0),
    ),
    Case(
        "heading-off",
        there_and_back,
        (cause({"heading_error"}, "gyro", alone=True),),
        gyro=CONDITIONAL | LIMITED,
        hidden=effect(heading_error={"error_deg": 10.0}),
    ),
    Case(
        "heading-and-latitude-off",  # two turns that do not commute
        there_and_back,
        (cause({"heading_error"}, "gyro"), cause({"latitude_error"}, "gyro")),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | LIMITED,
        hidden=elsewhere(-12.0, heading_error={"error_deg": 12.0}),
    ),
    Case(
        "latitude-off-that-gravity-knows",  # the gravity that was measured is doubted until then
        there_and_back,
        (cause({"latitude_error"}, "gyro"),),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | LIMITED,
        hidden={
            "campaign": {"site": {"latitude_deg": 21.5278}},
            "truth": {"latitude_deg": 30.5278},
        },
    ),
    Case(
        "position-off-by-degrees",
        short,
        (cause(POSITION, "accel", None, "z-down"),),
        accel=LIMITED,
        hidden=set_off("z-down", "-z", 3.0 * 3600 * ARC_SECOND),
    ),
    Case(
        "heading-opposite",
        there_and_back,
        (cause({"heading_error"}, "gyro"),),
        gyro=CONDITIONAL | LIMITED,
        hidden=effect(heading_error={"error_deg": 170.0}),
    ),
    Case(
        "latitude-of-the-other-hemisphere",
        there_and_back,
        (cause({"latitude_sign"}, "gyro"),),
        gyro=CONDITIONAL | LIMITED,
        hidden={"truth": {"latitude_deg": -30.5278}},
    ),
    Case(
        "sense-of-the-table",
        short,
        (cause(SENSE),),
        gyro=CONDITIONAL,
        hidden=turned_the_other_way(short()),
    ),
    Case(
        "stated-sample-rate",
        short,
        (cause(STATED_RATE),),
        accel=HARMLESS | CONDITIONAL,
        gyro=HARMLESS | CONDITIONAL,
        hidden={"receiver": {"rate_hz": 125}},
    ),
    Case(
        "clock-fast",  # or the table slow, which keeps its rate to 100 ppm
        short,
        (cause({"rate_off"}, "gyro"),),
        gyro=LOST,
        hidden=effect(clock_scale={"fast_ppm": 1500}),
        known=False,
    ),
    Case(
        "clock-fast-in-one-log",
        short,
        (cause(CLOCK),),
        accel=LIMITED | CONDITIONAL | LOST,
        gyro=HARMLESS | CONDITIONAL,
        hidden=fault({"drift": {"log": "y-up.asc", "ppm": 1500}}),
    ),
    # ---- the wiring
    Case(
        "sign-of-the-y-gyro",
        short,
        (cause(SIGNS, "gyro", "y"),),
        gyro=CONDITIONAL,
        hidden=flipped("gyro", "y"),
    ),
    Case(
        "signs-of-all-gyros",
        short,
        (cause(SIGNS, "gyro"),),
        gyro=CONDITIONAL,
        hidden=flipped("gyro", "xyz"),
    ),
    Case(
        "signs-of-all-accelerometers",
        short,
        (cause(SIGNS | {"gravity_told"}, "accel"),),
        accel=CONDITIONAL,
        hidden=flipped("accelerometer", "xyz"),
    ),
    Case(
        "count-size-of-the-gyros",
        short,
        (cause(COUNTS, "gyro"),),
        gyro=CONDITIONAL,
        hidden=stated(instrument=of_counts(np.radians(COUNT))),
    ),
    Case(
        "count-size-beyond-the-range",  # the readings are 180/π times too large
        short,
        (cause(COUNTS, "gyro"),),
        gyro=CONDITIONAL,
        hidden=stated(instrument=of_counts(np.degrees(COUNT))),
    ),
    Case(
        "accelerometers-exchanged",
        short,
        (cause(AXES, "accel"),),
        accel=CONDITIONAL,
        hidden=fault({"swap": {"log": "all", "sensor": "accelerometer", "axes": ["x", "y"]}}),
    ),
    Case(
        "gyros-exchanged",
        short,
        (cause(AXES, "gyro"),),
        gyro=CONDITIONAL,
        hidden=fault({"swap": {"log": "all", "sensor": "gyro", "axes": ["y", "z"]}}),
    ),
    # ---- the recording
    Case(
        "positions-logs-exchanged",
        short,
        (cause(EXCHANGED),),
        accel=CONDITIONAL,
        gyro=CONDITIONAL | GOOD,
        hidden=fault({"exchange": {"logs": ["x-up.asc", "y-down.asc"]}}),
    ),
    Case(
        "turns-logs-exchanged",
        short,
        (cause(EXCHANGED),),
        accel=CONDITIONAL | GOOD,
        gyro=CONDITIONAL,
        hidden=fault({"exchange": {"logs": ["x-forward.asc", "z-forward.asc"]}}),
    ),
    Case(
        "spikes-in-all-logs",
        short,
        (cause({"spike"}, "gyro", "y", count=120),),
        gyro=HARMLESS,
        hidden=fault({"spikes": {"log": "all"} | SPIKED}),
    ),
    Case(
        "gap-in-a-turn",
        positions,
        (cause({"gap"}, manoeuvre=None, count=1),),
        accel=HARMLESS,
        gyro=LIMITED,
        hidden=fault({"lose": {"log": "x-forward.asc", "line": 2001, "samples": 640}}),
    ),
    Case(
        "gyros-clip-at-60",
        rates,
        (cause({"saturation", "gyro_saturation"}, "gyro"),),
        gyro=LIMITED,
        hidden=fault(
            *(
                {"clip": {"log": "session.csv", "channel": channel, "limit_rad_s": CLIP}}
                for channel in GYROS
            )
        ),
    ),
    Case(
        "clipping-within-the-noise",
        short,
        (cause({"saturation", "accel_saturation"}, "accel", "z"),),
        accel=LIMITED | LOST,
        hidden=fault({"clip": {"log": "z-up.asc"} | NEAR_G}),
    ),
    Case(
        "impact-in-a-rest",
        short,
        (cause(IMPACT),),
        accel=HARMLESS,
        gyro=HARMLESS,
        hidden=fault({"knock": {"log": "y-up.asc", "line": 900} | KNOCK}),
    ),
    Case(
        "impact-in-a-turn",
        short,
        (cause(IMPACT),),
        accel=HARMLESS,
        gyro=HARMLESS,
        hidden=fault({"knock": {"log": "y-forward.asc", "line": 600} | KNOCK}),
    ),
    Case(
        "one-position-off",
        short,
        (cause(POSITION, "accel", manoeuvre="y-down"),),
        accel=LIMITED,
        hidden=set_off("y-down", "-y", 600 * ARC_SECOND),
    ),
    Case(
        "one-brief-rest-off",
        brief,
        # The first of all: a shift in the fixture after it does the same.
        (cause(POSITION, "accel", manoeuvre="x-up"),),
        accel=LIMITED,
        gyro=HARMLESS | LIMITED,
        hidden=set_off("x-up", "+x", 3600 * ARC_SECOND),
    ),
    Case(
        "one-angle-off",  # with one turn each way, in a class with the scale asymmetry
        short,
        (cause(ANGLE, "gyro"),),
        gyro=LIMITED | LOST,
        hidden={
            "campaign": {"plan": {"y-forward": {"degrees": 358.0}}},
            "misstated": {"plan": {"y-forward": {"degrees": 360}}},
        },
    ),
    Case(
        "bias-of-each-log",
        short,
        # Logs of one clock within minutes are one run, of which this is no law.
        (cause(PER_LOG | {"gyro_random_walk", "unknown_structure"}, "gyro"),),
        gyro=LIMITED | LOST,
        hidden=effect(turn_on_bias={"gyro_deg_h": 4}),
    ),
    Case(
        "one-attitude-each",
        one_attitude_each,
        (cause(PER_LOG | {"gyro_g_sensitivity"}, "gyro", alone=False),),
        accel=ANY,
        gyro=ANY,
        hidden=effect(
            gyro_g_sensitivity={
                "matrix_deg_h_g": [[30.0, 0.0, 12.0], [5.0, -25.0, 0.0], [0.0, 8.0, 28.0]]
            }
        ),
    ),
    # ---- physics
    Case(
        "ripple-of-order-36",
        there_and_back,
        (cause({"table_ripple"}, "gyro", alone=True),),
        gyro=HARMLESS,
        hidden=effect(table_ripple={"order": 36, "amplitude_arcsec": 40}),
    ),
    Case(
        "line-at-20-hz",
        positions,
        (cause({"oscillation"}, "gyro", most_moves=0.5),),
        gyro=HARMLESS,
        hidden=effect(
            oscillation={
                "frequency_hz": 20,
                "amplitude_rad_s": 0.01,
                "axis": "+x",
                "nonlinearity": 0.4,  # a third harmonic of 15 %, seen at 40 Hz
            },
        ),
    ),
    Case(
        "ramp-of-the-y-gyro",
        positions,
        (cause({"gyro_bias_ramp"}, "gyro", "y"),),
        gyro=LIMITED,
        hidden=effect(gyro_bias_ramp={"ramp_deg_h_h": [0.0, 1.24, 0.0]}),  # SNR 9
    ),
    Case(
        "tilt-of-the-table",
        rates,
        (cause({"table_tilt"}),),
        accel=LIMITED,
        gyro=HARMLESS,
        hidden=effect(table_tilt={"north_arcsec": 8.0, "east_arcsec": 0.0}),  # SNR 14
    ),
    Case(
        "imu-turned-in-its-fixture",  # after three of six rests, before all turns
        short,
        (cause({"mounting_shift"}, alone=True),),
        accel=LIMITED,
        gyro=LIMITED,  # its turns are all of the second mounting: the accelerometers tell the first
        hidden=effect(mounting_shift={"rotation_arcsec": [0.0, 0.0, 200.0], "at_s": 180.0}),
    ),
    Case(
        "quadratic-accelerometer",
        positions,
        (cause({"accel_quadratic"}, "accel"),),
        accel=LIMITED,  # the mean over what it may be: one position alone shows it
        hidden=effect(accel_quadratic={"k2_micro_g_g2": [60.0, 0.0, 0.0]}),  # SNR 15
    ),
    Case(
        "swell-as-a-sensor-wanders",  # by half of a reading's scatter in a rest: in the sigmas
        short,
        (),
        hidden=fault({"oscillate": {"log": "all", "line": 1} | SWELL}),
    ),
    # ---- two at once
    Case(
        "sign-and-ramp",
        short,
        (cause(SIGNS, "gyro", "y"), cause({"gyro_bias_ramp"}, "gyro")),
        gyro=CONDITIONAL,
        hidden=flipped("gyro", "y") | effect(gyro_bias_ramp={"ramp_deg_h_h": [20.0, 0.0, 0.0]}),
    ),
    Case(
        "spikes-and-quadratic",
        short,
        (cause({"spike"}, "gyro", "y"), cause({"accel_quadratic"}, "accel")),
        accel=LIMITED,  # as above
        gyro=HARMLESS,
        hidden=fault({"spikes": {"log": "all"} | SPIKED})
        | effect(accel_quadratic={"k2_micro_g_g2": [80.0, 0.0, 0.0]}),
    ),
    Case(
        "the-demo",
        positions,
        (
            cause({"gap"}),
            cause({"oscillation"}, "gyro"),
            cause({"gyro_g_sensitivity"}, "gyro"),
        ),
        accel=HARMLESS,
        gyro=LIMITED,
        hidden=effect(
            oscillation={"frequency_hz": 20, "amplitude_rad_s": 0.01, "axis": "+x"},
            gyro_g_sensitivity={
                "matrix_deg_h_g": [[1.4, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.2]]
            },
        )
        | fault({"lose": {"log": "z-backward.asc", "line": 2193, "samples": 1197}}),
    ),
    Case(
        "rest-not-recorded",
        short,
        (cause({"manoeuvre_missing", "short_rest", "gap"}),),
        accel=ANY,
        gyro=HARMLESS,
        hidden=fault({"lose": {"log": "z-down.asc", "line": 11, "samples": 1980}}),
    ),
)
BY_NAME = {case.name: case for case in CASES}
