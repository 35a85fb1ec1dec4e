"""The rows that criticism writes of structures that are left: tests, pictures and findings."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from inertial.model_selection.cause import UNKNOWN_STRUCTURE
from inertial.model_selection.structure_tests import Structure
from inertial.text.cause_names import in_words
from inertial.text.numbers import p_is, significant
from stages.criticism.structure import Tested, points

Row = dict[str, Any]

CAUSE = "unknown_structure"
SENSORS = {"gyro": "gyros", "accel": "accelerometers"}
UNITS = {"gyro": "rad/s", "accel": "m/s²"}
ACROSS = {"time": "s", "change": "s", "angle": "rad", "rate": "rad/s", "attitude": "rad"}


def rows(told: Tested, method: str) -> Iterator[Row]:
    """The six tests."""
    for test in told.tests:
        yield {
            "method": method,
            "kind": test.kind,
            "channel": test.channel,
            "place": test.where if np.isfinite(test.where) else None,
            "statistic": test.statistic,
            "degrees": test.degrees,
            "p_value": test.p_value,
            "fires": test.fires,
        }


def pictures(told: Tested, method: str) -> Iterator[Row]:
    """What there is to be seen of each structure that was found."""
    for test in told.firing:
        for point in points(told, test):
            yield {
                "method": method,
                "kind": test.kind,
                "channel": test.channel,
                "x": point.x,
                "x_unit": ACROSS.get(test.kind, "K"),
                "left": point.left,
                "sigma": point.sigma,
                "structure": point.structure,
                "unit": UNITS[test.channel.split()[0]],
            }


def findings(told: Tested, named: Mapping[str, Sequence[str]], suffix: str) -> Iterator[Row]:
    """A finding for each sensor that has a structure.

    `named`: of each sensor the effects with which the data are no more than consistent.
    """
    for sensor, words in SENSORS.items():
        found = told.of(sensor)
        if not found:
            continue
        best = found[0]
        consistent = [in_words(name) for name in named.get(sensor, ())]
        said = [f"What the model leaves of the {words} is not noise: {_where(best)}."]
        if others := [_about(test) for test in found[1:]]:
            said.append(f"It shows in {' and in '.join(others)} too.")
        if consistent:
            said.append(f"The data are no more than consistent with {' and '.join(consistent)}.")
        yield {
            "id": f"criticism/{CAUSE}/{sensor}{suffix}",
            "cause": CAUSE,
            "sensor": sensor,
            "count": len(found),
            "size": best.statistic**0.5,
            "unit": "sigma",
            "p_value": best.p_value,
            "severity": 2,
            "sentence": " ".join(said),
            "consequence": "The joint result stands as it is: no effect by name is added to it for"
            " this sensor, and its sigmas do not know of what is left.",
            "action": "Look at the picture of what is left; record the manoeuvres concerned again.",
            "verdict": UNKNOWN_STRUCTURE,
            "members": ", ".join(named.get(sensor, ())),
            "statistic": best.statistic,
            "degrees": best.degrees,
            "snr": float(np.sqrt(max(best.statistic - best.degrees, 0.0))),
        }


def _where(test: Structure) -> str:
    """The clearest structure, for a person."""
    axis = test.channel.split()[1]
    place = {
        "time": f"about {axis} it oscillates in time, every {significant(1 / test.where)} s"
        if test.where > 0
        else f"about {axis} it drifts smoothly with time",
        "angle": f"about {axis} it goes with the angle of the table, {test.where:g} times in a turn"
        if test.where > 0
        else f"about {axis} it goes with the angle of the table",
        "rate": f"on {axis} it goes with the rate of the turns",
        "attitude": f"on {axis} it goes with the attitude",
        "temperature": f"on {axis} it goes with the temperature",
        "change": f"on {axis} it changes at {test.where:.0f} s",
    }[test.kind]
    return f"{place} ({p_is(test.p_value)})"


def _about(test: Structure) -> str:
    return f"{'a change in time' if test.kind == 'change' else test.kind} ({test.channel})"
