"""What an unknown azimuth leaves known: the size of the level earth rate.

Of a position without a known north the level rate has two unknown parts, but their size is that of
the site: (level 0, level 1) = ω_e cos φ (cos a, sin a), with the azimuth a alone unknown. About an
azimuth a₀ that is

    cos a₀ · level 0 + sin a₀ · level 1 = ω_e cos φ

and nothing of the part across. What is left out grows with (a − a₀)²/2, so it is said only where
the data tell the azimuth well, and a₀ is that of the last result; else the parts are those of any
direction, each with the size as its sigma.
"""

from collections.abc import Callable, Mapping

import numpy as np
from numpy.typing import NDArray

from stages.inference.elimination import Name, Part
from stages.inference.rests_and_turns import Earth
from stages.inference.turn_rows import Around

Array = NDArray[np.float64]

KNOWN = 0.2  # rad: with this sigma, what is left out is a tenth of the sigma of the size
EXACT = 1e-4  # relative: to what the size is said
SAID = 1e-3  # relative: how near the size of the parts comes to it then
VAGUE = 1e3  # times the size: sigma of the parts where the size is said of them


def known_azimuths(sigmas: Mapping[Name, float], earth: Earth) -> frozenset[str]:
    """The positions whose azimuth the data tell well, by the sigmas of all unknowns."""
    names = {name for kind, name in sigmas if kind.startswith("level")}
    worst = {name: max(sigmas[f"level {i}", name] for i in (0, 1)) for name in names}
    return frozenset(name for name, sigma in worst.items() if sigma < KNOWN * earth.level)


def said_of(levels: Mapping[Name, float], size: float) -> frozenset[str]:
    """The positions of which a result says the size already: their parts have it."""
    names = {name for kind, name in levels if kind == "level 0" and ("level 1", name) in levels}
    found = {name: np.hypot(levels["level 0", name], levels["level 1", name]) for name in names}
    return frozenset(name for name, length in found.items() if abs(length / size - 1) < SAID)


def sized(
    around: Around, earth: Earth, shared: int, sigma: dict[Name, float]
) -> Callable[[Part], Part]:
    """Adds the size of the level rate to the first part that sees it, for each known azimuth.

    `shared`: the number of shared unknowns; `sigma`: of the errors, where the parts become vague.
    """
    left = {
        name
        for name in around.azimuths
        if ("level 0", name) in sigma and ("level 0", name) in around.levels
    }
    for name in left:
        sigma |= dict.fromkeys((("level 0", name), ("level 1", name)), VAGUE * earth.level)

    def told(part: Part) -> Part:
        names = {name for kind, name in part.own if kind == "level 0"} & left
        for name in names:
            left.remove(name)
            parts = [("level 0", name), ("level 1", name)]
            level = np.array([around.levels[one] for one in parts])
            row = np.zeros((1, part.rows.shape[1]))
            columns = [shared + part.own.index(one) for one in parts]
            row[0, columns] = level / np.linalg.norm(level)
            row[0, -1] = earth.level
            rows = np.vstack([part.rows, row / (EXACT * earth.level)])
            # The azimuth is fitted, so there is one degree of freedom less.
            part = Part(rows, part.own, part.count - 1, part.deviance)
        return part

    return told
