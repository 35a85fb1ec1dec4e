"""Whether the extended result of a sensor replaces the joint one, and the parameters that count.

It does where the model with the effects foretells what its fit has not seen better than the one
without, and nothing says that it is not the whole truth either.
"""

from collections.abc import Mapping, Sequence
from typing import Any

from inertial.estimation.triad import linear_names
from inertial.text.cause_names import in_words
from stages.extension.cross_validation import MIN_SNR_SQUARED, HeldOut
from stages.extension.estimates import Solved
from stages.extension.named_effects import Named

Row = dict[str, Any]

JOINT, EXTENDED = "joint", "extended"
SENSORS = {"gyro": "gyros", "accel": "accelerometers"}


def decision(
    sensor: str,
    mount: str,
    named: Named,
    solution: Solved | None,
    found: HeldOut | None,
    joint: Sequence[Row],
) -> Row:
    """The row of a sensor; `joint`: rows of its joint result."""
    alarms = named.alarms.get(sensor, ())
    effects = tuple(
        dict.fromkeys(row["parameter"].partition(".")[0] for row in solution.of_effects)
        if solution
        else ()
    )
    reason = _against(sensor, alarms, effects, solution, found, joint)
    sentence = reason or _for(sensor, effects, found)
    row: Row = {
        "sensor": sensor,
        "mount": mount,
        "result": JOINT if reason else EXTENDED,
        "effects": ", ".join(effects),
        "drop": None,
        "snr_squared": None,
        "folds": None,
        "counted": None,
        "alarms": ", ".join(alarms),
        "sentence": sentence + _classes(effects, named.classes) + _alone(found),
    }
    if found is not None:
        row |= {"drop": found.drop - found.walked, "snr_squared": found.at_stake}
        row |= {"folds": len(found.folds), "counted": len(found.counted)}
    return row


def _against(
    sensor: str,
    alarms: Sequence[str],
    effects: Sequence[str],
    solution: Solved | None,
    found: HeldOut | None,
    joint: Sequence[Row],
) -> str:
    """Why the joint result stays; empty where it does not."""
    name = SENSORS[sensor]
    if not any(row["value"] is not None for row in joint):
        return f"There is no joint result of the {name}."
    if alarms and not effects:
        return (
            f"The joint result of the {name} counts, and its sigmas with a doubt: something is not"
            f" understood ({_listed(alarms)})."
        )
    if solution is None or found is None or not effects:
        return f"The joint result of the {name} counts: they show no effect that was named."
    said = f"The joint result of the {name} counts, though {_listed(effects)} was named: "
    if alarms:
        return f"{said}beside it something is not understood ({_listed(alarms)})."
    if not found.possible:
        return (
            f"{said}it is not cross-validatable, for the manoeuvres that can be foretold from the"
            f" others hold too little of it (SNR² {max(found.at_stake, 0.0):.1f}, less than"
            f" {MIN_SNR_SQUARED:.0f})."
        )
    if found.drop <= found.walked:
        return (
            f"{said}manoeuvres that the fit has not seen are foretold no better with it (χ² grows"
            f" by {found.walked - found.drop:.1f})."
        )
    extended = {row["parameter"] for row in solution.of_sensor if row["value"] is not None}
    lost = [
        r["parameter"] for r in joint if r["value"] is not None and r["parameter"] not in extended
    ]
    if lost:
        return f"{said}beside it {', '.join(lost)} would not be determined."
    return ""


def _for(sensor: str, effects: Sequence[str], found: HeldOut | None) -> str:
    assert found is not None  # else the joint result stays
    return (
        f"The extended result of the {SENSORS[sensor]} counts, with {_listed(effects)}: χ² of"
        f" manoeuvres that the fit has not seen drops by {found.drop:.1f}, of"
        f" {found.at_stake:.1f} that exactly known effects would bring, and no alarm fires."
        + _walk(found)
    )


def _walk(found: HeldOut) -> str:
    if found.walked <= 0:
        return ""
    return (
        " Against the joint fit, which has taken some of it for a walk of the biases, it drops by"
        f" {found.drop - found.walked:.1f}."
    )


def _classes(effects: Sequence[str], classes: Mapping[str, Sequence[str]]) -> str:
    told = ""
    for effect in effects:
        if others := [name for name in classes.get(effect, ()) if name != effect]:
            told += (
                f" Instead of {in_words(effect)} it may be {_listed(others, 'or')}: that would do"
                " the same to these data, within their noise."
            )
    return told


def _alone(found: HeldOut | None) -> str:
    if found is None or not found.left_out:
        return ""
    names = ", ".join(found.left_out)
    return (
        f" Not counted: {names}; without it the others show less than half of the effect."
        if len(found.left_out) == 1
        else f" Not counted: {names}; without each the others show less than half of the effect."
    )


def result(decided: Row, solution: Solved | None, joint: Sequence[Row]) -> list[Row]:
    """The rows of the twelve parameters of a sensor that count."""
    if decided["result"] == EXTENDED and solution is not None:
        return solution.of_sensor
    own = {row["parameter"]: row for row in joint}
    return [own[name] for name in linear_names() if name in own]


def _listed(causes: Sequence[str], last: str = "and") -> str:
    names = [in_words(cause) for cause in causes]
    return names[0] if len(names) == 1 else f"{', '.join(names[:-1])} {last} {names[-1]}"
