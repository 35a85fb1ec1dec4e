"""What one table does to the scale factors of all its sensors alike, by IMUs on several tables.

A campaign takes an error of its table that is common to all turns for the scale factors of its
gyros, and one of gravity for those of its accelerometers. On another table the same IMU shows it:

    x_ci = s_imu(c),i + e_table(c) + t_ci + n_ci,      t ~ N(0, θ),  n_c ~ N(0, C_c)

with the scale factors x_c of campaign c along its axes i, those of its IMU, s, which are free, the
error e of the table, the change t of each scale factor from one turn-on to the next, and the stated
covariance C_c. Of the e only differences between tables that share IMUs are observable. The sums of
each IMU are eliminated at once, so that every campaign costs the same.

How large θ is, is not known beforehand; chances are averaged over what the residuals beside free
tables leave possible, as in `fleet_components`. A change that all axes of one IMU have in common in
one campaign (of its own clock or temperature) is the rival. It is weighed as in `fleet_search`, and
must not be what the IMUs differ by: with a variance of its own, which they show likewise, the
tables must still differ. Of one IMU, once on each table, nothing tells the two apart.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from inertial.arrays import Array, Integers
from inertial.estimation.fleet_components import INNER, Mixture
from inertial.estimation.probability import chi2_sf, norm_sf
from inertial.model_selection.fleet_evidence import whitened
from inertial.model_selection.fleet_search import MIN_WEIGHT, log_evidence

# Variances of changes between turn-ons that are tried, in median variances of a scale factor.
CHANGES = np.r_[0.0, np.geomspace(1e-4, 1e10, 120)]
MIN_TOLD = 1e-6  # of the information on a value that what is free must leave, to test it
MIN_SEEN = 1e-6  # of the information on a table that free scale factors of the IMUs must leave
# Of the difference by changes that all axes of an IMU have in common: the tables are named, alone.
MAX_COMMON_CHANCE, SURELY = 0.05, 0.01
MIN_DEGREES = 2  # of freedom, that show the changes between turn-ons
EVEN = 0.5 - 1e-6  # chance that it is of the tables: of one campaign on each nothing tells
TABLE, CAMPAIGN = "table", "campaign"


@dataclass(frozen=True)
class ScaleFactors:
    """Scale factor errors of one sensor in campaigns of IMUs on tables.

    `values`: (c, 3), NaN where not determined; `covariance`: (c, 3, 3).
    """

    values: Array
    covariance: Array
    imus: tuple[str, ...]
    tables: tuple[str, ...]
    campaigns: tuple[str, ...]

    def some(self, kept: Sequence[int]) -> "ScaleFactors":
        """Some of the campaigns."""
        own = list(kept)
        return ScaleFactors(
            self.values[own],
            self.covariance[own],
            tuple(self.imus[i] for i in own),
            tuple(self.tables[i] for i in own),
            tuple(self.campaigns[i] for i in own),
        )

    def without(self, campaign: int, axis: int) -> "ScaleFactors":
        """Without a single value; a campaign that has no other is left out."""
        values = self.values.copy()
        values[campaign, axis] = np.nan
        shown = np.flatnonzero(np.isfinite(values).any(axis=1))
        return replace(self, values=values).some(shown.tolist())


@dataclass(frozen=True)
class TableDifference:
    """What the sensors read more on some tables than on others, as a share of the scale factor.

    `value` is positive; `chance`: of so large a difference by noise and changes between turn-ons;
    `common_chance`: by changes that all axes of an IMU have in common, NaN where nothing shows how
    large they are; `sharings`: probability that the tables have it, and that each campaign has;
    `imus`: on both; `axes`: how many of the sensor's show it.
    """

    more: tuple[str, ...]
    less: tuple[str, ...]
    value: float
    sigma: float
    chance: float
    common_chance: float
    sharings: dict[str, float]
    imus: int
    axes: int

    @property
    def possible(self) -> tuple[str, ...]:
        """What may have it, for all that the campaigns tell."""
        surely = self.common_chance < SURELY and self.sharings[CAMPAIGN] < MIN_WEIGHT
        return (TABLE,) if surely else (TABLE, CAMPAIGN)

    @property
    def of_tables(self) -> bool:
        """Whether no other explanation is better."""
        return self.sharings[TABLE] > EVEN and not self.common_chance > MAX_COMMON_CHANCE


@dataclass(frozen=True)
class _Sums:
    """Of the equations with the IMUs eliminated: tables' F (t, t) and b (t,), and chi-squared."""

    information: Array
    right: Array
    square: float

    def beside(self, off: Sequence[int]) -> "_Sums":
        """With the errors of some tables fitted, their rows then being zero."""
        if not off:
            return self
        own = np.array(off)
        inverse = np.linalg.inv(self.information[np.ix_(own, own)])
        across = self.information[:, own] @ inverse
        return _Sums(
            self.information - across @ self.information[own],
            self.right - across @ self.right[own],
            self.square - float(self.right[own] @ inverse @ self.right[own]),
        )


@dataclass(frozen=True)
class Residuals:
    """Of each value (c, 3) beside free tables and IMUs, given the variance of changes.

    `shifts`: by how much it is off if the others are right; `sigmas`: of that, infinite where the
    others do not predict it; `square`: chi-squared of all.
    """

    shifts: Array
    sigmas: Array
    square: float

    @property
    def drops(self) -> Array:
        """By how much chi-squared is less without the value."""
        return np.asarray((self.shifts / self.sigmas) ** 2)


class Comparison:
    """The campaigns of tables that IMUs connect, at least two."""

    def __init__(self, of: ScaleFactors) -> None:
        self.of = of
        self.tables, self._table = _numbered(of.tables)
        self.imus, self._imu = _numbered(of.imus)
        self._shown = np.isfinite(of.values)
        both = self._shown[:, :, None] & self._shown[:, None, :]
        self._noise = np.where(both, of.covariance, np.eye(3))
        self._values = np.where(self._shown, of.values, 0.0)
        self._values = self._values - self._centres()[self._imu] * self._shown

    def _centres(self) -> Array:
        """A value of each IMU and axis to count from, so that no digits are lost."""
        count, total = np.zeros((2, len(self.imus), 3))
        np.add.at(count, self._imu, self._shown)
        np.add.at(total, self._imu, self._values)
        return np.asarray(total / np.maximum(count, 1))

    @property
    def hypotheses(self) -> list[int]:
        """Each table against the others; of two tables that is one hypothesis."""
        return list(range(len(self.tables) if len(self.tables) > 2 else 1))

    @cached_property
    def degrees(self) -> int:
        """Of freedom of what remains beside free tables."""
        own = np.zeros((len(self.imus), 3), bool)
        np.logical_or.at(own, self._imu, self._shown)
        return int(self._shown.sum() - own.sum()) - (len(self.tables) - 1)

    @cached_property
    def scale(self) -> float:
        """Median variance of a scale factor."""
        variances = np.diagonal(self._noise, axis1=1, axis2=2)
        return float(np.median(variances[self._shown]))

    def sums(self, turn_on: float, common_change: float = 0.0) -> _Sums:
        """With variances of the changes of each axis, and of those that all axes share."""
        weight = self._weight(turn_on)
        common = weight.sum(axis=2)
        whole = common.sum(axis=1)
        taken_out = 1 / (whole + (1 / common_change if common_change else np.inf))
        weight = weight - common[:, :, None] * common[:, None, :] * taken_out[:, None, None]
        left = np.maximum(1 - whole * taken_out, 0.0)
        common, whole = common * left[:, None], whole * left
        along = np.einsum("cij,cj->ci", weight, self._values)
        imus, tables = len(self.imus), len(self.tables)
        block, across = np.zeros((imus, 3, 3)), np.zeros((imus, tables, 3))
        score, right = np.zeros((imus, 3)), np.zeros(tables)
        information = np.zeros((tables, tables))
        np.add.at(block, self._imu, weight)
        np.add.at(across, (self._imu, self._table), common)
        np.add.at(score, self._imu, along)
        np.add.at(right, self._table, np.einsum("ci,ci->c", common, self._values))
        np.add.at(information, (self._table, self._table), whole)
        white, _ = whitened(block)
        mixed = np.einsum("gpq,gtq->gtp", white, across)
        taken = np.einsum("gpq,gq->gp", white, score)
        return _Sums(
            information - np.einsum("gtp,gup->tu", mixed, mixed),
            right - np.einsum("gtp,gp->t", mixed, taken),
            float(np.sum(along * self._values) - np.sum(taken**2)),
        )

    def _weight(self, turn_on: float) -> Array:
        shown = self._shown.astype(float)
        weight = np.linalg.inv(self._noise + turn_on * np.eye(3))
        return np.asarray(weight * shown[:, :, None] * shown[:, None, :])

    def residuals(self, turn_on: float, sums: _Sums) -> Residuals:
        """P y and the diagonal of P, χ² = yᵀ P y; `sums`: with this variance of changes."""
        weight, values = self._weight(turn_on), self._values
        common, along = weight.sum(axis=2), np.einsum("cij,cj->ci", weight, values)
        block, score = np.zeros((len(self.imus), 3, 3)), np.zeros((len(self.imus), 3))
        across = np.zeros((len(self.imus), len(self.tables), 3))
        np.add.at(block, self._imu, weight)
        np.add.at(score, self._imu, along)
        np.add.at(across, (self._imu, self._table), common)
        white, _ = whitened(block)
        of_imu = np.einsum("gpq,gpr->gqr", white, white)[self._imu]
        seen = np.einsum("cij,cjk->cik", weight, of_imu)
        tables = -np.einsum("cij,ctj->cit", seen, across[self._imu])
        tables[np.arange(len(weight)), :, self._table] += common
        tables = tables[:, :, 1:]
        inverse = np.linalg.inv(sums.information[1:, 1:])
        left = along - np.einsum("cij,cj->ci", seen, score[self._imu])
        left -= tables @ (inverse @ sums.right[1:])
        diagonal = np.einsum("cii->ci", weight) - np.einsum("cij,cji->ci", seen, weight)
        diagonal -= np.einsum("cit,tu,ciu->ci", tables, inverse, tables)
        tells = diagonal > MIN_TOLD * np.einsum("cii->ci", weight)
        shifts = np.where(tells, left, 0.0) / np.where(tells, diagonal, 1.0)
        sigmas = np.where(tells, 1 / np.sqrt(np.where(tells, diagonal, 1.0)), np.inf)
        return Residuals(shifts, sigmas, self._left(sums))

    @cached_property
    def possible(self) -> tuple[Array, list[_Sums]]:
        """The probability of each variance between turn-ons, and the sums with it.

        What remains beside free tables is chi-squared at the true one.
        """
        tried = [self.sums(self.scale * one) for one in CHANGES]
        left = np.array([self._left(sums) for sums in tried])
        return chances_of_changes(left, self.degrees), tried

    @cached_property
    def turn_on(self) -> float:
        """The largest variance with which as much remains as should."""
        _, tried = self.possible
        kept = [
            one
            for one, sums in zip(CHANGES, tried, strict=True)
            if self._left(sums) >= self.degrees
        ]
        return self.scale * float(max(kept, default=0.0))

    @cached_property
    def possible_in_common(self) -> tuple[Array, list[_Sums]]:
        """The same of changes that all axes have in common; none where nothing shows them."""
        degrees = len(self._imu) - len(self.imus) - (len(self.tables) - 1)
        if not degrees:
            return np.zeros(0), []
        tried = [self.sums(self.turn_on, self.scale * one) for one in CHANGES]
        apart = self._apart.square
        left = np.array([self._left(sums) - apart for sums in tried])
        return chances_of_changes(left, degrees), tried

    @cached_property
    def _apart(self) -> _Sums:
        """With any change that all axes have in common: what their differences tell."""
        return self.sums(self.turn_on, np.inf)

    def _left(self, sums: _Sums) -> float:
        """What remains beside free tables."""
        return sums.beside(range(1, len(self.tables))).square

    def difference(self, table: int, off: Sequence[int] = ()) -> TableDifference | None:
        """Of a table from the others, beside others that are off too; None where not observable."""
        weights, tried = self.possible
        if tried[0].beside(off).information[table, table] < MIN_SEEN / self.scale:
            return None
        law = _law(table, off, weights, tried)
        others = tuple(
            name for i, name in enumerate(self.tables) if i != table and i not in set(off)
        )
        own = (self.tables[table],)
        weights, tried = self.possible_in_common
        more, less = (own, others) if law.mean > 0 else (others, own)
        return TableDifference(
            more,
            less,
            abs(law.mean),
            law.half_width(INNER),
            _chance(law),
            _chance(_law(table, off, weights, tried)) if tried else np.nan,
            self._sharings(table, off),
            self._on_both(table, off),
            int(self._shown.any(axis=0).sum()),
        )

    def _sharings(self, table: int, off: Sequence[int]) -> dict[str, float]:
        """The more probable first."""
        sums = self.sums(self.turn_on).beside(off)
        own = float(sums.right[table] ** 2 / sums.information[table, table])
        free = sums.square - self._apart.square
        degrees = len(self._imu) - len(self.imus) - len(off)
        of_table, of_campaign = log_evidence(np.array([own, free]), np.array([1, degrees]))
        probability = float(1 / (1 + np.exp(np.clip(of_campaign - of_table, -700, 700))))
        both = {TABLE: probability, CAMPAIGN: 1 - probability}
        return dict(sorted(both.items(), key=lambda one: -one[1]))

    def _on_both(self, table: int, off: Sequence[int]) -> int:
        """How many IMUs were on the table and on one of the others."""
        on = np.zeros((len(self.imus), len(self.tables)), bool)
        on[self._imu, self._table] = True
        others = [i for i in range(len(self.tables)) if i != table and i not in set(off)]
        return int(np.sum(on[:, table] & on[:, others].any(axis=1)))

    def found(self, share: float, already: int) -> list[TableDifference]:
        """The tables that differ from the others, the clearest first; see `searched`."""
        return self.searched(share, already)[0]

    def searched(
        self, share: float, already: int
    ) -> tuple[list[TableDifference], list[TableDifference]]:
        """The tables that differ from the others, the clearest first, and those that may not.

        `share`: the chance that a first finding may have; `already`: how many there are.
        """
        off: list[int] = []
        found: list[TableDifference] = []
        while len(off) < len(self.hypotheses):
            sizes = {i: self.difference(i, off) for i in self.hypotheses if i not in off}
            shown = {i: one for i, one in sizes.items() if one is not None}
            if not shown:
                break
            best = min(shown, key=lambda i: shown[i].chance)
            limit = share * (already + len(found) + 1)
            if shown[best].chance > limit or not shown[best].of_tables:
                return found, list(shown.values())
            off.append(best)
            found.append(shown[best])
        return found, []


def comparisons(of: ScaleFactors) -> Iterator[Comparison]:
    """The tables that IMUs connect, where enough of them shows the changes between turn-ons."""
    shown = np.flatnonzero(np.isfinite(of.values).any(axis=1))
    group = {("table", of.tables[i]): ("table", of.tables[i]) for i in shown}
    group |= {("imu", of.imus[i]): ("imu", of.imus[i]) for i in shown}
    for i in shown:
        one, other = group["table", of.tables[i]], group["imu", of.imus[i]]
        group = {key: one if own == other else own for key, own in group.items()}
    for root in dict.fromkeys(group.values()):
        kept = [int(i) for i in shown if group["table", of.tables[i]] == root]
        compared = Comparison(of.some(kept))
        if len(compared.tables) > 1 and compared.degrees >= MIN_DEGREES:
            yield compared


def chances_of_changes(left: Array, degrees: int) -> Array:
    """The probability of each of CHANGES (k, …), with which so much remains, (k, …).

    What remains is chi-squared at the true one; what no change explains is left at zero
    (Viechtbauer 2007), as in `fleet_components`.
    """
    up_to = chi2_sf(np.maximum(left, 0.0), degrees)
    up_to[-1] = 1.0
    between = np.diff(up_to, axis=0) / 2  # half of it at either end
    weights = np.concatenate([up_to[:1], between])
    weights[:-1] += between
    return np.asarray(weights)


def _law(table: int, off: Sequence[int], weights: Array, tried: Sequence[_Sums]) -> Mixture:
    """Of the difference of a table."""
    left = [sums.beside(off) for sums in tried]
    variance = 1 / np.array([sums.information[table, table] for sums in left])
    values = variance * np.array([sums.right[table] for sums in left])
    return Mixture(weights, values, np.sqrt(variance), np.full(len(weights), np.inf))


def _chance(law: Mixture) -> float:
    """Of values as far from zero, by noise."""
    return float(law.weights @ (2 * norm_sf(np.abs(law.centres) / law.sigmas)))


def _numbered(names: Sequence[str]) -> tuple[tuple[str, ...], Integers]:
    place = {name: i for i, name in enumerate(dict.fromkeys(names))}
    return tuple(place), np.array([place[name] for name in names], np.int64)
