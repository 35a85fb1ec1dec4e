"""Random numbers of the laboratory, all from the seed of a campaign.

Each purpose ("table_tilt", "x-up") has a stream of its own, so that another effect or another log
does not change the noise of the others: two campaigns that differ in an effect differ in nothing
else.
"""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Chance:
    """The source of all random numbers of one campaign."""

    seed: int

    def stream(self, *purpose: str) -> np.random.Generator:
        """The random numbers for one purpose: the same at every call."""
        words = [int.from_bytes(word.encode(), "little") for word in purpose]
        return np.random.default_rng([self.seed, len(words), *words])
