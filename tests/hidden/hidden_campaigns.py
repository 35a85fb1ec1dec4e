"""A drawn campaign through the stages, and what criticism and extension made of it."""

import tempfile
import time
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import chain
import numpy as np
import pandas as pd
from hidden_draws import Draw
from hidden_sizes import BESIDE, apart, code, reference

import laboratory

CLEAR = ("found", "one_of_class")
Outcome = dict[str, Any]


NOTHING_SAID: Outcome = {
    "named": [],
    "unexplained": [],
    "quality": [],
    "pulls": [],
    "curse": {},
    "gain": [],
}


def run(draw: Draw) -> Outcome:
    """What was hidden and what was found, as plain numbers and text; or the error it ended with."""
    told = {
        "number": draw.number,
        "code": code(),
        "plan": draw.plan,
        "kind": draw.kind,
        "sort": draw.sort,
        "grade": draw.grade,
        "hidden": list(draw.hidden),
        "ratios": draw.ratios,
        "on_disk": draw.on_disk,
    }
    if draw.kind == "single" and draw.sort == "ratio":
        told["limits"] = reference(draw.plan).limits(*next(iter(draw.ratios.items())))
    if draw.kind == "several":
        told["apart"] = apart(draw.plan, draw.truth, draw.at)
        told["limit"] = reference(draw.plan).limit_together(draw.truth, draw.at)
    try:
        return told | _found(draw)
    except Exception as error:  # it is counted, and the others go on
        return told | NOTHING_SAID | {"error": f"{type(error).__name__}: {error}"}


def _found(draw: Draw) -> Outcome:
    """What the stages made of it, and what that took."""
    start = time.process_time()
    recording = laboratory.perform(laboratory.specify(draw.document()))
    performed = written = time.process_time()
    with tempfile.TemporaryDirectory() as name:
        folder, results = Path(name), chain.Results(Path(name) / "derived")
        if draw.on_disk:
            laboratory.write(recording, folder / "raw")
            written = time.process_time()
            chain.run(folder / "raw", results.folder, "extension")
        else:
            results = chain.in_memory(recording, "extension", BESIDE)
        seconds = time.process_time() - written
        outcome = {
            "samples": sum(len(records) for records in recording.records.values()),
            "simulating": performed - start,
            "seconds": seconds,
        }
        outcome |= _said(results) | _estimated(draw, results)
        outcome["gain"] = _gain(results)
        if draw.twin:
            outcome["shift"] = _shift(draw, results)
        return outcome


def _said(results: chain.Results) -> Outcome:
    """The findings of criticism, and the causes that quality and segmentation name."""
    findings = results["criticism/findings"]
    causes = findings[findings["verdict"].notna()]
    rest = findings[findings["verdict"].isna()]
    members = results["criticism/members"].groupby("finding")["effect"].agg(list)
    named = [
        {"cause": row["cause"], "verdict": row["verdict"]}
        | {"snr": float(row["snr"]) if pd.notna(row["snr"]) else None}
        | {"members": members.get(row["id"], [])}
        for row in causes.to_dict("records")
    ]
    quality = [results[f"{stage}/findings"] for stage in ("quality", "segment")]
    return {
        "named": named,
        "unexplained": sorted(set(rest["cause"])),
        "quality": sorted({str(cause) for table in quality for cause in table["cause"]}),
    }


def _estimated(draw: Draw, results: chain.Results) -> Outcome:
    """Errors of named effects in sigma, and their size along the true direction over the truth."""
    findings = results["criticism/findings"]
    clear = set(findings.loc[findings["verdict"].isin(CLEAR), "cause"])
    effects = results["criticism/effects"].drop_duplicates(["effect", "parameter"])
    effects = effects.set_index(["effect", "parameter"])
    pulls, curse = [], {}
    for name, values in draw.truth.items():
        if name not in clear:
            continue
        rows = [effects.loc[(name, parameter)] for parameter in values]
        found = np.array([row["value"] for row in rows], np.float64)
        sigmas = np.array([row["sigma"] for row in rows], np.float64)
        errors = (found - list(values.values())) / sigmas
        pulls += errors[np.isfinite(errors)].tolist()
        if np.isfinite(found).all():
            plan = reference(draw.plan)
            truth = np.array([*values.values()])
            curse[name] = plan.along(name, draw.at.get(name), found, truth)
    return {"pulls": pulls, "curse": curse}


def _gain(results: chain.Results) -> list[Mapping[str, Any]]:
    """What the extension gained on manoeuvres that the fit had not seen, for each sensor.

    `whole`: SNR² of the effects in all manoeuvres; `at_stake`: in those that were held out.
    """
    table = results["extension/gain"]
    own = table[table["axis"].isna()]
    whole = own[own["scope"] == "fitted"].set_index(["sensor", "model"])["snr_squared"]
    effects = (
        results["extension/gain_effects"].groupby(["sensor", "model"])["effect"].agg(", ".join)
    )
    return [
        {
            "sensor": str(row["sensor"]),
            "effects": effects[row["sensor"], row["model"]],
            "drop": float(row["drop"]),
            "at_stake": float(row["snr_squared"]),
            "whole": float(whole[row["sensor"], row["model"]]),
        }
        for row in own[own["scope"] == "held-out"].to_dict("records")
        if np.isfinite(row["drop"])
    ]


def _shift(draw: Draw, results: chain.Results) -> float:
    """The largest change of the 24 parameters by what is hidden, in sigma."""
    twin = laboratory.perform(laboratory.specify(draw.document(effects={})))
    without = chain.in_memory(twin, "gyroscope", BESIDE)
    largest = 0.0
    for stage in ("accelerometer", "gyroscope"):
        one, other = (some.parameters(stage) for some in (results, without))
        moved = (one["value"] - other["value"]).abs() / other["sigma"]
        kept = [name for name in moved.index if not str(name).startswith(("position", "azimuth"))]
        largest = max(largest, float(moved[kept].max()))
    return largest
