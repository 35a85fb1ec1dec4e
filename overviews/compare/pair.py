"""The parameters and effects of two results, each with difference, sigma and p."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from inertial.arrays import Array
from inertial.campaign.references import READ_AS_SCALE
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.estimation.probability import chi2_sf
from inertial.text.cause_names import in_words
from inertial.text.parameters import sign_of
from overviews.compare.shared import Key, Shared, shared_by
from stages.report.tables import Record, Tables

READ = (
    "campaign",
    "certificate",
    "known",
    "inputs",
    "manoeuvres",
    "blocks",
    "causes",
    "cause_members",
    "consequences",
    "verdict",
    "result",
    "covariance",
    "uncertainty_budget",
)
MIN_EIGENVALUE = 1e-12  # of a correlation matrix that can be inverted


@dataclass(frozen=True)
class Compared:
    """A parameter in two results: rows of these, none where one has no value.

    `sigma`: of second less first; `repeating`: the same if the errors of the table repeat.
    """

    key: Key
    effect: str | None
    first: Record | None
    second: Record | None
    sigma: float | None
    repeating: float | None
    beyond: bool = False

    @property
    def row(self) -> Record:
        """Either of its rows, for its name and unit."""
        row = self.first or self.second
        assert row is not None
        return row

    @property
    def effect_in_words(self) -> str:
        """The parameter of an effect: gyro g-sensitivity, g_xx."""
        effect, _dot, name = self.key[2].partition(".")
        return f"{in_words(effect)}, {sign_of(name)}"

    @property
    def difference(self) -> float | None:
        """Second less first."""
        if self.first is None or self.second is None:
            return None
        return float(self.second["value"] - self.first["value"])

    @property
    def in_sigmas(self) -> float | None:
        """The difference in units of its sigma."""
        return None if self.difference is None or not self.sigma else self.difference / self.sigma

    @property
    def p_value(self) -> float | None:
        """Chance of a difference so large, either way, if the two are the same."""
        return None if self.in_sigmas is None else normal_p_value(self.in_sigmas)


@dataclass(frozen=True)
class Pair:
    """Two campaigns with their tables, and what they are compared by.

    `level`: chance of calling any difference more than chance.
    """

    names: tuple[str, str]
    tables: tuple[Tables, Tables]
    shared: Shared
    compared: tuple[Compared, ...]
    common_logs: tuple[str, ...]
    level: float

    def of(self, sensor: str) -> list[Compared]:
        """The parameters of a sensor, effects left out."""
        return [one for one in self.compared if one.effect is None and one.key[1] == sensor]

    @property
    def effects(self) -> list[Compared]:
        """The parameters of effects in either result."""
        return [one for one in self.compared if one.effect is not None]

    def together(self, sensor: str) -> tuple[float, int, float] | None:
        """χ² of all differences of a sensor, their number, p; none where that is not known."""
        rows = [one for one in self.of(sensor) if one.in_sigmas is not None]
        if not rows:
            return None
        covariance = self.covariance_of_differences(rows)
        scale = np.sqrt(np.diag(covariance).clip(1e-300))
        correlation = covariance / np.outer(scale, scale)
        if np.linalg.eigvalsh(correlation)[0] < MIN_EIGENVALUE:
            return None
        size = np.array([one.difference for one in rows], np.float64) / scale
        chi2 = float(size @ np.linalg.solve(correlation, size))
        return chi2, len(rows), float(chi2_sf(chi2, len(rows)))

    def covariance_of_differences(self, rows: list[Compared]) -> Array:
        """Of second less first of parameters of a sensor, (n, n).

        The errors of gravity and of the rates of a table that both share are taken out.
        """
        each = [self._covariance(which, rows) for which in (0, 1)]
        difference = each[0] + each[1]
        for source in READ_AS_SCALE:
            moved = [self._moved_by(source, which, rows, own) for which, own in enumerate(each)]
            difference -= np.outer(*moved) + np.outer(*moved[::-1])
        return difference

    def _moved_by(self, source: str, which: int, rows: list[Compared], covariance: Array) -> Array:
        """By how much an error of a shared source moves each value, (n,); or by nothing.

        Its size is by the share in the variance, its sign that of the covariance with the value of
        the largest share, which is nearly all of this source.
        """
        shares = np.array([self.shared.shares[which].get((one.key, source), 0.0) for one in rows])
        if source not in self.shared.sources or not shares.any():
            return np.zeros(len(rows))
        signs = np.sign(covariance[np.argmax(shares)])
        return np.asarray(signs * np.sqrt(np.diag(covariance) * shares))

    def _covariance(self, which: int, rows: list[Compared]) -> Array:
        known = {
            (row["first"], row["second"]): row["covariance"]
            for row in self.tables[which].rows("covariance")
        }
        ids = [str((one.first, one.second)[which]["id"]) for one in rows]  # type: ignore[index]
        return np.array(
            [[known.get((a, b), known.get((b, a), 0.0)) for b in ids] for a in ids], np.float64
        )


def pair_of_campaigns(names: tuple[str, str], tables: tuple[Tables, Tables], level: float) -> Pair:
    """Two campaigns compared; `level`: chance of calling any difference more than chance."""
    shared = shared_by(*tables)
    logs = [
        {row["sha256"]: row["file"] for row in own.rows("inputs") if row["file"] != "campaign.yaml"}
        for own in tables
    ]
    common = tuple(sorted(logs[0][sha] for sha in logs[0].keys() & logs[1].keys()))
    rows = list(_compared(tables, shared, independent=not common))
    tested = [i for i, one in enumerate(rows) if one.p_value is not None]
    chances = [rows[i].p_value or 0.0 for i in tested]
    if tested:
        for i, beyond in zip(tested, holm_rejections(chances, level), strict=True):
            rows[i] = replace(rows[i], beyond=bool(beyond))
    return Pair(names, tables, shared, tuple(rows), common, level)


def _compared(
    tables: tuple[Tables, Tables], shared: Shared, *, independent: bool
) -> Iterator[Compared]:
    """Every parameter that one of them has, in the order of the first."""
    first, second = map(_by_key, tables)
    for key in dict.fromkeys([*first, *second]):
        rows = (first.get(key), second.get(key))
        sigma = repeating = None
        if independent and rows[0] and rows[1] and rows[0]["sigma"] and rows[1]["sigma"]:
            both = (float(rows[0]["sigma"]), float(rows[1]["sigma"]))
            sigma = _sigma(both, shared.covariance(key, both))
            if shared.table:
                repeating = _sigma(both, shared.covariance(key, both, table=True))
        effect = (rows[0] or rows[1] or {})["effect"]
        yield Compared(key, effect, *rows, sigma, repeating)


def _sigma(both: tuple[float, float], covariance: float) -> float:
    """Of a difference; where nearly all is shared, no less than rounding leaves of it."""
    variance = both[0] ** 2 + both[1] ** 2 - 2 * covariance
    return sqrt(max(variance, 1e-12 * (both[0] ** 2 + both[1] ** 2)))


def _by_key(tables: Tables) -> Mapping[Key, Record]:
    return {
        (row["mount"], row["sensor"], row["parameter"]): row
        for row in tables.rows("result")
        if row["value"] is not None
    }
