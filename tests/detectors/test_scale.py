"""What a count is worth, gravity, temperature: named where wrong, silent where right."""

from math import radians

import numpy as np
import pytest
from recorded_by_hand import COUNTS, GRAVITY, assert_told, given, log, piece, rest, seen, stamps

from inertial.detectors.stated_against_gravity import GravityError
from inertial.detectors.temperatures import TemperatureDrift, WrongTemperatureUnit
from inertial.detectors.wrong_scale_factor import WrongScaleFactor
from inertial.physics.site import gravity_at, is_refuted, latitude_of
from inertial.signal.scale_factor import explanation_of


def up(reading: float) -> np.ndarray:
    """z up, with a specific force of `reading`."""
    values = rest(1000)
    values[:, 2] += reading - GRAVITY
    return values


@pytest.mark.parametrize("reading", [0.87 * GRAVITY, GRAVITY, 1.13 * GRAVITY])
def test_a_large_bias_is_no_wrong_unit(reading):
    assert not seen(WrongScaleFactor(), piece(up(reading), stamps(1000)))


@pytest.mark.parametrize(
    ("ratio", "said"),
    [
        (9.80665, "the values are in m/s² but are read as g"),
        (1 / 9.80665, "the values are in g but are read as m/s²"),
        (1000 / 9.80665, "the values are in mg but are read as m/s²"),
        (100.0, "the values are in cm/s² (Gal) but are read as m/s²"),
        (2.05, "counts_per_unit is 2 times too small"),
        (0.26, "counts_per_unit is 4 times too large"),
        (16384, "the values are counts, and counts_per_unit is missing"),
        (5.5, "no known unit explains it"),
    ],
)
def test_a_wrong_scale_factor_is_explained(ratio, said):
    one = piece(up(ratio * GRAVITY), stamps(1000))
    (event,) = seen(WrongScaleFactor(), one, recorded_on=None)
    assert event.size == pytest.approx(ratio, rel=1e-3)
    assert said in WrongScaleFactor().describe(event, "log").sentence
    assert (WrongScaleFactor.severity, WrongScaleFactor.sensor) == (3, "accel")


def test_the_quiet_part_of_a_log_is_looked_at():
    values = rest(4000)
    values[1000:3000, :3] += 30 * np.sin(np.arange(2000) / 9)[:, None]
    assert not seen(WrongScaleFactor(), piece(values, stamps(4000)))


def test_without_all_three_accelerometers_nothing_is_said():
    values = rest(1000)
    values[:, 1] = np.nan
    assert not seen(WrongScaleFactor(), piece(values, stamps(1000)))


def test_the_instrument_whose_counts_these_are_is_named():
    """S0 names the iMAR-FSAS; its counts are those of the SPAN-CPT, 180/π times as large."""
    mine = COUNTS["imar-fsas"][1]
    said = explanation_of(1 / 57.29578, "gyro", given(), mine)
    assert "the counts are those of span-cpt or xw-gi7681" in said
    assert "the values are in radians but are read as degrees" in said
    # An instrument with the present one's counts explains nothing.
    assert "instrument" not in explanation_of(2.0, "accel", given(), COUNTS["span-cpt"][0])
    assert "those of" not in explanation_of(57.29578, "accel", given(), COUNTS["span-cpt"][0])
    other = given(count_sizes={**COUNTS, "other": (4.5e-6, 3e-7)})
    one = piece(up(GRAVITY * COUNTS["span-cpt"][0] / 4.5e-6), stamps(1000))
    (event,) = seen(WrongScaleFactor(), one, other)
    assert "the counts are those of other" in event.facts[1]


@pytest.mark.parametrize(
    ("ratio", "said"),
    [
        (57.29578, "the values are in degrees but are read as radians"),
        (2.0, "counts_per_unit is 2 times too small, as of another full scale, or the sample rate"),
        (0.125, "counts_per_unit is 8 times too large"),
        (131.0, "the values are counts"),
    ],
)
def test_what_explains_the_ratio_of_a_turn(ratio, said):
    assert said in explanation_of(ratio, "gyro", given(count_sizes={}))
    assert said in explanation_of(-ratio, "gyro", given(count_sizes={}))


def test_a_ratio_of_no_unit_is_not_explained():
    assert explanation_of(1.3, "gyro", given(count_sizes={})) is None
    assert explanation_of(-1.3, "gyro", given(count_sizes={})) is None


# ---- gravity


def test_a_gravity_that_is_not_of_the_place_is_named():
    told = given(gravity=9.7935882, refuted_gravity=9.80665)
    (event,) = GravityError().detect_in_campaign(told)
    assert_told(GravityError(), event, "")
    assert event.size == pytest.approx(9.80665 - 9.7935882)
    words = GravityError().describe(event, "")
    assert "the size of the unit g" in words.sentence
    assert "off by −1330 ppm" in words.consequence
    assert "Normal gravity is used" in words.action
    (event,) = GravityError().detect_in_campaign(given(gravity=9.80665, refuted_gravity=9.80665))
    assert "The stated value is used" in GravityError().describe(event, "").action
    assert not list(GravityError().detect_in_campaign(given()))


# Normal gravity at 30.53° and 24 m is 9.79359 m/s².
WUHAN = radians(30.5278)


def test_the_unit_g_is_no_gravity_of_wuhan():
    assert is_refuted(9.80665, 5e-5, WUHAN, 24.0)
    assert is_refuted(9.80665, 5e-5, WUHAN, None)  # it stands at no height


@pytest.mark.parametrize("off", [-150, -60, 0, 60, 150])
def test_what_geology_makes_is_no_error(off):
    """Free-air anomalies: 42 mGal rms over the earth."""
    assert not is_refuted(9.79359 + off * 1e-5, 5e-5, WUHAN, 24.0)


def test_with_a_large_sigma_or_on_a_mountain_of_unknown_height_nothing_is_said():
    assert not is_refuted(9.80, 0.02, WUHAN, 24.0)
    assert not is_refuted(9.79359 - 3000 * 3.086e-6, 5e-5, WUHAN, None)  # 0.3086 mGal/m
    assert is_refuted(9.79359 - 3000 * 3.086e-6, 5e-5, WUHAN, 24.0)


def test_the_latitude_of_a_gravity():
    # Helmert's 9.80665 is normal gravity at 45.5° on the ellipsoid of WGS 84.
    assert latitude_of(9.80665, 0.0) == pytest.approx(45.5, abs=0.1)
    assert latitude_of(9.70, 0.0) is None


# ---- temperature


def warming(kelvin: float, n: int = 6000, seed: int = 1) -> np.ndarray:
    """A thermometer with a noise of 0.05 K beside a warming of so many kelvin, (n,), K."""
    noise = 0.05 * np.random.default_rng(seed).standard_normal(n)
    return 295.0 + kelvin * np.linspace(0, 1, n) + noise


@pytest.mark.parametrize("seed", range(10))
def test_an_even_temperature_is_silent(seed):
    one = piece(rest(6000, seed), stamps(6000), temperature=warming(0.5, seed=seed))
    assert not seen(TemperatureDrift(), one)
    assert not seen(TemperatureDrift(), piece(rest(6000, seed), stamps(6000)))


def test_a_warming_is_named_with_what_moves_with_it():
    values, temperature = rest(6000), warming(8.0)
    values[:, 4] += 1e-4 * (temperature - 295.0)
    (event,) = seen(TemperatureDrift(), piece(values, stamps(6000), temperature=temperature))
    assert event.size == pytest.approx(8.0, abs=0.2)
    words = TemperatureDrift().describe(event, "log")
    assert "goes from 21.9 °C to 29.8 °C" in words.sentence
    assert list(event.facts.changes) == [4]
    assert event.facts.changes[4] == pytest.approx(1e-4 * 8.0 * 2 / 3, rel=0.05)


def test_a_cooling_is_told_in_its_order():
    temperature = warming(5.0)[::-1]
    one = piece(rest(6000), stamps(6000), temperature=temperature)
    (event,) = seen(TemperatureDrift(), one)
    assert "goes from 26.8 °C to 21.9 °C" in TemperatureDrift().describe(event, "log").sentence


def test_single_wrong_readings_of_the_thermometer_are_no_drift():
    temperature = warming(0.2, n=60_000)
    temperature[5000:5050] = 400.0
    assert not seen(
        TemperatureDrift(), piece(rest(60_000), stamps(60_000), temperature=temperature)
    )


def test_a_table_of_means_without_time_is_compared_row_by_row():
    temperature = 273.15 + np.linspace(1.4, 65.5, 29)
    one = piece(rest(29), temperature=temperature)
    (event,) = seen(TemperatureDrift(), one)
    assert event.size == pytest.approx(64.1)
    assert "from 1.40 °C to 65.5 °C" in TemperatureDrift().describe(event, "log").sentence


def test_logs_at_different_temperatures_are_one_finding():
    ones = {
        name: piece(rest(2000), stamps(2000), temperature=warming(0.1, 2000) + start)
        for name, start in (("a", 0.0), ("b", 3.0), ("c", 6.0))
    }
    logs = {name: log(one) for name, one in ones.items()}
    (event,) = TemperatureDrift().detect_between_logs(logs)
    assert_told(TemperatureDrift(), event, "")
    assert event.size == pytest.approx(6.1, abs=0.2)
    assert not list(TemperatureDrift().detect_between_logs({"a": logs["a"]}))


@pytest.mark.parametrize("zero", [2048, 32768])
def test_unsigned_counts_are_named_and_no_full_scale(zero):
    """Six channels whose zero stands in the middle of the converter, read as signed counts."""
    count = np.array([GRAVITY / zero * 8] * 3 + [radians(500) / zero] * 3)
    values = rest(1000) + zero * count
    one = piece(values, stamps(1000))
    (event,) = seen(WrongScaleFactor(), one, recorded_on=None, count=count, quantum=count)
    words = WrongScaleFactor().describe(event, "log")
    assert f"the counts are unsigned, with their zero at {zero}" in words.sentence
    assert "full scale" not in words.sentence and f"zero_counts: {zero}" in words.action


def test_an_imu_that_turns_and_falls_has_signed_counts():
    """One channel near the middle of its range is no converter's zero."""
    count = np.array([GRAVITY / 4096] * 3 + [radians(500) / 32768] * 3)
    values = rest(1000)
    values[:, 2] = 32768 * count[2]
    (event,) = seen(WrongScaleFactor(), piece(values, stamps(1000)), recorded_on=None, count=count)
    assert "unsigned" not in WrongScaleFactor().describe(event, "log").sentence


@pytest.mark.parametrize(
    ("temperature", "said"),
    [
        (25.0, "as if in °C where K is stated"),
        (273.15 + 298.0, "as if in K where °C is stated"),
        (298.0, None),
        (230.0, None),
        (1e4, None),
        (273.15 + 149.0, "In °F they are from 65.0 to 65.0 °C"),  # (149 − 32) · 5/9
        (273.15 + 120.0, None),
    ],
)
def test_temperatures_in_the_other_unit(temperature, said):
    one = piece(rest(6000), stamps(6000), temperature=np.full(6000, temperature))
    events = list(seen(WrongTemperatureUnit(), one))
    assert [said in WrongTemperatureUnit().describe(e, "log").sentence for e in events] == (
        [True] if said else []
    )


def test_a_height_that_is_not_stated_has_a_sigma():
    """Free air gradient 0.3086 mGal/m (Heiskanen & Moritz 1967), and 50 mGal of anomalies."""
    value, sigma = gravity_at(radians(48.0), None)
    assert sigma == pytest.approx(np.hypot(1000 * 0.3086e-5, 50e-5), rel=2e-3)
    assert value == pytest.approx(9.80891 - 500 * 0.3086e-5, abs=2e-5)
    assert gravity_at(radians(48.0), 0.0)[1] == 50e-5
    assert is_refuted(9.80665, 2e-5, radians(48.0), None)  # the unit g, not measured
    assert not is_refuted(9.8066, 2e-5, radians(48.0), None)  # 750 m
    assert not is_refuted(9.80665, 0.03, radians(48.0), None)
