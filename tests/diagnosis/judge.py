"""What a diagnosis says, against what is true: rows right, missing, extra; errors of the result."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from cases import NOT, Cause

Row = Mapping[str, Any]
Array = np.ndarray[Any, np.dtype[np.float64]]
ICE_POINT = 273.15  # K
# Of the laboratory: sensor, what changes with temperature, key, unit of the key.
PER_KELVIN = (
    ("gyro", "bias", "k_deg_h_k", np.radians(1 / 3600)),
    ("accel", "bias", "k_micro_g_k", 9.80665e-6),
    ("gyro", "scale", "k_ppm_k", 1e-6),
    ("accel", "scale", "k_ppm_k", 1e-6),
)
STATED = {"gyro": ("gyro", "bias_rad_s"), "accel": ("accelerometer", "bias_m_s2")}


@dataclass(frozen=True)
class Judgement:
    """`right`: causes with their row; `missing`: without one; `extra`: rows without a cause;
    `flawed`: what is wrong with a row that is right; `verdicts`: those that are wrong."""

    right: Sequence[str]
    missing: Sequence[str]
    extra: Sequence[str]
    flawed: Sequence[str] = ()
    verdicts: Sequence[str] = ()
    pulls: Mapping[str, float] = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """Whether exactly the right rows are there, and the right verdicts."""
        return not (self.missing or self.extra or self.flawed or self.verdicts)

    def __str__(self) -> str:
        parts = [
            f"{word}: {', '.join(told)}"
            for word, told in (
                ("missing", self.missing),
                ("extra", self.extra),
                ("flawed", self.flawed),
                ("verdict", self.verdicts),
            )
            if told
        ]
        return "; ".join(parts) or "right"


def judge(
    tables: Mapping[str, pd.DataFrame],
    wanted: Sequence[Cause],
    verdicts: Mapping[str, frozenset[str]] | None = None,
    truth: Mapping[str, Mapping[str, float]] | None = None,
) -> Judgement:
    """`tables`: causes, members, verdict, result of the stage diagnosis.

    `wanted`: every row that must be there; `verdicts`: by sensor, which are right; `truth`: by
    sensor the parameters, as `parameters_of` tells them.
    """
    rows = [dict(row) for row in tables["causes"].to_dict("records")]
    members = tables["members"].groupby("cause")["member"].agg(set).to_dict()
    right, missing, flawed = [], [], []
    for cause in wanted:
        row = next((row for row in rows if answers(row, members, cause)), None)
        if row is None:
            missing.append("|".join(sorted(cause.names)))
            continue
        rows.remove(row)
        right.append(str(row["cause"]))
        flawed += [f"{row['cause']}: {flaw}" for flaw in flaws(row, cause)]
    extra = [told(row, members) for row in rows]
    said = {str(row["sensor"]): str(row["verdict"]) for row in tables["verdict"].to_dict("records")}
    wrong = [
        f"{sensor} {said.get(sensor, 'nothing')}"
        for sensor, allowed in (verdicts or {}).items()
        if said.get(sensor) not in allowed
    ]
    return Judgement(right, missing, extra, flawed, wrong, pulls(tables["result"], said, truth))


def answers(row: Row, members: Mapping[str, set[str]], cause: Cause) -> bool:
    """Whether a row is that of a cause: by its own name, or by a member of its class."""
    classed = row["verdict"] == "one_of_class"
    names = {row["cause"]} | (members.get(row["id"], set()) if classed else set())
    return bool(names & cause.names) and cause.alone in (None, not classed)


def flaws(row: Row, cause: Cause) -> Iterator[str]:
    """What a row says that is wrong, though it is the right one."""
    for key in ("sensor", "axis", "manoeuvre"):
        wanted = getattr(cause, key)
        if wanted is not None and row[key] != wanted:
            yield f"{key} {row[key]}, not {wanted}"
    if cause.count is not None and row["count"] != cause.count:
        yield f"count {row['count']}, not {cause.count}"
    if cause.most_moves is not None and not (row["moves"] or 0.0) < cause.most_moves:
        yield f"moves {row['moves']}, not below {cause.most_moves}"


def told(row: Row, members: Mapping[str, set[str]]) -> str:
    """A row in a few words."""
    where = [str(row[key]) for key in ("sensor", "axis", "log", "manoeuvre") if pd.notna(row[key])]
    classed = members.get(row["id"], set()) - {row["cause"]}
    return " ".join([str(row["cause"]), *where, *(["/", *sorted(classed)] if classed else [])])


def parameters_of(document: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """By sensor the true scale factor errors, cross terms and biases: reading = M · truth + b."""
    told = {}
    for sensor, (key, bias) in STATED.items():
        truth = document["truth"][key]
        matrix = np.array(truth["matrix"], np.float64) - np.eye(3)
        told[sensor] = {
            f"cross_{i}{j}" if i != j else f"scale_{i}": float(matrix[a, b])
            for a, i in enumerate("xyz")
            for b, j in enumerate("xyz")
        } | {f"bias_{axis}": float(b) for axis, b in zip("xyz", truth[bias], strict=True)}
    return told


def at_reference(
    truth: Mapping[str, Mapping[str, float]], document: Mapping[str, Any], result: pd.DataFrame
) -> dict[str, dict[str, float]]:
    """The same at the temperature to which a result with an effect of temperature refers."""
    moved = {sensor: dict(values) for sensor, values in truth.items()}
    course = document.get("temperature", {})
    start = course.get("reference_deg_c", course.get("start_deg_c", np.nan)) + ICE_POINT
    for sensor, stem, key, unit in PER_KELVIN:
        name = f"{sensor}_{stem}_temperature"
        slopes = document.get("effects", {}).get(name, {}).get(key)
        reference = result.loc[result["parameter"] == f"{name}.T0", "value"]
        if slopes is None or reference.empty:
            continue
        for axis, slope in zip("xyz", slopes, strict=True):
            moved[sensor][f"{stem}_{axis}"] += slope * unit * (float(reference.iloc[0]) - start)
    return moved


def pulls(
    result: pd.DataFrame,
    verdicts: Mapping[str, str],
    truth: Mapping[str, Mapping[str, float]] | None,
) -> dict[str, float]:
    """Errors of the result that counts, in its sigmas, where it may be used."""
    found = {}
    for row in result.to_dict("records"):
        sensor, name = str(row["sensor"]), str(row["parameter"])
        if verdicts.get(sensor, NOT) == NOT or pd.notna(row["effect"]):
            continue
        true = (truth or {}).get(sensor, {}).get(name)
        if true is not None and pd.notna(row["value"]) and row["sigma"] > 0:
            found[f"{sensor} {name}"] = float((row["value"] - true) / row["sigma"])
    return found
