"""What the parameter files of the autopilots share: the numbers they take, and what they lose.

Both correct axis by axis, accelerometers by offset and scale factor, gyros by an offset alone.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from stages.exporting import effects
from stages.exporting.calibration import Calibration
from stages.exporting.diagonal import Diagonal, diagonal
from stages.exporting.heading import heading, mounts
from stages.exporting.remainder import cross_terms, scale_errors, told


@dataclass(frozen=True)
class Autopilot:
    """How an autopilot names its parameters, and what its user must know.

    names : accelerometer or gyroscope → offset or scale → the name, {} for X, Y or Z
    """

    name: str
    names: Mapping[str, Mapping[str, str]]
    notes: Sequence[str]


@dataclass(frozen=True)
class Parameters:
    """The paragraphs at the head of a parameter file, and its parameters."""

    head: Sequence[str]
    values: Mapping[str, float]


def parameters(calibration: Calibration, autopilot: Autopilot) -> Parameters:
    """What `autopilot` takes of a calibration; what was not determined is left out."""
    head = list(heading(calibration, autopilot.name))
    if calibration.nothing:
        return Parameters(head, {})
    chosen = [calibration.best(kind) for kind in autopilot.names]
    taken = [
        diagonal(sensors, scaled="scale" in autopilot.names[sensors.kind]) for _, sensors in chosen
    ]
    accelerometer, gyroscope = (sensors for _, sensors in chosen)
    head += [
        *autopilot.notes,
        *mounts(calibration, chosen),
        "",
        f"What this file cannot carry, for {autopilot.name} has no such parameter:",
        f"- cross-axis terms of the accelerometers: {cross_terms(accelerometer)}",
        f"- scale factor errors of the gyros: {scale_errors(gyroscope)}",
        f"- cross-axis terms of the gyros: {cross_terms(gyroscope)}",
        *effects.told(sensors for _, sensors in chosen),
        "- the sigma of every number, their covariance, the noise densities, the temperature",
        "",
        "What this file cannot carry leaves:",
    ]
    values: dict[str, float] = {}
    left_out: dict[str, list[str]] = {}
    for (_, sensors), part in zip(chosen, taken, strict=True):
        names = autopilot.names[sensors.kind]
        head += told(sensors, part.offset, part.scale)
        values |= dict(_values(names, part))
        for (kind, axis), reason in part.left_out.items():
            left_out.setdefault(reason, []).append(names[kind].format(axis.upper()))
    if left_out:
        head += ["", "Left out:"]
        head += [f"- {', '.join(left)}: {reason}" for reason, left in left_out.items()]
    return Parameters(head, values)


def _values(names: Mapping[str, str], part: Diagonal) -> Iterator[tuple[str, float]]:
    for kind, name in names.items():
        for axis, value in part.numbers(kind):
            yield name.format(axis.upper()), value
