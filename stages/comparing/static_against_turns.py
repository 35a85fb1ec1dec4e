"""The gyros at rest against the gyros in turns: S0, tables 5-2 and 5-7."""

from collections.abc import Iterator

import numpy as np

from stages.comparing.difference import Difference
from stages.comparing.results import Results
from stages.contracts.tables import AXES
from stages.estimation.gyro_formulas import uprights
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.turns import GyroInputs, angles_about
from stages.inference.two_positions import two_positions
from stages.inference.whole_turns import known_angle

KIND = "static_against_turns"
UNKNOWN_CROSS = 0.01  # rad, a mounting askew by half a degree: a cross term that no one determined


def static_against_turns(
    inputs: GyroInputs, levels: NoiseLevels, gyro: Results
) -> Iterator[Difference]:
    """Bias and scale factor of each axis from its rests up and down, and from its turns.

    Both sigmas are of noise and of what is known of table and site. The scatter between
    manoeuvres that the joint estimate may allow for is left out: it stands for what the model
    lacks, and that is what differs here.
    """
    for i, axis in enumerate(AXES):
        rests = list(uprights(inputs, i))
        static = two_positions(
            [rest for _, rest in rests], _cross(gyro, axis), inputs.earth, inputs.position_sigma
        )
        if static is None or gyro.determined("turns", f"bias_{axis}") is None:
            continue
        turns = known_angle([turn for _, turn in angles_about(inputs, i, levels)], inputs.earth)
        found = {
            "bias": (static.bias, static.bias_sigma, 0, "rad/s"),
            "scale": (static.scale, static.scale_sigma, 1, "1"),
        }
        for name, (value, sigma, column, unit) in found.items():
            if value is None or sigma is None:
                continue
            yield Difference(
                kind=f"{KIND}{gyro.suffix}",
                parameter=f"gyroscope/{name}_{axis}",
                unit=unit,
                first=f"rests with {axis} up and {axis} down: {', '.join(n for n, _ in rests)}",
                second=f"gyroscope/turns{gyro.suffix}/{name}_{axis}",
                first_value=value,
                second_value=float(turns.values[column]),
                sigma=float(np.hypot(sigma, turns.sigma[column])),
                between=("rests", "turns"),
            )


def _cross(gyro: Results, axis: str) -> np.ndarray[tuple[int], np.dtype[np.float64]]:
    """What a gyro senses of rates along x, y, z besides its own axis, (3,)."""
    rows = [gyro.of("joint", f"cross_{axis}{other}") for other in AXES]
    values = [
        UNKNOWN_CROSS if row is None or row["value"] is None else row["value"] for row in rows
    ]
    return np.where([other == axis for other in AXES], 0.0, np.array(values, dtype=np.float64))
