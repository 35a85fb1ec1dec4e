"""The campaigns of a fleet: what each says of effects, and the parameters that it found."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.references import NAMELESS, TABLE_RATE
from inertial.estimation.triad import linear_names
from inertial.estimation.type_population import Campaigns
from inertial.model_selection.common_scale import ScaleFactors
from inertial.model_selection.fleet_evidence import FleetEvidence
from inertial.tables.declared import read_declared
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.parameters import SCALE
from overviews.fleet.declared import READ

Place = tuple[str, str]  # an effect and its parameter; or a sensor and its parameter

UNKNOWN = "unknown"  # serial number
PARAMETERS: tuple[Place, ...] = tuple(
    (sensor, name) for sensor in ("accel", "gyro") for name in linear_names()
)

SCALES = {sensor: {(sensor, name) for name in SCALE} for sensor in ("accel", "gyro")}
MAX_SHARE = 0.9999  # of the variance of a scale factor that is an error of its reference


@dataclass(frozen=True)
class References:
    """What the scale factors of a campaign rest on.

    `named`: whether the table has a name, by which it is known again; `turns`: whole (the angle is
    the reference) and steady (the rate is); `sigmas`: relative, as stated, of the angles and rates
    of the table and of gravity, those that are.
    """

    named: bool
    turns: frozenset[str]
    sigmas: Mapping[str, float]


@dataclass(frozen=True)
class Member:
    """One mount of one campaign.

    `score` by effect and parameter, `information` rows of the table; `values`: (24,) in the order
    of PARAMETERS, NaN where not determined, with `covariance`; `gravity`: as the campaign takes it
    as known, m/s², with sigma; `by_table`: (24,), what of the sigmas is the share by which all
    rates of the table are off; `references`: what its scale factors rest on; `reason`: why it is
    not pooled; `named`: effects that the campaign names by itself.
    """

    campaign: str
    mount: str
    type: str
    imu: str
    table: str
    simulated: bool
    logs: frozenset[str]
    score: Mapping[Place, float]
    units: Mapping[Place, str]
    information: pd.DataFrame
    values: Array
    covariance: Array
    gravity: tuple[float, float]
    by_table: Array
    references: References
    reason: str = ""
    named: frozenset[str] = frozenset()

    @property
    def name(self) -> str:
        """Campaign and mount."""
        return f"{self.campaign}/{self.mount}" if self.mount else self.campaign


def members_of(names: Sequence[str], derived: Path) -> list[Member]:
    """The campaigns with what they say; one of the same logs as another is not pooled.

    Raises
    ------
    Refusal
        where a table is missing or damaged, or simulated and real campaigns are mixed
    """
    members: list[Member] = []
    of_logs: dict[str, str] = {}
    for name in names:
        for member in _members(name, derived / name):
            twin = next((of_logs[log] for log in member.logs if of_logs.get(log, name) != name), "")
            members.append(
                replace(member, reason=_("same logs as {name}", name=twin) if twin else "")
            )
            of_logs.update(dict.fromkeys(member.logs, name) if not twin else {})
    if len({member.simulated for member in members}) > 1:
        real, simulated = (
            next(m.campaign for m in members if m.simulated == which) for which in (False, True)
        )
        raise Refusal(
            "SELECT",
            "",
            _("{real} is real and {simulated} simulated", real=real, simulated=simulated),
            _("campaigns of one kind"),
            _("name the campaigns one by one"),
        )
    return members


def _members(name: str, folder: Path) -> Iterator[Member]:
    frames = read_declared(folder, READ)
    about = frames["campaign"].iloc[0]
    compensated = _(", compensated logs") if about["compensated"] else ""
    kind = f"{about['instrument']}{compensated}"
    imu = (
        f"{kind} {about['serial']}" if about["serial"] != UNKNOWN else _("IMU of {name}", name=name)
    )
    table = about["table"]
    references = _references(frames, named=table not in NAMELESS)
    if not references.named:
        table = _("table of {name}", name=name)
    inputs = frames["inputs"]
    logs = frozenset(inputs.loc[inputs["file"] != "campaign.yaml", "sha256"])
    result = frames["result"]
    result = result[result["effect"].isna() & result["value"].notna() & result["sigma"].notna()]
    covariance = {
        pair: value
        for first, second, value in frames["covariance"].itertuples(index=False)
        for pair in ((first, second), (second, first))
    }
    for mount in sorted({*frames["score"]["mount"], *result["mount"]}):
        score, information, own = (
            frame[frame["mount"] == mount]
            for frame in (frames["score"], frames["information"], result)
        )
        places = list(zip(score["effect"], score["parameter"], strict=True))
        yield Member(
            name,
            mount,
            kind,
            imu,
            str(table),
            bool(about["simulated"]),
            logs,
            dict(zip(places, score["score"], strict=True)),
            dict(zip(places, score["unit"], strict=True)),
            information,
            *_parameters(own, covariance),
            _gravity(frames["known"]),
            _by_table_of(frames["uncertainty_budget"], mount),
            references,
            named=_named(frames["scores"], mount),
        )


def _named(scores: pd.DataFrame, mount: str) -> frozenset[str]:
    return frozenset(scores.loc[(scores["mount"] == mount) & scores["named"], "effect"])


def _parameters(rows: pd.DataFrame, known: Mapping[tuple[str, str], float]) -> tuple[Array, Array]:
    by_place = {(row.sensor, row.parameter): row for row in rows.itertuples()}
    found: list[Any] = [by_place.get(place) for place in PARAMETERS]
    values = np.array([np.nan if row is None else row.value for row in found])
    covariance = np.zeros((len(found), len(found)))
    for i, one in enumerate(found):
        for j, other in enumerate(found):
            if one is not None and other is not None:
                covariance[i, j] = known.get((one.id, other.id), 0.0)
        covariance[i, i] = one.sigma**2 if one is not None else 1.0
    return values, covariance


def _gravity(known: pd.DataFrame) -> tuple[float, float]:
    row = known[known["quantity"] == "gravity"].iloc[0]
    return float(row["value"]), float(np.nan_to_num(row["sigma"]))


def _by_table_of(budget: pd.DataFrame, mount: str) -> Array:
    own = budget[(budget["mount"] == mount) & (budget["source"] == TABLE_RATE)]
    sizes = own.set_index(["sensor", "quantity"])["sigma"]
    return np.array([float(sizes.get(place, 0.0)) for place in PARAMETERS])


def _references(frames: Mapping[str, pd.DataFrame], *, named: bool) -> References:
    manoeuvres, known = frames["manoeuvres"], frames["known"]
    turns = manoeuvres[manoeuvres["do"] == "turn"]
    stated = known[~known["assumed"] & known["sigma"].gt(0)].set_index("quantity")["sigma"]
    angle = float(turns["angle"].abs().median())
    sigmas = {
        "rate": stated.get("turn_rate"),
        "angle": stated["turn_angle"] / angle if angle > 0 and "turn_angle" in stated else None,
        "gravity": stated["gravity"] / known.set_index("quantity")["value"]["gravity"]
        if "gravity" in stated
        else None,
    }
    return References(
        named,
        frozenset(turns["recorded"]),
        {key: float(sigma) for key, sigma in sigmas.items() if sigma is not None},
    )


def labels_of(members: Sequence[Member]) -> dict[str, list[str]]:
    """The groups of the levels."""
    return {
        "type": [m.type for m in members],
        "table": [m.table for m in members],
        "imu": [m.imu for m in members],
        "campaign": [m.name for m in members],
    }


def evidence_of(members: Sequence[Member]) -> tuple[FleetEvidence, dict[str, list[Place]]]:
    """The evidence of all, and the parameters of each effect."""
    effects: dict[str, dict[Place, None]] = {}
    for member in members:
        for place in member.score:
            effects.setdefault(place[0], {})[place] = None
    every = [place for own in effects.values() for place in own]
    column = {place: i for i, place in enumerate(every)}
    information = np.zeros((len(members), len(every), len(every)))
    right = np.zeros((len(members), len(every)))
    for number, member in enumerate(members):
        for place, value in member.score.items():
            right[number, column[place]] = value
        table = member.information
        rows = [column[p] for p in zip(table["effect"], table["parameter"], strict=True)]
        beside = zip(table["with_effect"], table["with_parameter"], strict=True)
        columns = [column[p] for p in beside]
        information[number, rows, columns] = table["information"]
        information[number, columns, rows] = table["information"]
    of_effect = {name: [column[place] for place in own] for name, own in effects.items()}
    places = {name: list(own) for name, own in effects.items()}
    return FleetEvidence(of_effect, information, right, labels_of(members)), places


def scale_factors_of(members: Sequence[Member], sensor: str) -> ScaleFactors:
    """The scale factors of a sensor, without the errors of references that campaigns have alike.

    Along each input axis: the lengths of the rows of M, which another mounting does not change.
    """
    kept = [m for m in members if m.references.named]
    first = PARAMETERS.index((sensor, linear_names()[0]))
    of_matrix = slice(first, first + 9)
    values, covariances = np.full((len(kept), 3), np.nan), np.zeros((len(kept), 3, 3))
    for number, member in enumerate(kept):
        covariance = _without_references(member)
        found = member.values[of_matrix].reshape(3, 3)
        rows = np.eye(3) + np.nan_to_num(found)
        length = np.linalg.norm(rows, axis=1)
        slope = np.zeros((3, 9))
        for axis in range(3):
            slope[axis, 3 * axis : 3 * axis + 3] = rows[axis] / length[axis]
        slope *= np.isfinite(found).ravel()
        values[number] = np.where(np.isfinite(np.diag(found)), length - 1, np.nan)
        covariances[number] = slope @ covariance[of_matrix, of_matrix] @ slope.T
    imus, tables = tuple(m.imu for m in kept), tuple(m.table for m in kept)
    return ScaleFactors(values, covariances, imus, tables, tuple(m.name for m in kept))


# ---- Errors of references: campaigns that take the same as known contain them alike.


def campaigns_of_type(members: Sequence[Member]) -> Campaigns:
    """The parameters of the campaigns of one type, without such errors in their sigmas."""
    return Campaigns(
        np.array([m.values for m in members]),
        np.array([_without_references(m) for m in members]),
        labels_of(members),
    )


def of_references(members: Sequence[Member]) -> Array:
    """Sigma of the means by such errors, (24,): one for each value of gravity and each table."""
    variance = np.zeros(len(PARAMETERS))
    for gravity in {m.gravity for m in members}:
        own = np.array([_by_gravity(m) * (m.gravity == gravity) for m in members])
        variance += own.mean(axis=0) ** 2
    for table in {m.table for m in members}:
        own = np.array([_by_table(m) * (m.table == table) for m in members])
        variance += own.mean(axis=0) ** 2
    return np.sqrt(variance)


def _without_references(member: Member) -> Array:
    """The covariance of the parameters, (24, 24), without the errors of gravity and the table."""
    moved = np.column_stack([_by_gravity(member), _by_table(member)])
    return member.covariance - moved @ moved.T


def _by_gravity(member: Member) -> Array:
    """By one sigma of gravity: a relative error is the opposite of that in all scale factors."""
    value, sigma = member.gravity
    return _in_scales(member, "accel", sigma / value)


def _by_table(member: Member) -> Array:
    """By one sigma of the share by which all rates of the table are off."""
    return _in_scales(member, "gyro", member.by_table)


def _in_scales(member: Member, sensor: str, size: float | Array) -> Array:
    most = np.sqrt(np.diag(member.covariance) * MAX_SHARE)
    of = np.array([place in SCALES[sensor] for place in PARAMETERS])
    return np.where(of & np.isfinite(member.values), np.minimum(size, most), 0.0)
