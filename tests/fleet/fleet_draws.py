"""Fleets with hidden effects, and populations, drawn by number; what is found in them.

The scores of a campaign are b ~ N(F β, F), drawn here from the information matrices of real plans:
no sum, no test and no likelihood of the code under test is used to draw them.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np
from fleet_plans import FALSE_DISCOVERIES, SEED, SHAPES, Array, code, fleet
from scipy import stats

from inertial.arrays import Integers
from inertial.estimation.fleet_components import population
from inertial.estimation.type_population import Campaigns, of_new_imu, type_population
from inertial.model_selection.fleet_evidence import FleetEvidence
from inertial.model_selection.fleet_search import FleetEffect, FleetSearch

LEVELS = ("type", "table", "imu")
RATIOS = (6.0, 8.0, 12.0, 20.0)
MIXED_RATIOS = (5.0, 20.0)
MOST_HIDDEN = 3
OUTLIER_SIGMAS = 8.0
MAIN = "6 IMUs twice on 3 tables"


@dataclass(frozen=True)
class Hidden:
    """An effect that all campaigns of a group have alike."""

    effect: int
    level: str
    group: int


def hidden(
    evidence: FleetEvidence, effect: int, level: str, ratio: float, random: np.random.Generator
) -> tuple[Hidden, Array]:
    """An effect of this pooled ratio in a random direction; β of each campaign, (c, k)."""
    of = evidence.levels[level].of
    columns = evidence.columns[effect]
    groups = [
        g for g in np.unique(of) if np.any(evidence.information[of == g][:, columns, columns] > 0)
    ]
    group = int(random.choice(groups))
    members = np.flatnonzero(of == group)
    information = evidence.information[np.ix_(members, columns, columns)].sum(axis=0)
    seen = np.diag(information) > 0
    size = np.where(seen, 1 / np.sqrt(np.where(seen, np.diag(information), 1.0)), 0.0)
    direction = random.normal(size=len(columns)) * size
    direction *= ratio / np.sqrt(direction @ information @ direction)
    beta = np.zeros(evidence.right.shape)
    beta[np.ix_(members, columns)] = direction
    return Hidden(effect, level, group), beta


def found_in(shape: str, beta: Array, random: np.random.Generator) -> list[FleetEffect]:
    """What is found in a fleet in which the campaigns have effects of these sizes."""
    evidence, law, roots = fleet(shape)
    right = np.einsum("ckl,cl->ck", evidence.information, beta)
    right += np.einsum("ckl,cl->ck", roots, random.standard_normal(beta.shape))
    effects = dict(zip(evidence.names, evidence.columns, strict=True))
    labels = {level: [own.labels[i] for i in own.of] for level, own in evidence.levels.items()}
    drawn = FleetEvidence(effects, evidence.information, right, labels)
    return FleetSearch(drawn, law).found()


def limit(share: float, degrees: int, ratio: float) -> float:
    """The power that no search can exceed that accepts a hypothesis at this p-value."""
    return float(stats.ncx2.sf(stats.chi2.isf(share, degrees), degrees, ratio**2))


def single(name: str, level: str, ratio: float, trials: int) -> dict[str, Any]:
    """How often one effect is found, and what it is said to belong to."""
    evidence, law, _ = fleet(MAIN)
    effect = evidence.names.index(name)
    random = np.random.default_rng([SEED, effect, LEVELS.index(level), int(ratio)])
    told = {"effect": name, "level": level, "ratio": ratio, "trials": trials, "code": code()}
    counts = dict.fromkeys(("found", "named", "right", "only", "limit", "textbook"), 0.0)
    for _ in range(trials):
        truth, beta = hidden(evidence, effect, level, ratio, random)
        rank = int(np.linalg.matrix_rank(_unit(evidence, truth)))
        counts["limit"] += limit(law.share, rank, ratio)
        counts["textbook"] += limit(FALSE_DISCOVERIES / law.hypotheses, rank, ratio)
        found = found_in(MAIN, beta, random)
        own = [one for one in found if effect in one.members]
        counts["found"] += bool(found)
        counts["named"] += bool(own)
        counts["right"] += any(truth.level in one.levels for one in own)
        counts["only"] += any(one.levels == (truth.level,) for one in own)
    return told | counts


def _unit(evidence: FleetEvidence, one: Hidden) -> Array:
    """The information of a group on an effect, scaled to unit diagonal where there is any."""
    members = np.flatnonzero(evidence.levels[one.level].of == one.group)
    columns = evidence.columns[one.effect]
    block = evidence.information[np.ix_(members, columns, columns)].sum(axis=0)
    size = np.sqrt(np.diag(block))
    return np.asarray(block / np.outer(size, size)) if size.all() else block


def mixed(number: int) -> dict[str, Any]:
    """A fleet of any shape with none to three effects: findings, and those that are false.

    False by the name: no hidden effect is among what it may be; by the belonging: none that
    belongs to what it may belong to.
    """
    random = np.random.default_rng([SEED + 1, number])
    shape = list(SHAPES)[number % len(SHAPES)]
    evidence, _, _ = fleet(shape)
    count = number // len(SHAPES) % (MOST_HIDDEN + 1)
    beta, there = np.zeros(evidence.right.shape), []
    effects = random.choice(len(evidence.names), count, replace=False)
    for effect in effects.tolist():
        ratio = float(np.exp(random.uniform(*np.log(MIXED_RATIOS))))
        truth, more = hidden(evidence, effect, str(random.choice(LEVELS)), ratio, random)
        there.append(truth)
        beta += more
    found = found_in(shape, beta, random)
    false = [f for f in found if not any(t.effect in f.members for t in there)]
    astray = [
        f for f in found if not any(t.effect in f.members and t.level in f.levels for t in there)
    ]
    told = {"number": number, "code": code(), "shape": shape, "hidden": count}
    return told | {"found": len(found), "false": len(false), "astray": len(astray)}


# ---- Populations.

IMUS, EACH, TABLES = 20, 2, (2, 5)  # tables of even and odd pairs of draws
SPREAD, TABLE_SPREAD, CAMPAIGN_SPREAD, SIGMA, MEAN = 3.0, 1.0, 0.5, 0.7, 10.0
CORRELATION = 0.8
MEAN_TABLES, MEAN_SPREADS = (1, 2, 3, 5, 10), (0.0, 1.0, 3.0, 9.0)  # tables; their spread
TOGETHER = 100  # populations of one job
RARE = 0.05  # share of intervals that are to miss


def drawn_population(number: int) -> dict[str, Any]:
    """A population of three parameters, two of them correlated; the last IMU may be an outlier."""
    random = np.random.default_rng([SEED + 2, number])
    tables = TABLES[number // 2 % 2]
    imu, table, labels = _campaigns(tables)
    between = SPREAD**2 * np.array([[1, CORRELATION, 0], [CORRELATION, 1, 0], [0, 0, 1]])
    of_imus = random.multivariate_normal(np.zeros(3), between, IMUS + 1)
    of_tables = TABLE_SPREAD * random.normal(size=(tables, 3))
    own = CAMPAIGN_SPREAD * random.normal(size=(len(imu), 3))
    values = MEAN + of_imus[imu] + of_tables[table] + own + SIGMA * random.normal(size=own.shape)
    odd = bool(number % 2)
    if odd:
        values[imu == IMUS - 1, 0] += OUTLIER_SIGMAS * SPREAD
    covariance = np.tile(SIGMA**2 * np.eye(3), (len(imu), 1, 1))
    found = type_population(Campaigns(values, covariance, labels), 0.01)
    clean = population(values[:, 2], np.full(len(imu), SIGMA), labels)
    new = MEAN + of_imus[-1, 2] + TABLE_SPREAD * random.normal() + CAMPAIGN_SPREAD * random.normal()
    by_imu = next(s for s in clean.spreads if s.levels == ("imu",))
    sigma, degrees = of_new_imu(clean) or (np.nan, np.nan)
    return {
        "number": number,
        "code": code(),
        "odd": odd,
        "tables": tables,
        "spread": by_imu.value,
        "spread_sigma": by_imu.sigma,
        "new_inside": bool(abs(new - clean.mean) < sigma * stats.t.isf(0.025, degrees)),
        "correlation": float(found.correlation[0, 1]),
        "outliers": sorted({one.imu for one in found.outliers}),
    }


def drawn_means(tables: int, spread: float, number: int) -> dict[str, Any]:
    """How many intervals of 95 % hold the mean of a parameter, of `TOGETHER` populations.

    `half_width`: the median of them. With one table its part is in the mean: nothing tells them
    apart.
    """
    random = np.random.default_rng([SEED + 3, tables, int(spread), number])
    imu, table, labels = _campaigns(tables)
    told = {"tables": tables, "spread": spread, "number": number, "code": code()}
    held, widths = 0, []
    for _ in range(TOGETHER):
        of_tables = spread * random.normal(size=tables)
        values = MEAN + SPREAD * random.normal(size=IMUS)[imu] + of_tables[table]
        values += np.hypot(CAMPAIGN_SPREAD, SIGMA) * random.normal(size=len(imu))
        truth = MEAN + (of_tables[0] if tables == 1 else 0.0)
        found = population(values, np.full(len(imu), SIGMA), labels)
        widths.append(found.mean_sigma * stats.t.isf(RARE / 2, found.mean_degrees))
        held += int(abs(found.mean - truth) < widths[-1])
    return told | {"held": held, "half_width": float(np.median(widths))}


def _campaigns(tables: int) -> tuple[Integers, Integers, dict[str, list[str]]]:
    """IMU and table of each campaign, (c,), and the labels: each IMU comes to `EACH` tables."""
    imu = np.repeat(np.arange(IMUS), EACH)
    table = (imu + np.tile(np.arange(EACH), IMUS)) % tables
    labels = {
        "type": ["type"] * len(imu),
        "table": [str(t) for t in table],
        "imu": [str(i) for i in imu],
        "campaign": [str(n) for n in range(len(imu))],
    }
    return imu, table, labels
