"""Columns and tables as they were before lists became tables; to go when nothing reads them."""

from collections.abc import Iterator, Mapping, Sequence

from stages.criticism.finding_rows import Row

MADE = Mapping[str, Sequence[Row]]


def with_former(made: MADE) -> dict[str, Sequence[Row]]:
    """All rows with the former columns added, and `blind_spots`."""
    lists: dict[str, list[str]] = {}
    for row in made["members"]:
        lists.setdefault(row["finding"], []).append(row["effect"])
    positions: dict[str, list[str]] = {}
    for row in made["cause_positions"]:
        positions.setdefault(row["finding"], []).append(row["position"])
    numbers: dict[str, list[str]] = {}
    for row in made["effects"]:
        if row["finding"] and row["value"] is not None:
            numbers.setdefault(row["finding"], []).extend(_number(row))
    findings = []
    for row in made["findings"]:
        place = positions.get(row["id"])
        listed = lists.get(row["id"])
        former = {"manoeuvre": " or ".join(place)} if place else {}
        if row.get("verdict"):
            former["members"] = ", ".join(listed or [])
            if row["id"] in numbers or row["cause"] != "unknown_structure":
                former["parameters"] = "; ".join(numbers.get(row["id"], []))
        findings.append({**row, **former})
    scores = [
        {**row, "at": row["scan_value"], "members": ", ".join(lists.get(row["finding"], []))}
        for row in made["scores"]
    ]
    for row in scores:
        if row["sought_in"] == "noise" and row["named"]:
            row["members"] = row["effect"]
    return {
        **made,
        "findings": findings,
        "scores": scores,
        "effects": [{**row, "visible": row["detection_limit"]} for row in made["effects"]],
        "blind_spots": list(_blind_spots(made["detection_limits"])),
        "structures": [
            {**row, "place": row["scan_value"], "fires": row["detected"], **_channel(row)}
            for row in made["structures"]
        ],
        "structure_points": [
            {**row, "left": row["residual"], **_channel(row)} for row in made["structure_points"]
        ],
    }


def _number(row: Row) -> Iterator[str]:
    if row["parameter"] == "K":
        sigma = "nan" if row["sigma"] is None else f"{row['sigma']:.2g}"
        yield f"K = {row['value']:.3g} ± {sigma} {row['unit']}"
    elif row["parameter"] == "T0":
        yield f"T0 = {row['value']:.6g} K"
    elif row["sigma"]:
        yield f"{row['parameter']} = {row['value']:.6g} ± {row['sigma']:.2g} {row['unit']}"


def _channel(row: Row) -> Row:
    method = f"joint@{row['mount']}" if row["mount"] else "joint"
    return {"method": method, "channel": f"{row['sensor'] or ''} {row['axis'] or ''}".strip()}


def _blind_spots(limits: Sequence[Row]) -> Iterator[Row]:
    for row in limits:
        yield {
            **row,
            "effect": f"{row['effect']}@{row['mount']}" if row["mount"] else row["effect"],
            "visible": row["limit"],
            "best": row["smallest"],
            "worst": row["largest"],
        }
