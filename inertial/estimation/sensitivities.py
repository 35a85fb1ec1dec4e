"""How readings change with the parameters of effects."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Traces:
    """The change of a reading per unit of each parameter.

    `names`: of the parameters; `values`: (3, k), or (n, 3, k) for n blocks.
    """

    names: tuple[str, ...] = ()
    values: Array = field(default_factory=lambda: np.zeros((3, 0)))

    def of(self, names: Sequence[str]) -> Array:
        """The same for other parameters, in their order; zero for those that it does not have."""
        if tuple(names) == self.names:
            return self.values
        others = np.zeros((*self.values.shape[:-1], len(names)))
        there = [i for i, name in enumerate(names) if name in self.names]
        others[..., there] = self.values[..., [self.names.index(names[i]) for i in there]]
        return others

    def and_of(self, names: Sequence[str], values: Array) -> "Traces":
        """These and further ones."""
        return Traces((*self.names, *names), np.concatenate([self.values, values], axis=-1))


NONE = Traces()
