"""Reduction of chi-squared by every candidate, given what is already in the model."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inertial.arrays import Array, Integers
from inertial.model_selection.evidence import SearchedEffect

MAX_BATCH = 20_000  # groups times data sets in one array
MIN_EIGENVALUE = 1e-6  # of the information scaled to unit diagonal; below: not observable


@dataclass(frozen=True)
class Width:
    """Candidates of the same number of columns: their places (g,) and columns (g, w)."""

    places: Integers
    columns: Integers


class Candidates:
    """All candidates of all effects in one sequence, and the reduction of chi-squared by each.

    `effect`: (c,) which effect each belongs to; `value`: (c,) which value of its scan.
    """

    def __init__(self, effects: Sequence[SearchedEffect]) -> None:
        self.effects = tuple(effects)
        listed = [
            (number, value, columns)
            for number, effect in enumerate(effects)
            for value, columns in enumerate(effect.candidates)
        ]
        self.columns = [columns for _, _, columns in listed]
        self.effect = np.array([number for number, _, _ in listed], dtype=np.int64)
        self.value = np.array([value for _, value, _ in listed], dtype=np.int64)
        only = np.array([np.nan if e.only is None else e.only for e in effects], np.float64)
        self.only = only[self.effect]
        self.positive = np.array([e.positive for e in effects], dtype=bool)[self.effect]
        widths = np.array([len(columns) for columns in self.columns], dtype=np.int64)
        self.widths = [
            Width(
                np.flatnonzero(widths == width),
                np.array([c for c in self.columns if len(c) == width], dtype=np.int64),
            )
            for width in np.unique(widths[widths > 0])
        ]

    def __len__(self) -> int:
        return len(self.columns)

    def together(self, places: Sequence[int]) -> list[int]:
        """The columns of some candidates, each once."""
        return list(dict.fromkeys(i for place in places for i in self.columns[place]))

    def around(self, places: Sequence[int]) -> list[int]:
        """The same with the neighbours in each scan, between which the true value may lie."""
        near = [
            neighbour
            for place in places
            for neighbour in self._neighbours(place)
            if 0 <= neighbour < len(self) and self.effect[neighbour] == self.effect[place]
        ]
        return self.together(near)

    def _neighbours(self, place: int) -> tuple[int, ...]:
        between = self.effects[self.effect[place]].between
        return (place, place - 1, place + 1) if between else (place,)

    def possible(self, information: Array, right: Array, places: Sequence[int]) -> bool:
        """Whether no value that cannot be negative is, where some candidates are together."""
        positive = [place for place in places if self.positive[place]]
        if not positive:
            return True
        own = self.together(places)
        white = _white(information, own)
        values = dict(zip(own, white.T @ (white @ right[own]), strict=True))
        return all(values[self.columns[place][0]] >= 0 for place in positive)

    def drops(
        self, information: Array, right: Array, given: Sequence[int] = ()
    ) -> tuple[Array, Integers]:
        """Drop of chi-squared by each candidate given some columns, and its degrees, (c,).

        `right`: (k,), or (k, n) for n data sets at once: then the drops are (c, n).
        """
        size = np.sqrt(np.maximum(np.diag(information), np.finfo(float).tiny))
        many = right.reshape(len(right), -1)
        projection = np.zeros((0, len(right)))
        if len(given):
            white = _white(information, given)
            projection = white @ information[list(given)]
            many = many - projection.T @ (white @ many[list(given)])
        drop = np.zeros((len(self), many.shape[1]))
        degrees = np.zeros(len(self), dtype=np.int64)
        for width in self.widths:
            c = width.columns
            projected = projection[:, c]
            block = information[c[:, :, None], c[:, None, :]]
            block = block - np.einsum("qgi,qgj->gij", projected, projected)
            values, vectors = _modes(block, size[c])
            white = (vectors * _inverse(values)[:, None, :]).transpose(0, 2, 1)
            for batch in _batches(len(c), many.shape[1]):
                along = white[batch] @ many[c[batch]]
                misfit = self._misfit(width.places[batch], values[batch], vectors[batch], along)
                drops = np.einsum("gij,gij->gj", along, along) - misfit
                drops[self.positive[width.places[batch], None] & (many[c[batch, 0]] < 0)] = 0.0
                drop[width.places[batch]] = drops
            degrees[width.places] = np.sum(values > 0, axis=1)
        return np.maximum(drop, 0.0).reshape(len(self), *right.shape[1:]), degrees

    def _misfit(self, places: Integers, values: Array, vectors: Array, along: Array) -> Array:
        """What chi-squared grows by as a column has the only value that it can have, (g, n)."""
        only = self.only[places]
        fixed = ~np.isnan(only)
        misfit = np.zeros((len(places), along.shape[2]))
        root = np.sqrt(values[fixed, 0]) / vectors[fixed, 0, 0]
        misfit[fixed] = (along[fixed, 0] - (only[fixed] * root)[:, None]) ** 2
        return misfit


def _batches(groups: int, draws: int) -> list[slice]:
    """Slices of the groups of which the arrays stay small."""
    step = max(MAX_BATCH // max(draws, 1), 1)
    return [slice(start, start + step) for start in range(0, groups, step)]


def joint_drop(information: Array, right: Array, columns: Sequence[int]) -> float:
    """The drop of chi-squared with some columns together."""
    if not len(columns):
        return 0.0
    return float(np.sum((_white(information, columns) @ right[list(columns)]) ** 2))


def _white(information: Array, columns: Sequence[int]) -> Array:
    """Combinations of the columns, (w, w), that are independent and of unit information."""
    block = information[np.ix_(columns, columns)]
    size = np.sqrt(np.maximum(np.diag(block), np.finfo(float).tiny))
    values, vectors = _modes(block[None], size[None])
    white: Array = (vectors[0] * _inverse(values[0])).T
    return white


def _modes(block: Array, size: Array) -> tuple[Array, Array]:
    """Information (g, w), 0 where there is none, and combinations (g, w, w), of blocks."""
    values, vectors = np.linalg.eigh(block / (size[:, :, None] * size[:, None, :]))
    return np.where(values > MIN_EIGENVALUE, values, 0.0), vectors / size[:, :, None]


def _inverse(values: Array) -> Array:
    """Root of the inverse, 0 where there is no information."""
    return np.where(values > 0, 1 / np.sqrt(np.where(values > 0, values, 1.0)), 0.0)
