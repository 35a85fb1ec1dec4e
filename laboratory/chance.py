"""Everything that falls by chance in the laboratory, drawn from the one seed of a campaign.

Each purpose ("tilts", "x-up") has a stream of its own, so that one more effect or one more log
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
        """The random numbers for one purpose: the same ones whenever it is asked for."""
        words = [int.from_bytes(word.encode(), "little") for word in purpose]
        return np.random.default_rng([self.seed, len(words), *words])
