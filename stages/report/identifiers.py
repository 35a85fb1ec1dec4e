"""What the tables still write into one text: mounts, sensors, methods and lists in identifiers.

Nothing else of the report takes a name apart.
"""

from __future__ import annotations

import re

from inertial.campaign.final_result import STAGES
from stages.report.tables import Record

MODEL = "criticism/"  # how the identifiers of findings about the model begin
# As a finding writes a parameter: k1_x = 1.2e-05 ± 3e-07 m/s²/K
PARAMETER = re.compile(r"(\S+) = (\S+)(?: ± (\S+))? (.+)")


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


def beyond_size(sentence: str | None) -> str:
    """What a detection limit says beyond the size: another way of turning, or a longer turn."""
    return (sentence or "").partition(" on. ")[2]


def reason_in(sentence: str | None) -> str:
    """Why an effect is not observable, of the sentence of its detection limit."""
    reason = (sentence or "").partition(": ")[2]
    return reason.removeprefix("not seen, for ").removeprefix("not seen. ")


def beyond_chance(difference: Record) -> bool:
    """Whether a comparison says that a difference is significant."""
    return ": more than chance" in difference["sentence"]


def assumed(known: Record) -> bool:
    """Whether a known quantity is assumed, not stated or computed."""
    return str(known["origin"]).startswith("assumed")


def states_sigmas(action: str) -> bool:
    """Whether an action says at how many sigmas it distinguishes effects."""
    return "sigma" in action


def finding_of_effect(effect: str, mount: str) -> str:
    """The identifier of the finding that names an effect."""
    return f"{MODEL}{at_mount(effect, mount)}"


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


def listed_names(text: str | None) -> list[str]:
    """The names in a list of them: members of a class, effects of a decision."""
    return [name for name in (text or "").split(", ") if name]


def parameters_in(text: str | None) -> list[Record]:
    """The parameters that a finding states in its own words."""
    parameters = []
    for match in map(PARAMETER.fullmatch, (part.strip() for part in (text or "").split("; "))):
        if match is None:
            continue
        name, value, sigma, unit = match.groups()
        try:
            size, scatter = float(value), None if sigma is None else float(sigma)
        except ValueError:
            continue
        parameters.append({"parameter": name, "value": size, "sigma": scatter, "unit": unit})
    return parameters
