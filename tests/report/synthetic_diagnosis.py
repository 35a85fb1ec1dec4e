"""What the diagnosis says of a synthetic campaign: causes, consequences, verdict and result."""

from __future__ import annotations

from typing import Any

import pandas as pd

from inertial import tables
from tests.report.synthetic_values import GAP_FINDING, RINGING_FINDING, Rows, rows_as

FINDINGS = ("quality", "segment", "accelerometer", "criticism")
# What explains what, where both are found.
EXPLAINS = {
    "segment/incomplete/z-backward": GAP_FINDING,
    RINGING_FINDING: "criticism/oscillation",
}
CURES: dict[str, dict[str, Any]] = {
    "gap": {"cure": "interpolated", "done": "It is bridged by the rate beside it."},
    "gyro_g_sensitivity": {
        "cure": "modelled",
        "done": "It is in the model of the result.",
        "gain": "χ² of held-out manoeuvres is lower by 12070.",
        "moves": 4.0,
        "size": 6.9e-7,
        "sigma": 1.4e-8,
        "unit": "(rad/s)/(m/s²)",
    },
    "oscillation": {"cure": "none", "done": "Nothing need be done.", "moves": 0.001},
    "gravity_error": {
        "cure": "repaired",
        "done": "Normal gravity is used.",
        "gain": "With it 6 of 6 observations fit the plan, without it 0.",
        "condition": "gravity is that of the formula",
        "moves": 240.0,
    },
}
SENTENCES = {
    "gyro": "Gyros: usable, with these departures from the ideal: gyro g-sensitivity "
    "(corrected by a further term: use it).",
    "accel": "Accelerometers: usable. "
    "No fault was detected; the report states the detection limits.",
}


def diagnosed(made: dict[str, Any]) -> dict[str, Any]:
    """A cause for every finding that no other one explains."""
    found = {
        row["id"]: {str(key): None if value is pd.NA else value for key, value in row.items()}
        | {"stage": stage}
        for stage in FINDINGS
        for row in _records(made[f"{stage}_findings"])
    }
    owner = {name: EXPLAINS.get(name, name) for name in found}
    owner = {name: cause if cause in found else name for name, cause in owner.items()}
    causes = [_cause(found[name]) for name, cause in owner.items() if name == cause]
    consequences = [
        {"finding": name, "stage": found[name]["stage"], "cause": f"diagnosis/{cause}"}
        for name, cause in owner.items()
    ]
    members = [
        {
            "id": f"diagnosis/{row['finding']}/{row['rank']}",
            "cause": f"diagnosis/{row['finding']}",
            "mount": row["mount"],
            "rank": row["rank"],
            "member": row["effect"],
            "probability": None,
        }
        for row in _records(made["members"])
    ]
    return {
        "causes": rows_as(tables.CAUSES, causes),
        "cause_members": rows_as(tables.CAUSE_MEMBERS, members),
        "consequences": pd.DataFrame(tables.CONSEQUENCES.arrow(consequences).to_pandas()),
    }


def _records(frame: pd.DataFrame) -> Rows:
    plain = frame.astype(object).where(frame.notna(), None)
    return [{str(key): value for key, value in row.items()} for row in plain.to_dict("records")]


def _cause(row: dict[str, Any]) -> dict[str, Any]:
    same = ("cause", "mount", "sensor", "axis", "log", "manoeuvre", "count", "sentence")
    same += ("size", "unit", "p_value", "consequence", "action")
    cure = {"cure": "none", "done": "Nothing was done about it."} | CURES.get(row["cause"], {})
    kept = {"id": f"diagnosis/{row['id']}", "verdict": row.get("verdict") or "found"}
    own = {"unit": row["unit"] or "", "snr": row.get("snr")}
    return {key: row[key] for key in same} | own | kept | cure


def verdicts() -> Rows:
    """The extended result of the gyros counts, and the joint one of the accelerometers."""
    told = {
        "gyro": "The result of the gyros includes gyro g-sensitivity.",
        "accel": "The joint result of the accelerometers counts: they show no effect.",
    }
    return [
        {
            "sensor": sensor,
            "mount": "",
            "recorded": True,
            "verdict": "usable_within_limits" if sensor == "gyro" else "usable",
            "sentence": SENTENCES[sensor],
            "method": "extended" if sensor == "gyro" else "joint",
            "reason": reason,
        }
        for sensor, reason in told.items()
    ]


def counted(made: dict[str, Any]) -> pd.DataFrame:
    """The result that counts: of the gyros the extended one, of the accelerometers the joint."""
    joint = made["accelerometer_parameters"].query("method == 'joint'")
    joint = joint[joint["parameter"].str.match("bias|scale|cross")]
    both = pd.concat([made["extended_parameters"], joint], ignore_index=True)
    stage = both["sensor"].map({"gyro": "gyroscope", "accel": "accelerometer"})
    return both.assign(id="diagnosis/" + stage + "/" + both["parameter"], stage="diagnosis")
