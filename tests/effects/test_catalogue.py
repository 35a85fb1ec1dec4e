"""What every effect of the catalogue must do."""

from dataclasses import replace

import numpy as np
import plans
import pytest

from inertial.effects import CATALOGUE
from inertial.physics.effect import Effect
from inertial.physics.forward import predict, sensed, signatures, truth_of
from inertial.physics.motion import Motion
from inertial.sensors import SENSORS
from inertial.tables import CHANNELS
from tests.expressions import value_of

SENSOR_GRADES = {"fog", "tactical", "mti", "consumer"}
OTHER_SIZES = ({"good table", "poor table"}, {"usual"})
WITHOUT_TRACE = {"noise", "quality"}
NOT_AT_LAST = {"zeta"}  # on sides alone, of which none may come after the shift
TRIADS = (plans.SITE, plans.GYRO, plans.ACCELEROMETER)


@pytest.fixture(scope="module")
def motion():
    """Rests and turns up, level, oblique, with all that can be known of them."""
    moved = with_a_tumble()
    return replace(moved, vibration=np.linspace(0.01, 0.02, moved.vibration.size).reshape(-1, 3))


def with_a_tumble() -> Motion:
    """Plan b twice, three oblique rests, each of a tumble, and a turn about a level axis."""
    plan = plans.plan_b(2)
    tumbled = {}
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        tumbled[len(plan.manoeuvres)] = np.arctan2(0.6, 0.8) * np.eye(3)[k]
        plan.rest(0.6 * np.eye(3)[i] + 0.8 * np.eye(3)[j], np.eye(3)[k], 60)
    plan.turn(np.eye(3)[2], np.eye(3)[1], np.eye(3)[0], 90, 20, 20)
    motion = plan.campaign().motion
    turned = [tumbled.get(visit, np.zeros(3)) for visit in motion.visit]
    return replace(motion, tumbled=np.array(turned))


@pytest.mark.parametrize("name", CATALOGUE)
def test_it_introduces_itself(name):
    effect = CATALOGUE[name]
    of_axis = (f"_{effect.parameters[0].name[-1]}",) if name.startswith("gyro_dead_band") else ("",)
    module = type(effect).__module__.rpartition(".")[2]
    of_sensor = module if name.endswith(f"_{module}") else ""  # one module for both sensors
    assert name in {module + axis for axis in of_axis} or name in {
        f"{sensor}_{of_sensor}" for sensor in SENSORS
    }
    assert effect.name == name
    assert effect.cause and effect.source and type(effect).__doc__
    assert all(p.unit and p.meaning and p.typical > 0 for p in effect.parameters)
    assert set(effect.sizes) == SENSOR_GRADES or set(effect.sizes) in OTHER_SIZES
    assert all(size > 0 for size in effect.sizes.values())
    assert effect.sought_in in {"blocks", "spectrum", "noise", "quality"}
    assert bool(effect.finding) == (effect.sought_in == "quality")


@pytest.mark.parametrize("name", CATALOGUE)
def test_zero_is_absent(name, motion):
    plain = predict(motion, *TRIADS)
    for effect in (CATALOGUE[name], *CATALOGUE[name].candidates(motion)):
        zero = {effect.label: np.zeros(len(effect.parameters))}
        read = predict(motion, *TRIADS, [effect], zero)
        np.testing.assert_array_equal(read.gyro, plain.gyro)
        np.testing.assert_array_equal(read.accel, plain.accel)


@pytest.mark.parametrize("name", CATALOGUE)
def test_every_parameter_leaves_a_trace_in_proportion_to_it(name, motion):
    plain = predict(motion, *TRIADS)
    for effect in CATALOGUE[name].candidates(motion):
        (trace,) = signatures(motion, *TRIADS, [effect])
        if effect.sought_in in WITHOUT_TRACE or effect.name == "oscillation":
            assert not trace.gyro.any() and not trace.accel.any()
            continue
        for i, parameter in enumerate(effect.parameters):
            values = np.zeros(len(effect.parameters))
            values[i] = 0.1 * parameter.typical
            read = predict(motion, *TRIADS, [effect], {effect.label: values})
            change = np.hstack([read.gyro - plain.gyro, read.accel - plain.accel])
            told = values[i] * np.hstack([trace.gyro[:, :, i], trace.accel[:, :, i]])
            assert np.abs(told).max() > 0 or parameter.name in NOT_AT_LAST, parameter.name
            # An effect on both sensors is compared in each: their units differ.
            for part in (slice(0, 3), slice(3, 6)):
                bar = 1e-3 * np.abs(told[:, part]).max() + 1e-13
                assert np.abs(change[:, part] - told[:, part]).max() < bar, parameter.name


def test_sensor_effects_touch_their_sensor_alone(motion):
    for effect in CATALOGUE.values():
        (trace,) = signatures(motion, *TRIADS, [effect])
        if effect.name.startswith("gyro"):
            assert not trace.accel.any(), effect.name
        if effect.name.startswith("accel") or effect.name in {"size_effect", "lever_arm"}:
            assert not trace.gyro.any(), effect.name


def test_what_is_scanned_has_candidates_of_its_own(motion):
    scanned = [effect for effect in CATALOGUE.values() if effect.scan]
    assert {e.name for e in scanned} == {
        "gyro_warm_up", "gyro_bias_jump", "gyro_scale_jump",
        "gyro_dead_band_x", "gyro_dead_band_y", "gyro_dead_band_z",
        "gyro_relaxation", "gyro_relaxation_sense", "gyro_relaxation_braking",
        "accel_warm_up", "accel_bias_jump", "accel_scale_jump",
        "table_ripple", "table_position_error", "table_axis_error",
        "turn_angle_error", "mounting_shift", "mounting_slip", "table_tilt_jump",
        "table_zero_shift", "table_zero_shift_outer",
        "gyro_bias_of_position", "accel_bias_of_position",
    }  # fmt: skip
    for effect in CATALOGUE.values():
        candidates = effect.candidates(motion)
        assert len({one.label for one in candidates}) == len(candidates)
        assert len(candidates) > 1 if effect.scan else candidates == [effect]
        assert all(one.name == effect.name and effect.at is None for one in candidates)


def test_moments_that_a_label_does_not_tell_apart_are_one_candidate():
    """1252.891 s, of an even grid, and 1252.893 s between two positions: columns of one name."""
    jump = CATALOGUE["gyro_bias_jump"]
    assert [one.at for one in jump.at_each([1252.891, 1252.893, 1300.0])] == [1252.893, 1300.0]


def test_a_family_acts_with_the_middle_of_its_candidates(motion):
    for effect in CATALOGUE.values():
        if effect.scan:
            candidates = effect.candidates(motion)
            middle = candidates[len(candidates) // 2]
            family, one = signatures(motion, *TRIADS, [effect, middle])
            np.testing.assert_array_equal(family.gyro, one.gyro)
            np.testing.assert_array_equal(family.accel, one.accel)


WITHOUT_A_TUMBLE = {"tumble_eccentricity"}
BLIND = {
    "clock": {
        "gyro_bias_ramp", "gyro_scale_ramp", "gyro_warm_up", "gyro_bias_jump", "gyro_scale_jump",
        "accel_bias_ramp", "accel_scale_ramp", "accel_warm_up", "accel_bias_jump",
        "accel_scale_jump",
        "mounting_shift", "mounting_slip", "table_tilt_ramp", "table_tilt_jump",
        "table_zero_shift", "table_zero_shift_outer",
        "gyro_relaxation", "gyro_relaxation_sense", "gyro_relaxation_braking",
    },
    "temperature": {
        "gyro_bias_temperature", "gyro_scale_temperature",
        "accel_bias_temperature", "accel_scale_temperature",
    },
    "heading": {
        "heading_error", "table_tilt", "table_axis_non_orthogonality", "table_inner_axis",
        "table_wobble", "table_tilt_ramp", "table_tilt_jump", "table_zero_shift",
    },
}  # fmt: skip


@pytest.mark.parametrize("lacking", BLIND)
def test_it_says_why_a_campaign_cannot_show_it(lacking):
    campaign = plans.plan_b(2, **{lacking: False}).campaign()
    told = {name: campaign.blind(effect) for name, effect in CATALOGUE.items()}
    assert {name for name, why in told.items() if why} == BLIND[lacking] | WITHOUT_A_TUMBLE
    assert all(why.endswith(".") for why in told.values() if why)
    blind: list[Effect] = [CATALOGUE[name] for name in BLIND[lacking]]
    for trace in signatures(campaign.motion, *TRIADS, blind):
        assert not trace.gyro.any() and not trace.accel.any()


def test_vibration_that_is_not_known_everywhere_tells_nothing(motion):
    effect = CATALOGUE["accel_vibration_rectification"]
    # The turn about a level axis: gravity hides how the table shakes.
    assert effect.blind(with_a_tumble())
    assert not effect.blind(plans.plan_b().campaign().motion)
    half = replace(motion, temperature=np.where(np.arange(len(motion.rate)) % 2, 300.0, np.nan))
    assert CATALOGUE["gyro_bias_temperature"].blind(half) == (
        "The temperature is not recorded everywhere."
    )


def test_nothing_is_blind_where_all_is_known():
    motion = plans.plan_b(2).campaign().motion
    blind = {effect.name for effect in CATALOGUE.values() if effect.blind(motion)}
    assert blind == WITHOUT_A_TUMBLE
    assert not CATALOGUE["tumble_eccentricity"].blind(with_a_tumble())


def test_a_jump_of_scale_factors_needs_every_axis_both_ways_before_it_and_after_it():
    once, twice = (plans.plan_b(times).campaign().motion for times in (1, 2))
    for jump in (CATALOGUE["gyro_scale_jump"], CATALOGUE["accel_scale_jump"]):
        assert jump.blind(once).startswith("There is no time before and after which")
        assert not len(jump.grid(once)) and len(jump.grid(twice)) > 5


def written_out(effect: Effect, motion: Motion, values: np.ndarray) -> np.ndarray:
    """What the terms say as texts, accel and gyro, (n, 6)."""
    truth = truth_of(motion, plans.SITE)
    names = {one.name: one.value for one in effect.constants(motion)} | {
        "t": motion.time,
        "T": motion.temperature,
        **{f"f_{axis}": truth.force[:, i] for i, axis in enumerate("xyz")},
        **{f"w_{axis}": truth.rate[:, i] for i, axis in enumerate("xyz")},
    }
    size = dict(zip([p.name for p in effect.parameters], values, strict=True))
    along = {"gyro": truth.rate @ plans.GYRO.matrix.T}
    along["accel"] = truth.force @ plans.ACCELEROMETER.matrix.T
    added = {channel: np.zeros(len(motion.time)) for channel in CHANNELS}
    for term in effect.terms:
        sensed = along[term.channel.partition("_")[0]]
        own = {f"s_{axis}": sensed[:, i] for i, axis in enumerate("xyz")}
        added[term.channel] += size[term.parameter] * value_of(term.factor, names | own)
    return np.column_stack([added[channel] for channel in CHANNELS])


@pytest.mark.parametrize("name", [name for name, effect in CATALOGUE.items() if effect.terms])
def test_the_terms_say_in_text_what_is_read(name, motion):
    """So that whoever has the text alone can take the effect out of readings."""
    short = replace(motion, seconds=np.full_like(motion.seconds, 1e-6))  # an instant each
    effect = CATALOGUE[name].with_constants(
        {one.name: one.value for one in CATALOGUE[name].constants(motion)}
    )
    values = np.array([p.typical * (1 + i) for i, p in enumerate(effect.parameters)])
    plain = sensed(truth_of(short, plans.SITE), *TRIADS[1:])
    read = predict(short, *TRIADS, [effect], {effect.label: values})
    change = np.hstack([read.accel - plain.accel, read.gyro - plain.gyro])
    expected = written_out(effect, short, values)
    assert np.abs(change).max() > 0
    np.testing.assert_allclose(change, expected, rtol=1e-6, atol=1e-13)
    assert {term.parameter for term in effect.terms} == {p.name for p in effect.parameters}


@pytest.mark.parametrize("name", ["gyro_warm_up", "accel_warm_up"])
def test_the_terms_of_a_warm_up_after_each_switch_on_say_in_text_what_is_read(name, motion):
    """A motion that knows the switch-ons, and one that the constants tell them, read alike."""
    first, second = np.quantile(motion.time, [0.3, 0.7])
    on = np.select([motion.time > second, motion.time > first], [second, first], 0.0)
    short = replace(motion, seconds=np.full_like(motion.seconds, 1e-6))
    again = replace(short, switched_on=on)
    constants = {one.name: one.value for one in CATALOGUE[name].constants(again)}
    assert [constants["on_1"], constants["on_2"]] == [first, second]
    effect, truth = CATALOGUE[name].with_constants(constants), truth_of(short, plans.SITE)
    plain, values = sensed(truth, *TRIADS[1:]), np.array([1e-5, -2e-5, 3e-5])
    reads = [
        CATALOGUE[name].fixed(constants["tau"]).reads(plain, truth, again, values),
        effect.reads(plain, truth, short, values),
    ]
    known, told = (np.hstack([r.accel - plain.accel, r.gyro - plain.gyro]) for r in reads)
    np.testing.assert_allclose(told, known, rtol=1e-9, atol=1e-18)
    np.testing.assert_allclose(told, written_out(effect, short, values), rtol=1e-6, atol=1e-13)
    restarts = np.exp(-(motion.time - on) / constants["tau"])
    column = 0 if name.startswith("accel") else 3
    np.testing.assert_allclose(told[:, column], values[0] * restarts, rtol=1e-6, atol=1e-13)


def test_what_has_no_terms_says_why_it_stays():
    for effect in CATALOGUE.values():
        assert bool(effect.terms) or effect.stays
        moves = type(effect).moves is not Effect.moves
        assert not (moves and effect.terms)  # what the IMU truly felt is no error of its reading
