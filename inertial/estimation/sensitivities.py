"""Derivatives of readings with respect to the parameters of effects."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from inertial.arrays import Array


@dataclass(frozen=True)
class Sensitivities:
    """The change of a reading per unit of each parameter.

    `names`: of the parameters; `values`: (3, k), or (n, 3, k) for n blocks.
    """

    names: tuple[str, ...] = ()
    values: Array = field(default_factory=lambda: np.zeros((3, 0)))

    def of(self, names: Sequence[str]) -> Array:
        """Those to other parameters, in their order; zero for parameters that it does not have."""
        if tuple(names) == self.names:
            return self.values
        others = np.zeros((*self.values.shape[:-1], len(names)))
        there = [i for i, name in enumerate(names) if name in self.names]
        others[..., there] = self.values[..., [self.names.index(names[i]) for i in there]]
        return others

    def extended(self, names: Sequence[str], values: Array) -> "Sensitivities":
        """These and further ones."""
        every = np.concatenate([self.values, values], axis=-1)
        return Sensitivities((*self.names, *names), every)


NO_SENSITIVITIES = Sensitivities()
