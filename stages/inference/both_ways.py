"""A turn forward against a turn backward: does the gyro have one scale factor for both?

    s = (α̃ − b t − ω_e sinφ t) / α − 1,   for each direction by itself

with the bias b of the joint estimate. An asymmetry of the scale factor, and all that adds to a rate
while it turns, makes the two differ.
"""

from dataclasses import dataclass

from stages.inference.whole_turns import Angle, Earth


@dataclass(frozen=True)
class BothWays:
    """The scale factor error that each direction gives, and the sigma of their difference."""

    forward: float
    backward: float
    sigma: float


def both_ways(
    forward: Angle,
    backward: Angle,
    bias: float,
    bias_sigma: float,
    earth: Earth,
    scatter: float = 0.0,
) -> BothWays:
    """Compare two turns about the same axis.

    The difference is c (b_turns − b) with c = t/α forward less t/α backward, where b_turns is the
    bias that the two turns alone would give: an error of b goes into the two scale factors with
    opposite sign. The joint bias b is from data that hold these turns, so the two are correlated:
    its estimate is efficient, and so it gives b_turns the weight σ_b²/σ_turns². Without `scatter`,
    the scatter between manoeuvres that the joint estimate allows for (rad/s), this leaves
    σ² = c² (σ_turns² − σ_b²), after Hausman (1978). The scatter is not counted as noise of the
    turns: it stands for what the model lacks, which is what is sought here.
    """
    scales = [
        (turn.summed - (bias + earth.up * turn.up) * turn.seconds) / turn.angle - 1
        for turn in (forward, backward)
    ]
    noise, offsets = 0.0, 0.0
    for turn in (forward, backward):
        noise += (turn.density**2 * turn.seconds + turn.angle_sigma**2) / turn.angle**2
        offsets += (scatter * turn.seconds / turn.angle) ** 2
    c = forward.seconds / forward.angle - backward.seconds / backward.angle
    of_bias = (c * bias_sigma) ** 2
    shared = of_bias / (noise + offsets) * noise
    of_earth = forward.up * forward.seconds / forward.angle
    of_earth -= backward.up * backward.seconds / backward.angle
    variance = abs(noise + of_bias - 2 * shared) + (of_earth * earth.up_sigma) ** 2
    return BothWays(scales[0], scales[1], float(variance**0.5))
