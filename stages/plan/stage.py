"""The campaign file, made explicit: one row per manoeuvre in SI, and all that is taken as known.

This is the only stage that reads YAML, so a bad campaign fails here, by name.
"""

from collections.abc import Iterator, Sequence
from math import copysign, pi, radians
from pathlib import Path
from typing import Any

import pandas as pd

from inertial import tables
from inertial.campaign.records import Row
from inertial.campaign.references import BY_HAND, NOT_NAMED
from inertial.physics.forward import at_steady_speed, in_free_fall
from inertial.tables.code import hash_of_file
from inertial.tables.stage import Stage, Tables
from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.messages import _
from stages.plan.certificate import Statements, allowed_changes
from stages.plan.declared import DECLARED
from stages.plan.manoeuvres import StatedPosition, expanded, stays_in_position
from stages.plan.published import published_values
from stages.plan.recording import (
    by_log,
    count_sizes,
    encoder,
    instrument,
    logs,
    ranges,
    recording,
    sensors,
)
from stages.plan.sampling import SAMPLE_RATE, StatedRate, one_by_one
from stages.plan.taken_as_known import by_hand, gravity_repairs, known

FACTS = ("laboratory", "operator", "notes", "mounting", "switch_on")  # as stated, or none


def plan(
    campaign: list[Path],
    raw: list[Path],
    instruments: list[Path],
    published: Sequence[Path] = (),
    laboratory: Sequence[Path] = (),
    *,
    repairs: str = "apply",
    certificate: str = "as_stated",
) -> Tables:
    """The campaign, its instrument, its logs and its manoeuvres, and what others published of it.

    `repairs`: apply or refuse, whether a gravity that is not that of the place is set right;
    `certificate`: as_stated or strict, whether it must state all that a certificate needs.

    Raises
    ------
    Refusal
        for the first thing in these files that cannot be used
    """
    file = YamlFile(campaign[0])
    version = file.content.get("campaign") if isinstance(file.content, dict) else None
    if version != 1:
        raise file.refuse(
            ["campaign"],
            version,
            "campaign: 1",
            _("write the campaign in version 1 of the grammar"),
        )
    file.check("campaign")
    listed = YamlFile(instruments[0])
    entry = instrument(file, listed)
    set_right = list(gravity_repairs(file, repairs))
    taken_as_known = list(known(file, set_right))
    manoeuvres, table = _manoeuvres(file, entry, listed), encoder(file)
    named = [(row["key"], row["file"]) for row in manoeuvres]
    named += [(row["gyro_key"], row["gyro_file"]) for row in manoeuvres if row["gyro_file"]]
    named += [] if table is None else [(["encoder", "log"], table["file"])]
    used = sorted(_logs_of(file, named, raw))
    stated = Statements(file, laboratory, certificate)
    others = [row for path in published for row in published_values(YamlFile(path))]
    in_counts = any(row["layout"]["kind"] == "rawimus" for row in manoeuvres)
    return {
        "campaign": pd.DataFrame([_campaign(file, entry, manoeuvres)]),
        "known": pd.DataFrame(taken_as_known),
        "ideal_readings": list(ideal_readings(file.content["site"])),
        "sensors": pd.DataFrame(sensors(entry)),
        "logs": pd.DataFrame(logs(manoeuvres, entry, table)),
        "ranges": pd.DataFrame(ranges(manoeuvres, entry)),
        "count_sizes": list(count_sizes(listed)) if in_counts else [],
        "inputs": pd.DataFrame(
            {"file": path.name, "size": path.stat().st_size, "sha256": hash_of_file(path)}
            for path in [campaign[0], *used]
        ),
        "published": others,
        "certificate": stated.items,
        "standards": stated.standards(),
        "tolerances": [*stated.tolerances()],
        "allowed_changes": [*allowed_changes(file)],
        "manoeuvres": pd.DataFrame(manoeuvres)[[c.name for c in tables.MANOEUVRES.columns]],
        "purposes": [
            {"manoeuvre": row["manoeuvre"], "purpose": row["purpose"]}
            for row in manoeuvres
            if row["purpose"]
        ],
        "repairs": set_right,
        "guesses": [{"part": part} for part in file.content.get("guessed", [])],
        "accepted": [
            {"repair": repair, "place": file.place(["accept", number])}
            for number, repair in enumerate(file.content.get("accept", []))
        ],
    }


def _logs_of(file: YamlFile, named: Sequence[tuple[Key, str]], raw: Sequence[Path]) -> set[Path]:
    """The logs that a campaign names, by the key that does, among the files beside it."""
    folder, present = file.path.parent, {path.name: path for path in raw}
    for key, log in named:
        if (folder / log).is_dir():
            raise file.refuse_text(
                key,
                _("'{log}', a folder", log=log),
                _("a log, which is one file"),
                _("name a file; of a bag that is a folder, the .db3 or .mcap in it"),
            )
        if log not in present:
            raise file.refuse(
                key,
                log,
                _("a log in {parent}", parent=folder),
                _("put the log there, or correct its name"),
            )
        _stays_inside(file, key, present[log])
    return {present[log] for _unused, log in named}


def _stays_inside(file: YamlFile, key: Key, log: Path) -> None:
    """A campaign from elsewhere reads nothing but what lies in its own folder."""
    if (target := log.resolve()).parent != file.path.resolve().parent:
        raise file.refuse_text(
            key,
            _("{name}, a link to {target}", name=log.name, target=target),
            _("a log in {parent}", parent=file.path.parent),
            _("copy the log there instead of the link"),
        )


def _campaign(file: YamlFile, entry: dict[str, Any], manoeuvres: list[Row]) -> Row:
    content, site = file.content, file.content["site"]
    return {
        "campaign": file.path.parent.name,
        "simulated": content.get("simulated", False),
        "compensated": content.get("compensated", False),
        "instrument": entry["name"],
        "serial": content["serial"],
        "date": content["date"],
        **{key: content.get(key) for key in FACTS},
        "table": BY_HAND if by_hand(content) else content["table"].get("name", NOT_NAMED),
        "rate": entry.get(SAMPLE_RATE, _common_rate(manoeuvres)),
        "latitude": None if site["latitude_deg"] is None else radians(site["latitude_deg"]),
        "height": site.get("height_m"),
        **{bits: entry.get("status", {}).get(bits, 0) for bits in ("must_be_set", "must_be_clear")},
    }


def _common_rate(manoeuvres: list[Row]) -> float | None:
    """The rate that the formats of all manoeuvres state, if it is one."""
    rates = {(row["layout"].get("time") or {}).get(SAMPLE_RATE) for row in manoeuvres}
    return rates.pop() if len(rates) == 1 else None


def _manoeuvres(file: YamlFile, entry: dict[str, Any], listed: YamlFile) -> list[Row]:
    """The plan with every shorthand expanded, in its order, each with its log."""
    rows: dict[str, Row] = {}
    rate = StatedRate.of(file, listed)
    cycles, before, stated, set_by_hand = 0, None, StatedPosition(), by_hand(file.content)
    for number, item in enumerate(file.content["plan"]):
        cycles += bool(rows and item.get("power_cycle"))  # before the first there is no part
        for row in expanded(file, ["plan", number], item):
            if row["manoeuvre"] in rows:
                raise file.refuse(
                    ["plan", number, "id"],
                    row["manoeuvre"],
                    _("an id of its own"),
                    _("rename one of the two"),
                )
            where = recording(file, ["plan", number], item, entry, rate)
            for each in one_by_one(row | where):
                if "position" in item:
                    each |= {"turned_on": stated.turned_on(each)}
                elif before and not set_by_hand and stays_in_position(before, each):
                    each |= {"position": before["position"]}
                before = each
                rows[each["manoeuvre"]] = each | {"number": number, "switch_on": cycles}
    for first, *others in by_log(list(rows.values())).values():
        for row in others:
            if row["layout"] != first["layout"]:
                raise file.refuse_text(
                    row["gyro_key"] or ["plan", row["number"]],
                    _(
                        "{log} with other gyros than in plan[{number}]",
                        log=first["log"],
                        number=first["number"],
                    ),
                    _("one log of the gyros for each log"),
                    _("state the same log and format of the gyros for both"),
                )
    return list(rows.values())


# ---- What ideal sensors would read at the site of the campaign, elsewhere, and under way

SPEED, HIGH = 100.0, 10_000.0  # m/s, m: of the triads under way


def ideal_readings(site: dict[str, Any]) -> Iterator[dict[str, Any]]:
    """Rows of the table; none where the latitude of the site is not known."""
    if site["latitude_deg"] is None:
        return
    latitude, height = radians(site["latitude_deg"]), site.get("height_m", 0.0)
    pole = copysign(pi / 2, latitude)
    readings = [
        ("at_rest", latitude, height, 0.0, at_steady_speed(latitude, height)),
        ("in_free_fall", latitude, height, 0.0, in_free_fall(latitude)),
        ("at_equator", 0.0, height, 0.0, at_steady_speed(0.0, height)),
        ("at_pole", pole, height, 0.0, at_steady_speed(pole, height)),
    ]
    if latitude != pole:  # where there is neither north nor east
        for name, velocity in (("north", (SPEED, 0.0, 0.0)), ("east", (0.0, SPEED, 0.0))):
            for level in (height, HIGH):
                read = at_steady_speed(latitude, level, velocity)
                readings.append((f"under_way_{name}", latitude, level, SPEED, read))
    for situation, phi, level, speed, read in readings:
        place = {"situation": situation, "latitude": phi, "height": level, "speed": speed}
        for sensor, values in (("accel", read.force), ("gyro", read.rate)):
            components = dict(zip(("north", "east", "down"), map(float, values), strict=True))
            yield place | {"sensor": sensor} | components


STAGE = Stage(plan, DECLARED)
