"""What an oscillation explains of the full-rate residuals of the turns."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from stages.inference.lines import without_line
from stages.model.forward import Triad

Array = NDArray[np.float64]
Row = dict[str, Any]


def gain_of_line(
    turns: Sequence[tuple[str, Array]],
    step_of: Mapping[str, float],
    frequency: float,
    gyro: Triad,
    mount: str,
) -> Iterator[Row]:
    """What it explains about its axis, the axis that is the loudest.

    Held-out: the frequency is that of all turns and the amplitude that of the other turns; only
    the phase is the turn's own, for nothing could foretell it.

    Parameters
    ----------
    turns : name and residuals of the gyros, (n, 3), rad/s; `step_of`: s, of a sample of each
    frequency : Hz
    """
    inverse = np.linalg.inv(gyro.matrix)
    truths = {name: residuals @ inverse.T for name, residuals in turns}
    if not truths:
        return
    spread = np.mean([truth.std(axis=0) for truth in truths.values()], axis=0)
    axis = int(np.argmax(spread))
    parts = {
        name: without_line(truth[:, axis], 1 / step_of[name], frequency)
        for name, truth in truths.items()
    }
    amplitudes = {name: part.amplitude for name, part in parts.items()}
    samples = sum(len(truth) for truth in truths.values())
    before = sum(float(np.sum(part.record**2)) for part in parts.values())
    for scope in ("fitted", "held-out"):
        after = 0.0
        for name, part in parts.items():
            rest = [a for other, a in amplitudes.items() if other != name]
            size = amplitudes[name] if scope == "fitted" or not rest else float(np.mean(rest))
            after += float(np.sum(part.less(size) ** 2))
        yield {
            "sensor": f"gyro {'xyz'[axis]}",
            "mount": mount,
            "effects": "oscillation",
            "scope": scope,
            "rows": samples,
            "before": before / samples,
            "after": after / samples,
            "drop": (before - after) / samples,
            "rms_before": float(np.sqrt(before / samples)),
            "rms_after": float(np.sqrt(after / samples)),
            "unit": "rad/s",
        }
