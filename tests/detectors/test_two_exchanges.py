"""Two pairs of manoeuvres of one log that were done in the other order than planned."""

from typing import Any

import chain
import numpy as np
import pytest

import laboratory


def of_one_log() -> dict[str, Any]:
    """The short campaign in one log."""
    document = chain.short()
    for manoeuvre in document["campaign"]["plan"]:
        del manoeuvre["log"]
    document["campaign"]["log"] = "session.asc"
    document["handling"]["change_s"] = 10
    return document


def as_stated(*pairs: tuple[str, str], without: tuple[str, ...] = ()) -> chain.Tables:
    """The campaign up to gyroscope, its file with exchanged lines; some of it was not done."""
    document = of_one_log()
    plan = document["campaign"]["plan"]
    stated = {one["id"]: dict(one) for one in plan}
    document["campaign"]["plan"] = [one for one in plan if one["id"] not in without]

    def edit(text: str) -> str:
        lines = text.splitlines(keepends=True)
        places = {
            name: k for name in stated for k, line in enumerate(lines) if f"id: {name}," in line
        }
        for one, two in pairs:
            a, b = places[one], places[two]
            lines[a], lines[b] = lines[b], lines[a]
        for name in without:
            before = list(stated)[list(stated).index(name) - 1]
            other = {"down": "up", "backward": "forward"}[name.partition("-")[2]]
            like = lines[places[f"{name[0]}-{other}"]]
            own = like.replace(f"{name[0]}-{other},", f"{name},").replace("+", "-", 1)
            own = own.replace("degrees: 360", "degrees: -360")
            lines[places[before]] += own
        return "".join(lines)

    recording = laboratory.perform(laboratory.specify(document))
    return chain.in_memory(recording, "gyroscope", edit=edit)


@pytest.mark.slow
@pytest.mark.parametrize(
    "second", [("x-forward", "x-backward"), ("x-down", "z-down"), ("z-up", "z-forward")]
)
def test_two_independent_exchanges_in_one_log_are_both_set_right(second):
    """Each explains one observation more, for one of a pair is found as it is."""
    tables = as_stated(("y-up", "y-down"), second)
    assert tables["segment/performed"]["complete"].all()
    states = tables["segment/repairs"].set_index("id")["state"]
    assert len(states) == 2 and set(states) == {"applied"}
    assert "exchanged_manoeuvres/y-down/y-up" in states.index
    scale = tables.parameters("gyroscope").filter(like="scale", axis=0)
    away = scale["value"] - (np.diag(of_one_log()["truth"]["gyro"]["matrix"]) - 1)
    assert (abs(away) < 4.5 * scale["sigma"]).all()


@pytest.mark.slow
def test_two_manoeuvres_that_were_not_done_are_no_exchanges():
    tables = as_stated(without=("y-down", "x-backward"))
    assert tables["segment/repairs"].empty
    found = tables["segment/findings"]
    assert set(found["cause"]) == {"manoeuvre_missing"}
    assert set(found["manoeuvre"]) == {"y-down", "x-backward"}
