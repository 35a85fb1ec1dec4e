"""A law that is proposed as an effect keeps the contract of the catalogue."""

import importlib.util

import pytest
import test_catalogue

from inertial.effects import CATALOGUE, LAWS
from stages.extension.laws import text_of


@pytest.fixture(scope="module")
def motion():
    return test_catalogue.with_a_tumble()


def shaped(name, *shape):
    return LAWS[name].with_constants({f"shape_{i}": v for i, v in enumerate(shape, 1)})


@pytest.mark.parametrize(
    ("name", "shape"),
    [
        ("gyro_y_power_of_time", (3.0,)),
        ("gyro_all_harmonic_of_angle", (2.4,)),
        ("accel_x_polynomial_of_force_y", (3.0,)),
        ("gyro_z_telegraph_of_time", (0.1, 0.3)),
        ("gyro_all_product_of_time_and_rate", ()),
        ("gyro_x_product_of_time_and_temperature", ()),
    ],
)
def test_a_proposed_file_keeps_the_contract_of_the_catalogue(
    name, shape, motion, tmp_path, monkeypatch
):
    file = tmp_path / f"{name}.py"
    file.write_text(text_of(shaped(name, *shape)), encoding="utf-8")
    spec = importlib.util.spec_from_file_location(f"inertial.effects.{name}", file)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    effect = next(one for one in vars(module).values() if getattr(one, "name", None) == name)()
    monkeypatch.setitem(CATALOGUE, name, effect)
    test_catalogue.test_it_introduces_itself(name)
    test_catalogue.test_zero_is_absent(name, motion)
    test_catalogue.test_every_parameter_leaves_a_trace_in_proportion_to_it(name, motion)
    test_catalogue.test_sensor_effects_touch_their_sensor_alone(motion)
