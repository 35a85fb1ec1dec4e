"""imucal's calibration by Ferraris, on sections of a campaign: M by rows and bias of each triad.

    python -m benchmarks.peers.ferraris <sections.npz> <gravity, m/s²> <samples per second> <runs>

imucal takes one turn about each axis: it is solved with the forward and with the backward ones.
"""

import sys
import warnings

import numpy as np
from imucal import FerrarisSignalRegions, TurntableCalibration

from benchmarks.answering import answer
from benchmarks.timing import timed

REST = {"p": "up", "a": "down"}


def regions(sections, turn):
    """The sections under imucal's names, `turn` being forward or backward."""
    own = {}
    for sensor in ("acc", "gyr"):
        for axis in "xyz":
            own[f"{sensor}_{axis}_rot"] = sections[f"{sensor} {axis}-{turn}"]
            for short, way in REST.items():
                own[f"{sensor}_{axis}_{short}"] = sections[f"{sensor} {axis}-{way}"]
    return FerrarisSignalRegions(**own)


def triads(found):
    """M = K R by rows, and the bias, in m/s² and rad/s."""
    force = [*(found.K_a @ found.R_a).ravel(), *found.b_a]
    turn = [*(found.K_g @ found.R_g).ravel(), *np.radians(found.b_g)]
    return np.array([force, turn])


def solver(sections, turn, angle, gravity, rate):
    """imucal's calibration, ready to be run."""
    method = TurntableCalibration(grav=gravity, expected_angle=angle)
    own, units = regions(sections, turn), {"from_acc_unit": "m/s^2", "from_gyr_unit": "deg/s"}
    return lambda: method.compute(own, rate, **units)


def main(path, gravity, rate, runs):
    """Answer with M and bias by the forward turns and by both, what imucal says, and the times."""
    sections = dict(np.load(path))
    solve = {
        turn: solver(sections, turn, angle, float(gravity), float(rate))
        for turn, angle in (("forward", 720), ("backward", -720))
    }
    with warnings.catch_warnings(record=True) as warned:
        warnings.simplefilter("always")
        seconds = timed(solve["forward"], int(runs))
        forward, backward = (triads(solve[turn]()) for turn in ("forward", "backward"))
    both = (forward + backward) / 2
    answer(
        forward=forward.tolist(),
        both=both.tolist(),
        says=sorted({str(one.message) for one in warned}),
        seconds=seconds.runs,
        cpu=seconds.cpu,
    )


main(*sys.argv[1:])
