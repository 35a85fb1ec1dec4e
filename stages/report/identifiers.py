"""What the tables still write into one text: mounts, sensors, methods and lists in identifiers.

Nothing else of the report takes a name apart.
"""

from __future__ import annotations

from inertial.campaign.final_result import STAGES
from stages.report.tables import Record

MODEL = "criticism/"  # how the identifiers of findings about the model begin


def mount_of(identifier: str) -> str:
    """The mount in an identifier, such as upright of criticism/lever_arm@upright/r_x; or empty."""
    return next((part.partition("@")[2] for part in identifier.split("/") if "@" in part), "")


def method_and_mount(method: str) -> tuple[str, str]:
    """A method and its mount: joint@upright is joint, upright."""
    name, _, mount = method.partition("@")
    return name, mount


def at_mount(name: str, mount: str | None) -> str:
    """A name with the mount it is of, where there are several."""
    return f"{name}@{mount}" if mount else name


def method_of_sensor(row: Record) -> str:
    """What the extension calls the method of the sensor and mount of a row."""
    return at_mount(STAGES[row["sensor"]], row["mount"])


def stage_of(identifier: str) -> str:
    """The stage whose row it is."""
    return identifier.partition("/")[0]


def group_and_parameter(identifier: str) -> tuple[str, str]:
    """gyroscope/joint/bias_x is gyroscope/joint, bias_x."""
    group, _, parameter = identifier.rpartition("/")
    return group, parameter


def stage_and_method(group: str) -> tuple[str, str]:
    """gyroscope/joint@upright is gyroscope, joint@upright."""
    stage, _, method = group.partition("/")
    return stage, method


def kind_and_axes(parameter: str) -> tuple[str, str]:
    """bias_x is bias, x."""
    kind, _, axes = parameter.partition("_")
    return kind, axes


def of_effect(parameter: str) -> bool:
    """Whether a parameter of the extended model is one of an effect, not of the sensor."""
    return "." in parameter


def sensor_and_axis(text: str) -> tuple[str, str]:
    """`gyro x` or gyro_x is gyro, x."""
    sensor, _, axis = text.replace("_", " ").partition(" ")
    return sensor, axis


def beyond_chance(difference: Record) -> bool:
    """Whether a comparison says that a difference is significant."""
    return ": more than chance" in difference["sentence"]


def assumed(known: Record) -> bool:
    """Whether a known quantity is assumed, not stated or computed."""
    return str(known["origin"]).startswith("assumed")


def states_sigmas(action: str) -> bool:
    """Whether an action says at how many sigmas it distinguishes effects."""
    return "sigma" in action


def joint_parameter(stage: str, parameter: str) -> str:
    """The identifier of a parameter of the joint fit."""
    return f"{stage}/joint/{parameter}"


def with_temperature(causes: set[str], finding: Record) -> bool:
    """Whether one of the causes of a finding depends on the temperature, or it is of a sweep."""
    return any(name.endswith("_temperature") for name in causes) or "/temperature/" in finding["id"]


def random_walk(cause: str) -> bool:
    """Whether a cause is a random walk of the biases of a sensor."""
    return cause.endswith("_random_walk")


def file_of(log: str) -> str:
    """The file that a log is a part of: recording.mcap of recording.mcap:/imu."""
    return log.rpartition(":")[0]


def at_rest(phase: str) -> bool:
    """Whether the table is at rest in a phase."""
    return phase.startswith("rest")


def about_model(finding: Record) -> bool:
    """Whether a finding is about the model, not about the recording."""
    return str(finding["id"]).startswith(MODEL)
