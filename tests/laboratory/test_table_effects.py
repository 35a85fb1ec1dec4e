"""Tables, sites and clocks that are not as the campaign says, against numbers reckoned by hand."""

from collections.abc import Callable
from math import cos, radians, sin
from typing import Any

import numpy as np
import pytest

from laboratory import LogTruth, Recording, SpecificationError, perform, specify

Performed = Callable[..., Recording]
Document = dict[str, Any]

GRAVITY, ARCSECOND, EARTH = 9.7936174, radians(1 / 3600), 7.292115e-5
LATITUDE, UP = radians(30.5278), 7.292115e-5 * sin(radians(30.5278))
REST = {"id": "still", "do": "rest", "up": "+z", "mark": "+x", "seconds": 10}  # x north, y west
TURN = {"id": "turn", "do": "turn", "up": "+z", "mark": "+x", "degrees": 360} | {
    "rate_deg_s": 40,
    "accel_deg_s2": 40,
}
TUMBLE = {"id": "over", "do": "tumble", "up": "+z", "mark": "+x", "about": "+x"} | {
    "step_degrees": 60,
    "steps": 6,
    "and_back": True,
    "seconds": 2,
}
ALSO = {"handling": {"still_s": 1, "step": {"rate_deg_s": 60, "accel_deg_s2": 120}}}


def truth_of(performed: Performed, move: Document, effects: Document | None = None) -> LogTruth:
    """What truly happened in the only log."""
    return performed(move, effects=effects, also=ALSO).truth["all.asc"]


def turned(truth: LogTruth) -> Any:
    """The angle about z at the end of every sample of a turn, the earth's part taken out, rad."""
    return np.cumsum(truth.rate[:, 2] - UP) * 0.01


@pytest.mark.parametrize("degrees", [360, -360])
def test_a_table_that_is_too_fast_turns_by_the_right_angle(
    performed: Performed, degrees: float
) -> None:
    """100 ppm of the rate and 1000 ppm of the ramps; 10 s become shorter, the angle does not."""
    effects = {"table_speed_error": {"rate_ppm": 100, "ramp_ppm": 1000}}
    truth = truth_of(performed, TURN | {"degrees": degrees}, effects)
    rate = truth.rate[:, 2] - UP
    assert rate[220:980] == pytest.approx(np.sign(degrees) * radians(40) * 1.0001, rel=1e-12)
    assert turned(truth)[-1] == pytest.approx(radians(degrees), abs=1e-12)
    spin_up = np.diff(rate)[110:180] / 0.01
    assert spin_up == pytest.approx(np.sign(degrees) * radians(40) * 1.001, rel=1e-9)


def test_a_steady_turn_is_too_fast_as_well(performed: Performed) -> None:
    move = TURN | {"recorded": "steady"}
    del move["accel_deg_s2"]
    for name, parameters in (
        ("table_speed_error", {"rate_ppm": 250}),
        ("table_angle_scale", {"scale_ppm": 250}),
    ):
        truth = truth_of(performed, move, {name: parameters})
        assert truth.rate[:, 2] - UP == pytest.approx(radians(40) * 1.00025, rel=1e-12)


def test_a_turn_that_takes_longer_than_there_is_rest_behind_it_is_refused(
    ideal: Callable[..., Document],
) -> None:
    document = ideal(TURN, effects={"table_speed_error": {"rate_ppm": -9000}})
    document["handling"] = {"still_s": 0.05}
    with pytest.raises(
        SpecificationError, match=r"handling.still_s: found 0.05; expected at least"
    ):
        specify(document)


def test_degrees_that_are_too_large(performed: Performed) -> None:
    """400 ppm: 360.144°, in the same time; and a tumble's rest at 300° stands at 300.12°."""
    effects = {"table_angle_scale": {"scale_ppm": 400}}
    right, wrong = (turned(truth_of(performed, TURN, own)) for own in ({}, effects))
    assert wrong[-1] == pytest.approx(radians(360.144))
    assert wrong == pytest.approx(1.0004 * right, rel=1e-9)
    for degrees, force in rests(truth_of(performed, TUMBLE, effects)):
        assert force == pytest.approx(on_edge(degrees * 1.0004), abs=1e-9)


def rests(truth: LogTruth) -> list[tuple[int, Any]]:
    """Set angle, and the mean force, (3,), of every rest of the tumble."""
    return [
        (60 * int(name[-2:]), truth.force[rows.start : rows.stop].mean(axis=0))
        for name, rows in truth.rows.items()
    ]


def on_edge(degrees: float) -> Any:
    """The force on a case that has turned about x by so much from z up."""
    angle = radians(degrees)
    return [0, GRAVITY * sin(angle), GRAVITY * cos(angle)]


@pytest.mark.parametrize(
    ("name", "parameters", "error"),
    [
        (
            "table_eccentricity",
            {"sin_arcsec": 30, "cos_arcsec": -20},
            lambda a: 30 * np.sin(a) - 20 * (np.cos(a) - 1),
        ),
        ("table_ripple", {"order": 36, "amplitude_arcsec": 5}, lambda a: 5 * np.sin(36 * a)),
        (
            "table_ripple",
            {"order": 7.25, "amplitude_arcsec": 5, "phase_deg": 90},
            lambda a: 5 * (np.cos(7.25 * a) - 1),
        ),
    ],
)
def test_the_table_is_where_its_scale_does_not_say(
    performed: Performed, name: str, parameters: Document, error: Callable[[Any], Any]
) -> None:
    """At the end of every sample of a turn, and at every rest of a tumble."""
    effects = {name: parameters}
    scale = turned(truth_of(performed, TURN))
    true = turned(truth_of(performed, TURN, effects))
    assert (true - scale) / ARCSECOND == pytest.approx(error(scale), abs=1e-6)
    for degrees, force in rests(truth_of(performed, TUMBLE, effects)):
        off = error(radians(degrees)) / 3600
        assert force == pytest.approx(on_edge(degrees + off), abs=1e-9)


def test_a_ripple_is_a_rate_that_comes_and_goes_with_the_teeth(performed: Performed) -> None:
    """5″ 36 times in a revolution of 9 s: an amplitude of 180″ × 40°/s, a hertz times 4."""
    effects = {"table_ripple": {"order": 36, "amplitude_arcsec": 5}}
    rung = truth_of(performed, TURN, effects).rate - truth_of(performed, TURN).rate
    steady = rung[200:900, 2]  # 7 s
    spectrum = np.abs(np.fft.rfft(steady)) * 2 / len(steady)
    assert int(np.argmax(spectrum)) == 4 * 7
    expected = 180 * ARCSECOND * radians(40) * np.sinc(4 * 0.01)
    assert spectrum[28] == pytest.approx(expected, rel=1e-4)


WOBBLE = {"table_wobble": {"east_arcsec": 8, "north_arcsec": 12}}


def wobbled(angle: Any) -> tuple[Any, Any]:
    """Lean towards east and north, ″: (8, 12) turned twice as far as the table."""
    return (
        8 * np.cos(2 * angle) - 12 * np.sin(2 * angle),
        12 * np.cos(2 * angle) + 8 * np.sin(2 * angle),
    )


def test_an_axis_that_wobbles_leans_in_the_room(performed: Performed) -> None:
    """Gravity, turned back into the room, falls behind the axis; the gyros feel it lean."""
    truth = truth_of(performed, TURN, WOBBLE)
    middle = turned(truth) - 0.005 * (truth.rate[:, 2] - UP)
    north = -(truth.force[:, 0] * np.cos(middle) - truth.force[:, 1] * np.sin(middle)) / GRAVITY
    west = -(truth.force[:, 0] * np.sin(middle) + truth.force[:, 1] * np.cos(middle)) / GRAVITY
    to_east, to_north = wobbled(middle)
    assert north / ARCSECOND == pytest.approx(to_north, abs=5e-3)
    assert -west / ARCSECOND == pytest.approx(to_east, abs=5e-3)
    # As north leans, the case turns about the east axis the other way.
    felt = truth.rate - truth_of(performed, TURN).rate
    about_west = felt[:, 0] * np.sin(middle) + felt[:, 1] * np.cos(middle)
    expected = (16 * np.cos(2 * middle) - 24 * np.sin(2 * middle)) * ARCSECOND * radians(40)
    assert about_west[200:900] == pytest.approx(expected[200:900], abs=1e-7)


def test_a_turn_on_its_head_wobbles_in_the_sense_of_the_table(performed: Performed) -> None:
    """About −z by +360°: clockwise from above, and so does the lean, twice."""
    truth = truth_of(performed, TURN | {"about": "-z"}, WOBBLE)
    back = turned(truth) - 0.005 * (truth.rate[:, 2] - UP)
    north = -(truth.force[:, 0] * np.cos(back) - truth.force[:, 1] * np.sin(back)) / GRAVITY
    assert north / ARCSECOND == pytest.approx(wobbled(back)[1], abs=5e-3)
    assert back[-1] == pytest.approx(-radians(360), abs=1e-3)


def test_a_rest_leans_as_the_start_of_a_turn(performed: Performed) -> None:
    force = truth_of(performed, REST, WOBBLE).force.mean(axis=0) / GRAVITY / ARCSECOND
    assert force[:2] == pytest.approx([-12, 8], abs=1e-3)  # x points north, y west


def test_a_tumble_about_an_axis_that_wobbles(performed: Performed) -> None:
    """x is level and north; as up becomes north, north becomes down: x leans down."""
    for degrees, force in rests(truth_of(performed, TUMBLE, WOBBLE)):
        lean = wobbled(radians(degrees))[1]
        assert force[0] / GRAVITY / ARCSECOND == pytest.approx(-lean, abs=1e-3)


def test_the_rests_of_a_tumble_fall_short_on_both_ways(performed: Performed) -> None:
    effects = {"table_position_error": {"sigma_arcsec": 0, "backlash_arcsec": 40}}
    for position in ({}, {"position": "edge"}):
        truth = truth_of(performed, TUMBLE | position, effects)
        assert len(truth.rows) == 12
        for (name, _), (degrees, force) in zip(truth.rows.items(), rests(truth), strict=True):
            short = 20 / 3600 if "back" in name else -20 / 3600
            assert force == pytest.approx(on_edge(degrees + short), abs=1e-9)


def test_positions_are_off_by_chance_beside_what_the_campaign_says(
    ideal: Callable[..., Document],
) -> None:
    """200 positions, two tilts each: chi-squared with 400 degrees of freedom, 5 sigma 1 ± 0.35."""
    plan = [REST | {"id": f"p{k}", "seconds": 0.1, "log": f"{k}"} for k in range(200)]
    effects = {"table_position_error": {"sigma_arcsec": 30}}
    placements = perform(specify(ideal(*plan, effects=effects))).placements
    tilts = np.array([p.attitude.T @ [0, 0, 1] for p in placements.values()])[:, :2]
    assert 0.65 < np.sum((tilts / (30 * ARCSECOND)) ** 2) / 400 < 1.35


def test_both_ways_of_a_tumble_share_the_error_of_a_named_position(
    ideal: Callable[..., Document],
) -> None:
    effects = {"table_position_error": {"sigma_arcsec": 30}}
    for position, same in (({}, False), ({"position": "edge"}, True)):
        document = ideal(TUMBLE | position, effects=effects, also=ALSO)
        force = {}
        truth = perform(specify(document)).truth["all.asc"]
        for name, rows in truth.rows.items():
            force[name] = truth.force[rows.start : rows.stop].mean(axis=0)
        off = force["over-03"] - force["over-back-03"]
        assert (float(np.abs(off).max()) < 1e-12) is same


@pytest.mark.parametrize(
    ("up", "expected"),
    [("+z", [0, 0]), ("+x", [-1, 0]), ("-x", [1, 0]), ("+y", [0, 1]), ("-y", [0, -1])],
)
def test_faces_that_a_leaning_axis_brings_up(
    performed: Performed, up: str, expected: list[float]
) -> None:
    """From z to x up it goes about −y, which leans up by 30″, so that y reads −30″ of gravity."""
    effects = {"table_axis_non_orthogonality": {"lean_arcsec": 30}}
    mark = "+z" if up != "+z" else "+x"
    truth = truth_of(performed, REST | {"up": up, "mark": mark}, effects)
    y, x = expected
    level = np.array([x, y, 0.0])
    force = truth.force.mean(axis=0) / GRAVITY / ARCSECOND
    force["xyz".index(up[1])] = 0
    assert force == pytest.approx(30 * level, abs=0.01)


def test_a_quarter_turn_that_is_too_large(performed: Performed) -> None:
    """From z to x up about −y by 90° and 20″: z, which should be level, has gone down 20″."""
    parameters = {"lean_arcsec": 0, "quarter_arcsec": 20}
    effects = {"table_axis_non_orthogonality": parameters}
    force = truth_of(performed, REST | {"up": "+x", "mark": "+z"}, effects).force.mean(axis=0)
    assert force[2] / GRAVITY / ARCSECOND == pytest.approx(-20, abs=1e-3)
    assert force[1] == pytest.approx(0, abs=1e-9)


def test_a_tumble_about_the_leaning_axis(performed: Performed) -> None:
    """−x, the end away from the mark, is level where z is up and rises by 60″ where it is down."""
    effects = {"table_axis_non_orthogonality": {"lean_arcsec": 30}}
    for degrees, force in rests(truth_of(performed, TUMBLE, effects)):
        lean = 30 * (1 - cos(radians(degrees)))
        assert force[0] / GRAVITY / ARCSECOND == pytest.approx(-lean, abs=0.01)
        assert force[1:] == pytest.approx(on_edge(degrees)[1:], abs=1e-6)  # (60″)² g


def test_an_inner_axis_that_leans_stays_the_axis_of_its_turns(performed: Performed) -> None:
    """It leans south, away from the mark; the case on it reads gravity towards north."""
    truth = truth_of(performed, TURN, {"table_inner_axis": {"lean_arcsec": 60}})
    angle = turned(truth) - 0.005 * (truth.rate[:, 2] - UP)
    north = np.array([np.cos(angle), -np.sin(angle)]).T
    np.testing.assert_allclose(
        truth.force[:, :2] / GRAVITY / ARCSECOND, 60 * north, rtol=0, atol=0.05
    )
    earth = EARTH * cos(LATITUDE) * north
    np.testing.assert_allclose(
        truth.rate[:, :2], earth, rtol=0, atol=6e-8
    )  # of 60″ × 40 °/s = 2e-4


def test_a_turn_about_another_axis_than_the_inner_one_shows_the_gyros_the_lean(
    performed: Performed,
) -> None:
    """About y, level to the west: the inner axis leans towards the middle one, which is y's end."""
    move = TURN | {"up": "+x", "mark": "+y", "about": "+y"}
    off, right = (
        truth_of(performed, move, {"table_inner_axis": {"lean_arcsec": lean}}).rate[400:600]
        for lean in (60, 0)
    )
    assert (off - right)[:, 2] / radians(40) / ARCSECOND == pytest.approx(-60, abs=0.03)


NORTH = EARTH * cos(LATITUDE)
WORLDS: list[tuple[str, Document, float, list[float]]] = [
    ("gravity_error", {"error_mgal": 50}, GRAVITY + 0.0005, [NORTH, 0, UP]),
    (
        "latitude_error",
        {"error_deg": 1},
        GRAVITY,
        [EARTH * cos(LATITUDE + radians(1)), 0, EARTH * sin(LATITUDE + radians(1))],
    ),
    # the mark points 30° east of north: x towards there, y 30° north of west
    ("heading_error", {"error_deg": 30}, GRAVITY, [NORTH * cos(radians(30)), NORTH / 2, UP]),
    ("earth_rate_omitted", {"share": 1}, GRAVITY, [0, 0, 0]),
    ("earth_rate_omitted", {"share": 0.25}, GRAVITY, [0.75 * NORTH, 0, 0.75 * UP]),
]


@pytest.mark.parametrize(("name", "parameters", "gravity", "rate"), WORLDS)
def test_the_world_is_not_as_the_campaign_says(
    ideal: Callable[..., Document],
    name: str,
    parameters: Document,
    gravity: float,
    rate: list[float],
) -> None:
    recording = perform(specify(ideal(REST, effects={name: parameters})))
    truth = recording.truth["all.asc"]
    assert truth.force.mean(axis=0) == pytest.approx([0, 0, gravity], abs=1e-12)
    assert truth.rate.mean(axis=0) == pytest.approx(rate, abs=1e-16)
    stated = ideal(REST)["campaign"]
    assert recording.campaign == stated | {"simulated": True}


def test_a_heading_error_needs_a_stated_heading(ideal: Callable[..., Document]) -> None:
    document = ideal(REST, effects={"heading_error": {"error_deg": 5}})
    document["campaign"]["table"]["heading_deg"] = None
    with pytest.raises(SpecificationError, match=r"campaign.table.heading_deg: found nothing"):
        specify(document)


def test_a_fast_clock_stretches_everything_but_angles(performed: Performed) -> None:
    """100 ppm: by the stamps, forces and rates are too small; a whole turn is a whole turn."""
    effects = {"clock_scale": {"fast_ppm": 100}}
    truth = truth_of(performed, REST, effects)
    size = 0.05 / 2**15
    by_stamps = truth.accelerometer[:, 2].sum() * size / (len(truth.time) * 0.01)
    assert by_stamps == pytest.approx(GRAVITY / 1.0001, abs=1e-6)
    assert len(truth.time) == 1001  # 10 s last 10.001 s by this clock
    turn = performed(TURN, effects=effects, also=ALSO)
    truth = turn.truth["all.asc"]
    assert np.array_equal(np.diff(turn.records["all.asc"].stamps), [10_000_000] * 1200)
    angle = truth.gyro[:, 2].sum() * 0.1 / (3600 * 256)
    earth = UP * len(truth.time) * 0.01 / 1.0001
    assert angle == pytest.approx(radians(360) + earth, abs=1.1e-7)
    steady = truth.noiseless.gyro[980, 2] - truth.noiseless.gyro[220, 2]
    assert steady / 7.6 == pytest.approx((radians(40) + UP) / 1.0001, rel=1e-12)


def test_a_clock_that_is_set_moves_stamps_and_nothing_else(performed: Performed) -> None:
    effects = {"clock_step": {"at_s": 4.0, "step_ms": 7}}
    stepped, without = (performed(REST, effects=one) for one in (effects, {}))
    steps = np.diff(stepped.records["all.asc"].stamps)
    assert steps[399] == 17_000_000
    assert np.array_equal(np.delete(steps, 399), [10_000_000] * 998)
    counts = [recording.records["all.asc"].counts for recording in (stepped, without)]
    assert np.array_equal(*counts)


def test_a_table_that_tilts_in_time_is_tilted_as_one_that_always_was(performed: Performed) -> None:
    """From a jump on it is tilted as ever; a ramp is as far after a tenth of an hour, 360 s."""
    tilt = {"north_arcsec": 10, "east_arcsec": -20}
    ramp = {"north_arcsec_h": 100, "east_arcsec_h": -200}
    level, ever, jumped, steadily = (
        np.diff(
            truth_of(performed, {**REST, "seconds": 400}, effects).noiseless.accelerometer, axis=0
        )
        / 0.01
        for effects in (
            {},
            {"table_tilt": tilt},
            {"table_tilt_jump": {**tilt, "at_s": 200.0}},
            {"table_tilt_ramp": ramp},
        )
    )
    assert np.abs(ever - level).max() > 1e-4
    assert jumped[19_990] == pytest.approx(level[19_990], abs=1e-9)
    assert jumped[20_010] == pytest.approx(ever[20_010], abs=1e-9)
    assert steadily[35_999] == pytest.approx(ever[35_999], abs=1e-7)
