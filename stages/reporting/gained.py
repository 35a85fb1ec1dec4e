"""What an effect in the model brings, in sentences: nearer to the data, and worth to a user."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from stages.reporting.certainty import SENSORS, listed
from stages.reporting.extended_parameters import Shift
from stages.reporting.rows import Record

TOO_LITTLE = 9.0  # SNR² below which held-out data tell nothing of an effect: three sigma
FITTED, HELD_OUT = "fitted", "held-out"


def effects_of(row: Record) -> list[str]:
    """The effects that a row of the gain, or of the decision, is about."""
    return [name for name in (row["effects"] or "").split(", ") if name]


def gained(cause: str, mount: str, gain: Sequence[Record]) -> Iterator[str]:
    """How much nearer the model comes to the data with an effect."""
    own = [row for row in gain if cause in effects_of(row) and (row["mount"] or "") == mount]
    for sensor in SENSORS:
        by_scope = {row["scope"]: row for row in own if row["sensor"] == sensor}
        if HELD_OUT in by_scope:
            yield _on_held_out(by_scope[HELD_OUT])
        if FITTED in by_scope:
            row = by_scope[FITTED]
            yield f"In the fit it {_changes(row)}."
    for row in own:
        if row["unit"] != "sigma" and row["scope"] == HELD_OUT:
            _, _, axis = row["sensor"].partition(" ")
            gyro = f"{axis} gyro" if axis else "gyros"
            before, after = (numbers.significant(row[f"rms_{at}"], 3) for at in ("before", "after"))
            unit = numbers.shortened(row["unit"], 20)
            yield (
                f"The residuals of the {gyro} fall from {before} {unit} to {after} {unit} rms on "
                "turns that were not fitted."
            )


def _on_held_out(row: Record) -> str:
    effects = effects_of(row)
    names = listed([in_words(name) for name in effects])
    together = f"With {names} together " if len(effects) > 1 else ""
    if not row["counted"] and row["folds"]:
        return (
            "No manoeuvre can be foretold from the others, so there is no gain on data that were "
            "not fitted."
        )
    said = f"{together}χ² of the {SENSORS[row['sensor']]} {_changes(row)} on data that were not "
    said += "fitted"
    stake = row["snr_squared"]
    if stake is not None and stake >= TOO_LITTLE:
        said += f", {numbers.fixed(100 * row['drop'] / stake, 0)} % of what was at stake"
    elif stake is not None:
        said += ", where too little was at stake to say more"
    if left_out := (row["left_out"] or ""):
        said += f"; not foretold, for the others hardly show it: {numbers.shortened(left_out, 200)}"
    return f"{said}."


def _changes(row: Record) -> str:
    size = numbers.whole(abs(row["drop"])) if abs(row["drop"]) >= 100 else _one(abs(row["drop"]))
    way = "falls" if row["drop"] >= 0 else "grows"
    return f"{way} by {size} of {numbers.whole(row['before'])}"


def _one(value: float) -> str:
    return numbers.fixed(value, 1)


def worth(effects: Sequence[str], rows: Sequence[Record]) -> str:
    """What a user of the joint result loses by the effects, at rest and turning; or nothing."""
    ways = {"rest": "at rest", "turn": "while it turns"}
    told = []
    for motion, where in ways.items():
        own = [row for row in rows if row["motion"] == motion]
        if own:
            errors = [
                _worst(own, what, 1e-3, unit)
                for what, unit in (("attitude", "mrad"), ("velocity", "mm/s"))
                if any(row[f"{what}_joint"] for row in own)
            ]
            if not errors:
                continue
            both = (" and ".join(each) for each in zip(*errors, strict=True))
            told.append([f"{each} {where}" for each in both])
    if not told:
        return ""
    joint, left = (", ".join(each) for each in zip(*told, strict=True))
    seconds = numbers.whole(rows[0]["seconds"])
    every = "" if len(effects) < 2 else f", by {listed([in_words(name) for name in effects])}"
    return (
        f"After {seconds} s of free inertial navigation, the attitude known at the start, who "
        f"corrects with the joint result is off by up to {joint}{every}. The extended result "
        f"leaves at most {left} uncertain."
    )


def _worst(rows: Sequence[Record], what: str, size: float, unit: str) -> tuple[str, str]:
    """The largest error with the joint result, and what the extended one leaves there at most."""
    row = max(rows, key=lambda row: float(row[f"{what}_joint"]))
    value, sigma = row[f"{what}_joint"] / size, row[f"{what}_joint_sigma"] / size
    text = " ± ".join(numbers.with_sigma(value, sigma, numbers.decimals_of(sigma, 1)))
    left = max(row[f"{what}_extended"] for row in rows) / size
    return f"{text} {unit}", f"{numbers.significant(left, 2)} {unit}"


def moved(shifts: Sequence[Shift]) -> str:
    """Which parameter of a sensor moves most with the effects in the model; or nothing."""
    if not shifts:
        return ""
    most = max(shifts, key=lambda one: abs(one.sigmas))
    unit = units.quantity(most.joint["parameter"], most.joint["unit"]).laboratory
    before, after = (
        " ± ".join(numbers.with_sigma(unit.of(row["value"]), sigma, numbers.decimals_of(sigma)))
        for row in (most.joint, most.extended)
        for sigma in [unit.of(row["sigma"])]
    )
    return (
        f"{most.name} moves most of its parameters: from {before} to {after} {unit.name}, by "
        f"{numbers.fixed(most.sigmas, 1)} σ of the joint fit."
    )
