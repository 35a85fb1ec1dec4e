"""Columns as they were before lists became tables; to go when nothing reads them."""

from collections.abc import Mapping, Sequence
from typing import Any

Row = Mapping[str, Any]


def with_former(made: Mapping[str, Sequence[Row]]) -> dict[str, Sequence[Row]]:
    """All rows with the former columns added."""

    def listed(table: str, keys: Sequence[str], name: str, row: Row) -> str:
        own = (one for one in made[table] if all(one[key] == row[key] for key in keys))
        return ", ".join(one[name] for one in own)

    def held_out(row: Row, counted: bool) -> str | None:
        if row["unit"] != "sigma":
            return None
        if row["scope"] != "held-out" or row["axis"]:
            return ""
        model = ("mount", "sensor", "model")
        own = [o for o in made["held_out"] if all(o[key] == row[key] for key in model)]
        return ", ".join(one["manoeuvre"] for one in own if one["counted"] == counted)

    sensor = ("mount", "sensor")
    return {
        **made,
        "gain": [
            {
                **row,
                "sensor": f"{row['sensor']} {row['axis']}" if row["axis"] else row["sensor"],
                "effects": listed("gain_effects", (*sensor, "model"), "effect", row),
                "taken_away": held_out(row, True),
                "left_out": held_out(row, False),
            }
            for row in made["gain"]
        ],
        "decision": [
            {
                **row,
                "effects": listed("decision_effects", sensor, "effect", row),
                "alarms": listed("alarms", sensor, "cause", row),
            }
            for row in made["decision"]
        ],
    }
