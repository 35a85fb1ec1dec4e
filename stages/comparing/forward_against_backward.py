"""Turns forward against turns backward about the same axis."""

from collections.abc import Iterator

from stages.comparing.difference import Difference
from stages.comparing.results import Results
from stages.contracts.tables import AXES
from stages.estimation.noise_levels import NoiseLevels
from stages.estimation.turns import GyroInputs, angles_about
from stages.inference.both_ways import both_ways
from stages.inference.whole_turns import Angle

KIND = "forward_against_backward"
Pair = tuple[tuple[str, Angle], tuple[str, Angle]]


def forward_against_backward(
    inputs: GyroInputs, levels: NoiseLevels, gyro: Results, scatter: float
) -> Iterator[Difference]:
    """The scale factor by each direction alone, pair by pair, the joint bias taken out."""
    for i, axis in enumerate(AXES):
        bias = gyro.determined("joint", f"bias_{axis}")
        pairs = _pairs(angles_about(inputs, i, levels))
        if bias is None:
            continue
        for (forward_name, forward), (backward_name, backward) in pairs:
            found = both_ways(
                forward, backward, bias["value"], bias["sigma"], inputs.earth, scatter
            )
            yield Difference(
                kind=f"{KIND}{gyro.suffix}",
                parameter=f"gyroscope/scale_{axis}",
                unit="1",
                first=forward_name,
                second=backward_name,
                first_value=found.forward,
                second_value=found.backward,
                sigma=found.sigma,
                between=(forward_name, backward_name),
                place=f"{forward_name},{backward_name}" if len(pairs) > 1 else "",
            )


def _pairs(turns: list[tuple[str, Angle]]) -> list[Pair]:
    """Forward turns, each with a backward one of the same angle, the same end of the axis up."""
    pairs: list[Pair] = []
    for up in (1, -1):
        own = [(name, turn) for name, turn in turns if turn.up * up > 0]
        backward = [turn for turn in own if turn[1].angle < 0]
        for turn in own:
            alike = [b for b in backward if abs(b[1].angle + turn[1].angle) < 1e-9]
            if turn[1].angle > 0 and alike:
                backward.remove(alike[0])
                pairs.append((turn, alike[0]))
    return pairs
