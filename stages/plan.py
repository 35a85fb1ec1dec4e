"""The campaign file, made explicit: one row per manoeuvre in SI, and all that is taken as known.

This is the only stage that reads YAML, so a bad campaign fails here, by name.
"""

import json
from collections.abc import Iterator
from math import cos, isclose, pi, radians
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from stages.contracts import tables
from stages.contracts.code import hash_of_file
from stages.contracts.errors import Refusal
from stages.contracts.stage import Stage, Tables
from stages.contracts.yaml_file import Key, YamlFile
from stages.model.motion import Array, Profile, turned
from stages.model.site import EARTH_RATE, STANDARD_GRAVITY, earth_rate, normal_gravity

ARC_SECOND = pi / 180 / 3600
# Where a campaign states no sigma, these are taken, and the report says so.
ASSUMED_POSITION = 30 * ARC_SECOND
ASSUMED_ANGLE = 30 * ARC_SECOND
ASSUMED_RATE = 1e-3
ASSUMED_GRAVITY = 5e-5  # m/s² of a stated value: 5 mGal
ASSUMED_ANOMALY = 5e-4  # m/s² of normal gravity: what gravity differs by from place to place
ASSUMED_LATITUDE = radians(0.01)

AXES = np.eye(3)
Row = dict[str, Any]


def plan(campaign: list[Path], raw: list[Path], instruments: list[Path]) -> Tables:
    """The campaign, its instrument, its logs and its manoeuvres.

    Raises
    ------
    Refusal
        for the first thing in the campaign file that cannot be used
    """
    file = YamlFile(campaign[0])
    version = file.content.get("campaign") if isinstance(file.content, dict) else None
    if version != 1:
        raise file.refuse(
            ["campaign"], version, "campaign: 1", "write the campaign in version 1 of the grammar"
        )
    file.check("campaign")
    instrument, entry = _instrument(file, instruments[0])
    manoeuvres = list(_manoeuvres(file, entry))
    present = {path.name: path for path in raw}
    missing = {row["file"]: row["key"] for row in manoeuvres if row["file"] not in present}
    for name, key in missing.items():
        raise file.refuse(
            key, name, f"a log in {campaign[0].parent}", "put the log there or correct its name"
        )
    return {
        "campaign": pd.DataFrame([_campaign(file, campaign[0].parent.name, entry)]),
        "known": pd.DataFrame(_known(file)),
        "sensors": pd.DataFrame(_sensors(entry)),
        "logs": pd.DataFrame(_logs(manoeuvres, instrument, entry)),
        "inputs": pd.DataFrame(
            {"file": path.name, "size": path.stat().st_size, "sha256": hash_of_file(path)}
            for path in [
                campaign[0],
                *sorted(present[row["file"]] for row in _one_per_file(manoeuvres)),
            ]
        ),
        "manoeuvres": pd.DataFrame(manoeuvres),
    }


def _one_per_file(manoeuvres: list[Row]) -> list[Row]:
    return list({row["file"]: row for row in manoeuvres}.values())


def _instrument(file: YamlFile, instruments: Path) -> tuple[str, dict[str, Any]]:
    """Name of the entry and the entry; written out in the campaign or one of the listed."""
    stated = file.content["instrument"]
    if not isinstance(stated, str):
        return stated["name"], stated
    listed = YamlFile(instruments)
    if stated not in listed.content:
        raise file.refuse(
            ["instrument"],
            stated,
            f"one of {', '.join(listed.content)}",
            f"correct the name, add the instrument to {instruments.name}, or write it out here",
        )
    entry = listed.content[stated]
    return stated, entry


def _campaign(file: YamlFile, folder: str, entry: dict[str, Any]) -> Row:
    content, site = file.content, file.content["site"]
    return {
        "campaign": folder,
        "simulated": content.get("simulated", False),
        "instrument": entry["name"],
        "serial": content["serial"],
        "date": content["date"],
        **{key: content.get(key) for key in ("laboratory", "operator", "notes")},
        "table": content.get("table", {}).get("name", "not named"),
        "rate": entry.get("rate_hz"),
        "latitude": None if site["latitude_deg"] is None else radians(site["latitude_deg"]),
        "height": site.get("height_m"),
        **{bits: entry.get("status", {}).get(bits, 0) for bits in ("must_be_set", "must_be_clear")},
    }


# ---- what is taken as known


def _known(file: YamlFile) -> Iterator[Row]:
    """Every quantity that the estimation takes as known, with its sigma and where it is from."""
    site, table = file.content["site"], file.content.get("table", {})

    def row(quantity: str, value: float | None, sigma: float | None, unit: str, origin: str) -> Row:
        return {
            "quantity": quantity,
            "value": value,
            "sigma": sigma,
            "unit": unit,
            "origin": origin,
        }

    def table_row(quantity: str, key: str, unit_size: float, assumed: float, unit: str) -> Row:
        if key in table:
            return row(quantity, 0.0, table[key] * unit_size, unit, f"stated: table.{key}")
        return row(quantity, 0.0, assumed, unit, f"assumed, for table.{key} is not stated")

    if table.get("name") == "by hand" and "position_sigma_arcsec" not in table:
        raise file.refuse_text(
            ["table"],
            "no position_sigma_arcsec",
            "position_sigma_arcsec for positions set by hand",
            "state how well the faces were set, for example position_sigma_arcsec: 3600 for 1°",
        )
    yield row("gravity", *_gravity(file), "m/s²", _gravity_origin(site))
    if site["latitude_deg"] is None:
        # A direction of which nothing is known: each part has a third of the squared rate.
        unknown = "assumed, for the latitude is not known"
        yield row("earth_rate_up", 0.0, EARTH_RATE / 3**0.5, "rad/s", unknown)
        yield row("earth_rate_level", EARTH_RATE * (2 / 3) ** 0.5, None, "rad/s", unknown)
    else:
        latitude = radians(site["latitude_deg"])
        up, level = earth_rate(latitude)
        computed = "computed from the latitude, whose sigma is assumed as 0.01°"
        sigma = EARTH_RATE * abs(cos(latitude)) * ASSUMED_LATITUDE
        yield row("earth_rate_up", up, sigma, "rad/s", computed)
        yield row("earth_rate_level", level, None, "rad/s", computed)
    heading = table.get("heading_deg")
    yield row(
        "heading",
        None if heading is None else radians(heading),
        None,
        "rad",
        "not known" if heading is None else "stated: table.heading_deg",
    )
    yield table_row("position", "position_sigma_arcsec", ARC_SECOND, ASSUMED_POSITION, "rad")
    yield table_row("turn_angle", "angle_sigma_arcsec", ARC_SECOND, ASSUMED_ANGLE, "rad")
    yield table_row("turn_rate", "rate_sigma_ppm", 1e-6, ASSUMED_RATE, "1")


def _gravity(file: YamlFile) -> tuple[float, float]:
    site = file.content["site"]
    stated: float | None = site.get("gravity_m_s2")
    if stated is not None:
        return stated, site.get("gravity_sigma_m_s2", ASSUMED_GRAVITY)
    if site["latitude_deg"] is None:
        raise file.refuse_text(
            ["site"],
            "neither gravity_m_s2 nor a latitude",
            "one of the two",
            "state gravity_m_s2, or latitude_deg and height_m for normal gravity",
        )
    value = normal_gravity(radians(site["latitude_deg"]), site.get("height_m", 0.0))
    return value, site.get("gravity_sigma_m_s2", ASSUMED_ANOMALY)


def _gravity_origin(site: dict[str, Any]) -> str:
    if "gravity_m_s2" in site:
        stated = "stated: site.gravity_m_s2"
        return stated if "gravity_sigma_m_s2" in site else f"{stated}, its sigma assumed as 5 mGal"
    height = f"{site['height_m']:g} m" if "height_m" in site else "0 m, for no height is stated"
    return f"normal gravity at latitude {site['latitude_deg']:g}°, height {height}"


# ---- the instrument and its logs


def _sensors(entry: dict[str, Any]) -> Iterator[Row]:
    accelerometer, gyro = entry.get("accelerometer", {}), entry.get("gyro", {})
    figures = {
        "accel": {
            "count_size": accelerometer.get("count_m_s"),
            "full_scale": _times(accelerometer.get("full_scale_g"), STANDARD_GRAVITY),
            "white_noise": _times(accelerometer.get("velocity_random_walk_m_s_sqrt_h"), 1 / 60),
            "source": accelerometer.get("source"),
        },
        "gyro": {
            "count_size": gyro.get("count_rad"),
            "full_scale": _times(gyro.get("full_scale_deg_s"), pi / 180),
            "white_noise": _times(gyro.get("angle_random_walk_deg_sqrt_h"), pi / 180 / 60),
            "source": gyro.get("source"),
        },
    }
    for channel in tables.CHANNELS:
        yield {"channel": channel, **figures[channel.partition("_")[0]]}


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _logs(manoeuvres: list[Row], name: str, entry: dict[str, Any]) -> Iterator[Row]:
    for log, rows in _by_log(manoeuvres).items():
        layout = dict(rows[0]["layout"])
        if layout["kind"] == "rawimus":
            layout |= {
                "axes": entry["axes"],
                "gyro_count": entry["gyro"]["count_rad"],
                "accelerometer_count": entry["accelerometer"]["count_m_s"],
            }
        elif labels := sorted({column for row in rows for column in row["label_columns"]}):
            layout["label"] = labels
        yield {"log": log, "file": rows[0]["file"], "layout": json.dumps(layout, sort_keys=True)}


def _by_log(manoeuvres: list[Row]) -> dict[str, list[Row]]:
    """Manoeuvres by log; a file that is read in several formats counts as several logs."""
    formats: dict[str, set[str]] = {}
    for row in manoeuvres:
        formats.setdefault(row["file"], set()).add(row["format"])
    logs: dict[str, list[Row]] = {}
    for row in manoeuvres:
        single = len(formats[row["file"]]) == 1
        row["log"] = row["file"] if single else f"{row['file']}:{row['format']}"
        logs.setdefault(row["log"], []).append(row)
    return logs


# ---- the manoeuvres


def _manoeuvres(file: YamlFile, entry: dict[str, Any]) -> Iterator[Row]:
    """The plan with every shorthand expanded, in its order."""
    seen: set[str] = set()
    rows = []
    for number, item in enumerate(file.content["plan"]):
        key: Key = ["plan", number]
        for row in _expanded(file, key, item):
            if row["manoeuvre"] in seen:
                raise file.refuse(
                    [*key, "id"], row["manoeuvre"], "an id of its own", "rename one of the two"
                )
            seen.add(row["manoeuvre"])
            rows.append(row | _recording(file, key, item, entry))
    _by_log(rows)
    yield from rows


def _expanded(file: YamlFile, key: Key, item: dict[str, Any]) -> Iterator[Row]:
    """One row for a rest, a turn or a search for positions; one per rest of a tumble."""
    row: Row = {
        "manoeuvre": item["id"],
        "do": item["do"],
        "position": item.get("position", item["id"]),
        "mount": item.get("mount", "as mounted"),
        "recorded": item.get("recorded", "whole"),
        "seconds": item.get("seconds"),
        "angle": None,
        "angle_sigma": None,
        "rate": None,
        "acceleration": _times(item.get("accel_deg_s2"), pi / 180),
    }
    up, mark = _direction(file, [*key, "up"], item), _direction(file, [*key, "mark"], item)
    if up is not None and mark is not None and abs(up @ mark) > cos(radians(1)):
        raise file.refuse(
            [*key, "mark"], item["mark"], "a direction across up", "name a level direction"
        )
    allowed = _ALLOWED[item["do"]]
    for name in set(item) - allowed - _ALWAYS:
        raise file.refuse_text(
            [*key, name],
            f"the key {name!r}",
            f"for do: {item['do']} one of {', '.join(sorted(allowed | _ALWAYS))}",
            f"remove {name}, or correct do",
        )
    if item["do"] == "turn":
        about = _direction(file, [*key, "about"], item)
        about = up if about is None else about
        if about is None:
            raise file.refuse_text(
                key, "a turn without an axis", "about, or up", "add about: the axis of the turn"
            )
        yield row | _vectors(up, mark, about) | _turn(file, key, item)
    elif item["do"] == "tumble":
        yield from _tumble(file, key, item, row, up, mark)
    else:
        if item["do"] == "positions" and "seconds" not in item:
            raise file.refuse_text(
                key, "no key 'seconds'", "seconds: the shortest rest, s", "add seconds"
            )
        yield row | _vectors(up, mark, None)


_ALWAYS = {"id", "do", "log", "format", "span", "rows", "where", "mount", "position"}
_ALLOWED = {
    "rest": {"up", "mark", "seconds"},
    "positions": {"seconds"},
    "turn": {
        *("up", "mark", "about", "degrees", "degrees_sigma"),
        *("rate_deg_s", "accel_deg_s2", "seconds", "recorded"),
    },
    "tumble": {"up", "mark", "about", "step_degrees", "steps", "and_back", "seconds"},
}


def _direction(file: YamlFile, key: Key, item: dict[str, Any]) -> Array | None:
    """A unit vector in body axes; none where it is left out or unknown."""
    stated = item.get(str(key[-1]), "unknown")
    if stated == "unknown":
        return None
    if isinstance(stated, str):
        return AXES["xyz".index(stated[1])] * (-1.0 if stated[0] == "-" else 1.0)
    vector = np.array(stated, dtype=np.float64)
    length = float(np.linalg.norm(vector))
    if length == 0:
        raise file.refuse(key, stated, "a vector that is not zero", "correct the vector")
    return np.asarray(vector / length)


def _vectors(up: Array | None, mark: Array | None, about: Array | None) -> Row:
    vectors = {"up": up, "mark": mark, "about": about}
    return {
        f"{name}_{axis}": None if vector is None else float(vector[i])
        for name, vector in vectors.items()
        for i, axis in enumerate(tables.AXES)
    }


def _turn(file: YamlFile, key: Key, item: dict[str, Any]) -> Row:
    """Angle, rate and duration of a turn; two of the three suffice, by hand none is needed."""
    table = file.content.get("table", {})
    by_hand = table.get("name") == "by hand"
    angle = _times(item.get("degrees"), pi / 180)
    rate = _times(item.get("rate_deg_s"), pi / 180)
    acceleration = _times(item.get("accel_deg_s2"), pi / 180)
    seconds: float | None = item.get("seconds")
    if angle is not None and rate is not None and rate <= 0:
        raise file.refuse(
            [*key, "rate_deg_s"],
            item["rate_deg_s"],
            "a magnitude, for degrees has the sign",
            "leave the sign to degrees",
        )
    if angle == 0:
        raise file.refuse(
            [*key, "degrees"], item["degrees"], "an angle that is not 0", "correct it"
        )
    if rate == 0:
        raise file.refuse([*key, "rate_deg_s"], 0, "a rate that is not 0", "correct the rate")
    if angle is not None and rate is not None:
        rate = float(np.copysign(rate, angle))
        profile = Profile(abs(angle), abs(rate), acceleration or np.inf)
        if seconds is not None and not isclose(profile.seconds, seconds, rel_tol=0.05):
            raise file.refuse(
                [*key, "seconds"],
                seconds,
                f"about {profile.seconds:.4g} s by degrees, rate_deg_s and accel_deg_s2",
                "leave out one of degrees, rate_deg_s and seconds",
            )
        seconds = profile.seconds
    elif rate is not None and seconds is not None:
        ramps = 0.0 if acceleration is None else abs(rate) / acceleration
        angle = rate * (seconds - ramps)
    elif angle is not None and seconds is not None:
        rate = angle / seconds
    elif not by_hand and not (rate is not None and item.get("recorded") == "steady"):
        raise file.refuse_text(
            key,
            "fewer than two of degrees, rate_deg_s and seconds",
            "two of them; for recorded: steady a signed rate; by hand none is needed",
            "add what the table was set to",
        )
    sigma = _times(item.get("degrees_sigma"), pi / 180)
    if sigma is None and angle is not None:
        if by_hand and "angle_sigma_arcsec" not in table:
            raise file.refuse_text(
                key,
                "a turn by hand without degrees_sigma",
                "degrees_sigma: how well the angle is known, degrees",
                "add degrees_sigma",
            )
        sigma = table.get("angle_sigma_arcsec", ASSUMED_ANGLE / ARC_SECOND) * ARC_SECOND
    return {"angle": angle, "angle_sigma": sigma, "rate": rate, "seconds": seconds}


def _tumble(
    file: YamlFile, key: Key, item: dict[str, Any], row: Row, up: Array | None, mark: Array | None
) -> Iterator[Row]:
    about = _direction(file, [*key, "about"], item)
    missing = [name for name in ("up", "about", "step_degrees", "steps") if name not in item]
    if missing or up is None or about is None:
        raise file.refuse_text(
            key,
            f"a tumble without {', '.join(missing) or 'known directions'}",
            "up, about, step_degrees and steps",
            "add what is missing",
        )
    if abs(up @ about) > cos(radians(1)):
        raise file.refuse(
            [*key, "about"], item["about"], "an axis across up", "name the level axis"
        )
    there = list(range(item["steps"]))
    for way, numbers in (("", there), ("-back", there[::-1] if item.get("and_back") else [])):
        for number in numbers:
            angle = radians(number * item["step_degrees"])
            ups = turned(up, about, angle)
            marks = None if mark is None else turned(mark, about, angle)
            name = f"{item['id']}{way}-{number:02d}"
            position = f"{item['position']}-{number:02d}" if "position" in item else name
            named = {"manoeuvre": name, "position": position, "do": "rest"}
            yield row | named | _vectors(ups, marks, None)


def _recording(file: YamlFile, key: Key, item: dict[str, Any], entry: dict[str, Any]) -> Row:
    """Where a manoeuvre is recorded: log, layout, and the stretch of it."""
    name = item.get("log", file.content.get("log"))
    if name is None:
        raise file.refuse_text(
            key, "no log", "log here, or a default log of the campaign", "add log: its file name"
        )
    layout, layout_key = _layout(file, key, item, entry)
    _check_layout(file, layout_key, layout, entry)
    ways = [way for way in ("span", "rows", "where") if way in item]
    if len(ways) > 1:
        raise file.refuse_text(
            [*key, ways[1]], f"both {' and '.join(ways)}", "one of them", f"remove {ways[1]}"
        )
    for way in ("span", "rows"):
        if way in item and not item[way][0] < item[way][1]:
            raise file.refuse([*key, way], item[way], "[from, to] with from < to", "swap the two")
    where = item.get("where", {})
    span, rows = item.get("span", [None, None]), item.get("rows", [None, None])
    return {
        "key": [*key, "log"] if "log" in item else key,
        "file": name,
        "format": item.get("format", ""),
        "layout": layout,
        "label_columns": sorted(where),
        "label": "; ".join(f"{column}={where[column]}" for column in sorted(where)) or None,
        "from_s": span[0],
        "to_s": span[1],
        "from_row": rows[0],
        "to_row": rows[1],
    }


def _layout(
    file: YamlFile, key: Key, item: dict[str, Any], entry: dict[str, Any]
) -> tuple[dict[str, Any], Key]:
    formats = file.content.get("formats", {})
    if "format" in item:
        if item["format"] not in formats:
            raise file.refuse(
                [*key, "format"],
                item["format"],
                f"one of {', '.join(formats) or 'formats, of which there are none'}",
                "correct the name or add it to formats",
            )
        return formats[item["format"]], ["formats", item["format"]]
    if "format" not in entry:
        raise file.refuse_text(
            key,
            "no format",
            f"format, for the instrument {entry['name']} has none of its own",
            "name one of formats",
        )
    return entry["format"], ["instrument", "format"]


def _check_layout(file: YamlFile, key: Key, layout: dict[str, Any], entry: dict[str, Any]) -> None:
    """A layout must hold at least one sensor, in units of that sensor, or counts of known size."""
    if layout["kind"] == "rawimus":
        for sensor, count in (("gyro", "count_rad"), ("accelerometer", "count_m_s")):
            if count not in entry.get(sensor, {}) or "axes" not in entry:
                raise file.refuse_text(
                    ["instrument"],
                    f"no {sensor}.{count} or no axes",
                    "the count sizes and axes of the raw fields",
                    "add them to the instrument",
                )
        return
    if "gyro" not in layout and "accelerometer" not in layout:
        raise file.refuse_text(
            key, "neither gyro nor accelerometer", "at least one of them", "add its columns"
        )
    for sensor, units in (("gyro", ("rad/s", "deg/s")), ("accelerometer", ("m/s2", "g"))):
        if sensor in layout and layout[sensor]["unit"] not in units:
            raise file.refuse(
                [*key, sensor, "unit"],
                layout[sensor]["unit"],
                f"one of {', '.join(units)}",
                "correct the unit",
            )


STAGE = Stage(
    plan,
    files=("campaign", "raw", "instruments"),
    writes={
        "campaign": tables.CAMPAIGN,
        "known": tables.KNOWN,
        "sensors": tables.SENSORS,
        "logs": tables.LOGS,
        "inputs": tables.INPUTS,
        "manoeuvres": tables.MANOEUVRES,
    },
)

if __name__ == "__main__":
    STAGE.command_line()
