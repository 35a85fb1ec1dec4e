"""What the campaign file says otherwise than it was done."""

from collections.abc import Mapping
from typing import Any

from laboratory.checking import joined
from laboratory.errors import Complaint

PLAN = "plan"  # its manoeuvres go by their id


def misstated(campaign: Mapping[str, Any], said: Mapping[str, Any]) -> dict[str, Any]:
    """The campaign with what `said` holds in place of the truth; mappings are merged key by key.

    Under `plan`, by the id of a manoeuvre, the keys in which its statement is wrong.
    """
    stated = dict(campaign)
    for key, value in said.items():
        if key == PLAN:
            stated[PLAN] = [
                misstated(manoeuvre, value.get(manoeuvre["id"], {})) for manoeuvre in campaign[PLAN]
            ]
        elif isinstance(value, Mapping) and isinstance(campaign.get(key), Mapping):
            stated[key] = misstated(campaign[key], value)
        else:
            stated[key] = value
    return stated


def unknown_manoeuvres(campaign: Mapping[str, Any], said: Mapping[str, Any]) -> list[Complaint]:
    """Manoeuvres that are misstated and that the plan does not have."""
    known = [manoeuvre["id"] for manoeuvre in campaign[PLAN]]
    return [
        Complaint(joined("misstated.plan", name), "no manoeuvre", "one of " + ", ".join(known))
        for name in said.get(PLAN, {})
        if name not in known
    ]
