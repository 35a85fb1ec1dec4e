"""The information of clean campaigns of the hidden plans on every effect, and fleets of them."""

import pickle
from dataclasses import dataclass
from functools import cache

import chain
import numpy as np
from hidden_plans import PLANS

import laboratory
from inertial.arrays import Array
from inertial.model_selection.fleet_evidence import FleetEvidence
from inertial.model_selection.fleet_search import FleetLaw, fleet_law
from inertial.tables.code import code_of, hash_of

SEED = 60_013
KEPT = chain.ROOT / "data/derived/fleets"
FALSE_DISCOVERIES = chain.SETTINGS["fleet"]["false_discoveries"]
DRAWN_BY = ("plans", "draws")


@dataclass(frozen=True)
class Shape:
    """IMUs, campaigns of each, tables: IMU i comes to table i, i + 1, … in turn."""

    imus: int
    each: int
    tables: int

    @property
    def rows(self) -> list[tuple[int, int]]:
        """IMU and table of each campaign."""
        return [(i, (i + n) % self.tables) for i in range(self.imus) for n in range(self.each)]


SHAPES = {
    "6 IMUs twice on 3 tables": Shape(6, 2, 3),
    "4 IMUs three times on 2 tables": Shape(4, 3, 2),
    "12 IMUs twice on 2 tables": Shape(12, 2, 2),
    "5 IMUs three times on 1 table": Shape(5, 3, 1),
}


@cache
def code() -> str:
    """A hash of what an outcome rests on."""
    files = {*code_of("criticism"), *code_of("fleet", "overviews")}
    files |= {*(chain.ROOT / "laboratory").rglob("*.py"), chain.ROOT / "config.yaml"}
    files |= {chain.ROOT / f"tests/fleet/fleet_{name}.py" for name in DRAWN_BY}
    return hash_of(sorted(files))[:16]


@cache
def informations() -> tuple[dict[str, list[int]], dict[str, Array]]:
    """The columns of each effect, and F of each plan by what criticism stores of a campaign."""
    file = KEPT / f"plans-{code()}.pickle"
    if file.is_file():
        kept: tuple[dict[str, list[int]], dict[str, Array]] = pickle.loads(file.read_bytes())  # noqa: S301 (written here)
        return kept
    stored = {}
    for plan, document in PLANS.items():
        recording = laboratory.perform(laboratory.specify(document(seed=SEED)))
        results = chain.in_memory(recording, "criticism", chain.BESIDE)
        stored[plan] = results["criticism/information_matrix"]
    effects: dict[str, list[int]] = {}
    column: dict[tuple[str, str], int] = {}
    for table in stored.values():
        diagonal = table[
            (table["effect"] == table["with_effect"])
            & (table["parameter"] == table["with_parameter"])
        ]
        for place in zip(diagonal["effect"], diagonal["parameter"], strict=True):
            if place not in column:
                column[place] = len(column)
                effects.setdefault(place[0], []).append(column[place])
    informations = {}
    for plan, table in stored.items():
        f = np.zeros((len(column), len(column)))
        for row in table.itertuples():
            i = column[row.effect, row.parameter]
            j = column[row.with_effect, row.with_parameter]
            f[i, j] = f[j, i] = row.information
        informations[plan] = f
    KEPT.mkdir(parents=True, exist_ok=True)
    part = file.with_suffix(f".{np.random.default_rng().integers(1 << 40)}.part")
    part.write_bytes(pickle.dumps((effects, informations)))
    part.replace(file)
    return effects, informations


@cache
def fleet(name: str) -> tuple[FleetEvidence, FleetLaw, Array]:
    """A fleet without scores, the law of its search, and roots R of F = R Rᵀ, (c, k, k)."""
    effects, of_plan = informations()
    rows = SHAPES[name].rows
    plans = list(of_plan)
    information = np.array([of_plan[plans[n % 3]] for n in range(len(rows))])
    labels = {
        "type": ["type"] * len(rows),
        "table": [f"table {table}" for _, table in rows],
        "imu": [f"imu {imu}" for imu, _ in rows],
        "campaign": [f"campaign {n}" for n in range(len(rows))],
    }
    evidence = FleetEvidence(effects, information, np.zeros(information.shape[:2]), labels)
    roots = {plan: _root(f) for plan, f in of_plan.items()}
    of_rows = np.array([roots[plans[n % 3]] for n in range(len(rows))])
    return evidence, fleet_law(evidence, FALSE_DISCOVERIES), of_rows


def _root(information: Array) -> Array:
    """By singular values, of the matrix scaled to unit diagonal."""
    size = np.sqrt(np.diag(information))
    safe = np.where(size > 0, size, 1.0)
    left, values, _ = np.linalg.svd(information / np.outer(safe, safe))
    return np.asarray(size[:, None] * left * np.sqrt(values))
