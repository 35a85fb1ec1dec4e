"""How large the effects in the model of the result are."""

from collections.abc import Iterable

from inertial.campaign.records import Row


def sizes_of_result(parameters: Iterable[Row]) -> dict[tuple[str, str, str], Row]:
    """The rows of the result that are parameters of effects, by mount, effect and parameter.

    Of an effect in the models of both sensors those with the smaller sigma.
    """
    found: dict[tuple[str, str, str], Row] = {}
    for row in parameters:
        if row["effect"] is not None and row["sigma"]:
            key = (row["mount"], row["effect"], row["parameter"].rpartition(".")[2])
            found[key] = min(found.get(key, row), row, key=lambda one: one["sigma"])
    return found
