"""Where each manoeuvre is recorded, and how its log and that of the encoder are read."""

import json
from collections.abc import Iterator
from itertools import product
from typing import Any

import numpy as np

from inertial import tables
from inertial.campaign.records import Row
from inertial.estimation.noise_model import FLOOR_VARIANCE
from inertial.formats.columns import vectornav_lines
from inertial.sensors import FILE_KEYS
from inertial.tables.yaml_file import Key, YamlFile
from inertial.text.messages import _
from inertial.text.units import (
    CHANNEL_UNITS,
    DEGREE,
    DEGREE_PER_HOUR,
    INCREMENT_UNITS,
    PER_ROOT_HOUR,
    STANDARD_GRAVITY,
    in_si,
)
from stages.plan.sampling import (
    MeanSigmas,
    StatedRate,
    are_means,
    each,
    refuse_without_time,
    with_rate,
)

KEY = "encoder"
SIZES = CHANNEL_UNITS | INCREMENT_UNITS
MICRO_G = 1e-6 * STANDARD_GRAVITY
# Of the Allan deviation of a bias instability of 1: data sheets state the lowest point.
LOWEST = float(np.sqrt(FLOOR_VARIANCE))


def encoder(file: YamlFile) -> dict[str, Any] | None:
    """Its file, layout, GPS week or none, and what is added to its time, s; None without one."""
    stated = file.content.get(KEY)
    if stated is None:
        return None
    formats = file.content.get("formats", {})
    if stated["format"] not in formats:
        raise file.refuse(
            [KEY, "format"],
            stated["format"],
            _("one of {value}", value=", ".join(formats) or "formats, of which there are none"),
            _("correct the name or add it to formats"),
        )
    layout = formats[stated["format"]]
    for key in ("time", "table_angle"):
        if key not in layout:
            raise file.refuse_text(
                ["formats", stated["format"]],
                f"no {key}",
                _("time and table_angle, the columns of the encoder's log"),
                f"add {key}",
            )
    _check_text(file, ["formats", stated["format"]], layout)
    return {
        "file": stated["log"],
        "layout": {key: layout[key] for key in layout if key not in FILE_KEYS.values()},
        "gps_week": stated.get("gps_week"),
        "offset": stated.get("offset_s", 0.0),
    }


def instrument(file: YamlFile, listed: YamlFile) -> dict[str, Any]:
    """The instrument of a campaign, written out in it or one of the listed."""
    stated = file.content["instrument"]
    if isinstance(stated, dict):
        _check_axes(file, ["instrument"], stated)
        return stated
    listed.check("campaign", entries="instrument")
    if stated not in listed.content:
        raise file.refuse(
            ["instrument"],
            stated,
            _("one of {content}", content=", ".join(listed.content)),
            _(
                "correct the name, add the instrument to {name}, or write it out here",
                name=listed.path.name,
            ),
        )
    _check_axes(listed, [stated], listed.content[stated])
    return dict(listed.content[stated])


def _check_axes(file: YamlFile, key: Key, entry: dict[str, Any]) -> None:
    """Each body axis once; only accelerometers read gravity."""
    for inside in ([], ["gyro"], ["accelerometer"]):
        part = entry.get(inside[0], {}) if inside else entry
        if "axes" in part and {axis[-1] for axis in part["axes"]} != set(tables.AXES):
            raise file.refuse(
                [*key, *inside, "axes"],
                part["axes"],
                _("x, y and z, each once, with or without a minus sign"),
                _("correct the axes"),
            )
    if "reads" in entry.get("gyro", {}):
        raise file.refuse_text(
            [*key, "gyro", "reads"],
            _("the key 'reads'"),
            _("reads of the accelerometer"),
            _("remove it; a gyro that reads the other way is stated by axes: [-x, -y, -z]"),
        )


def sensors(entry: dict[str, Any]) -> Iterator[Row]:
    """Count size, full scale and noise of each channel by the data sheet, in SI."""
    accelerometer, gyro = entry.get("accelerometer", {}), entry.get("gyro", {})
    velocity_random_walk = accelerometer.get("velocity_random_walk_m_s_sqrt_h")
    figures = {
        "accel": {
            "count_size": accelerometer.get("count_m_s"),
            "full_scale": in_si(accelerometer.get("full_scale_g"), STANDARD_GRAVITY),
            "white_noise": in_si(velocity_random_walk, PER_ROOT_HOUR),
            "bias_instability": in_si(accelerometer.get("bias_instability_ug"), MICRO_G / LOWEST),
            "random_walk": in_si(
                accelerometer.get("acceleration_random_walk_ug_sqrt_h"), MICRO_G * PER_ROOT_HOUR
            ),
            "source": accelerometer.get("source"),
        },
        "gyro": {
            "count_size": gyro.get("count_rad"),
            "full_scale": in_si(gyro.get("full_scale_deg_s"), DEGREE),
            "white_noise": in_si(gyro.get("angle_random_walk_deg_sqrt_h"), DEGREE * PER_ROOT_HOUR),
            "bias_instability": in_si(gyro.get("bias_instability_deg_h"), DEGREE_PER_HOUR / LOWEST),
            "random_walk": in_si(
                gyro.get("rate_random_walk_deg_h_sqrt_h"), DEGREE_PER_HOUR * PER_ROOT_HOUR
            ),
            "source": gyro.get("source"),
        },
    }
    for sensor, own in figures.items():
        for axis in tables.AXES:
            yield {"sensor": sensor, "axis": axis, **own}


def ranges(manoeuvres: list[Row], entry: dict[str, Any]) -> Iterator[Row]:
    """What one count of each channel of each log is, and how far the channel reaches, in SI."""
    scales = {row["sensor"]: row["full_scale"] for row in sensors(entry)}
    keys = {"accel": ("accelerometer", "count_m_s"), "gyro": ("gyro", "count_rad")}
    sigmas = MeanSigmas(manoeuvres, list(sensors(entry)), entry.get("rate_hz"))
    for log, rows in by_log(manoeuvres).items():
        layout = rows[0]["layout"]
        increments = layout["kind"] == "rawimus"
        axes = _axes(entry)
        for (sensor, (key, increment)), axis in product(keys.items(), tables.AXES):
            place = [field[-1] for field in axes[sensor]].index(axis)
            own = layout["gyro_log"]["layout"] if key == "gyro" and "gyro_log" in layout else layout
            triad, full = own.get(key) or {}, scales[sensor]
            count, limit = entry.get(key, {}).get(increment) if increments else None, None
            adding = increments or triad.get("unit") in INCREMENT_UNITS
            if "counts_per_unit" in triad:
                count = SIZES[triad["unit"]] / each(triad["counts_per_unit"])[place]
                zero = each(triad.get("zero_counts", 0))[place]
                if "limit_counts" in triad and not adding:
                    # Of unsigned counts the farther end: nothing within the range is cut off.
                    limit = max(triad["limit_counts"] - zero, zero) * count
            yield {
                "log": log,
                "sensor": sensor,
                "axis": axis,
                "count": count,
                "increments": adding,
                "limit": full if limit is None else limit,
                "sigma": sigmas.of(own, sensor, key, place),
            }


def _stated_axes(entry: dict[str, Any], sensor: str) -> list[str] | None:
    own: list[str] | None = entry.get(sensor, {}).get("axes", entry.get("axes"))
    return own


def _axes(entry: dict[str, Any]) -> dict[str, list[str]]:
    """Body axis and sign of the three fields of each sensor, such as z, -y, x."""
    axes = {
        name: _stated_axes(entry, sensor) or list(tables.AXES) for name, sensor in FILE_KEYS.items()
    }
    if entry.get("accelerometer", {}).get("reads") == "gravity":
        axes["accel"] = [f[1:] if f.startswith("-") else f"-{f}" for f in axes["accel"]]
    return axes


def count_sizes(listed: YamlFile) -> Iterator[Row]:
    """The increments that one count of a log is worth in each of the listed instruments."""
    for name, entry in listed.content.items():
        for sensor, key, size in (
            ("accel", "accelerometer", "count_m_s"),
            ("gyro", "gyro", "count_rad"),
        ):
            if size in entry.get(key, {}):
                yield {"instrument": name, "sensor": sensor, "count_size": entry[key][size]}


def recording(
    file: YamlFile, key: Key, item: dict[str, Any], entry: dict[str, Any], rate: StatedRate
) -> Row:
    """Where a manoeuvre is recorded: log, layout, and the stretch of it."""
    name = item.get("log", file.content.get("log"))
    if name is None:
        raise file.refuse_text(
            key,
            "no log",
            _("log here, or a default log of the campaign"),
            _("add log: its file name"),
        )
    layout, layout_key = _layout(file, key, item, entry, rate)
    refuse_without_time(file, key, item, layout)
    ways = [way for way in ("span", "rows", "where") if way in item]
    if len(ways) > 1:
        raise file.refuse_text(
            [*key, ways[1]], f"both {' and '.join(ways)}", "one of them", f"remove {ways[1]}"
        )
    for way in ("span", "rows"):
        if way in item and not item[way][0] < item[way][1]:
            raise file.refuse(
                [*key, way], item[way], _("[from, to] with from < to"), "swap the two"
            )
    gyros = _gyro_log(file, key, item)
    if gyros is None:
        _check_layout(file, layout_key, layout, entry)
    else:
        layout = _with_gyro_log(file, layout_key, layout, entry, rate, *gyros)
        if "where" in item:
            raise file.refuse_text(
                [*key, "where"],
                _("where, with a log of the gyros of its own"),
                _("span or rows"),
                _("select by time: span"),
            )
    where = item.get("where", {})
    span, rows = item.get("span", [None, None]), item.get("rows", [None, None])
    return {
        "key": [*key, "log"] if "log" in item else key,
        "file": name,
        "gyro_key": None if gyros is None else [*gyros[0], "log"],
        "gyro_file": None if gyros is None else gyros[1]["log"],
        "format": item.get("format", ""),
        "layout": layout,
        "label_columns": sorted(where),
        "label": "; ".join(f"{column}={where[column]}" for column in sorted(where)) or None,
        "from_s": span[0],
        "to_s": span[1],
        "from_row": rows[0],
        "to_row": rows[1],
    }


def _gyro_log(file: YamlFile, key: Key, item: dict[str, Any]) -> tuple[Key, dict[str, Any]] | None:
    """What is stated of the gyros' own log, and where; the campaign's goes with its log."""
    if "gyro" in item:
        return [*key, "gyro"], item["gyro"]
    if "gyro" in file.content and "log" not in item:
        return ["gyro"], file.content["gyro"]
    return None


def _with_gyro_log(
    file: YamlFile,
    layout_key: Key,
    layout: dict[str, Any],
    entry: dict[str, Any],
    rate: StatedRate,
    key: Key,
    stated: dict[str, Any],
) -> dict[str, Any]:
    """The layout of the accelerometers' log, with the file and layout of the gyros' log in it."""
    gyro_layout, gyro_key = layout, layout_key
    if "format" in stated:
        gyro_layout, gyro_key = _layout(file, key, stated, entry, rate)
    for own_key, own, sensor in (
        (layout_key, layout, "accelerometer"),
        (gyro_key, gyro_layout, "gyro"),
    ):
        if own["kind"] != "columns":
            raise file.refuse(
                [*own_key, "kind"],
                own["kind"],
                _("columns, for accelerometers and gyros with a log each"),
                _("remove gyro: the messages of a receiver hold both sensors"),
            )
        for needed in (sensor, "time"):
            if needed not in own:
                raise file.refuse_text(
                    own_key,
                    _("no {key!r}", key=needed),
                    _(
                        "time and {sensor}, for accelerometers and gyros have a log each",
                        sensor=sensor,
                    ),
                    _("add {key}", key=needed),
                )
        _check_layout(file, own_key, own, entry)
    own, others = (
        {key: value for key, value in one.items() if key != other}
        for one, other in ((layout, "gyro"), (gyro_layout, "accelerometer"))
    )
    gyros = {"file": stated["log"], "layout": others, "offset": stated.get("offset_s", 0.0)}
    return own | {"gyro_log": gyros}


def _layout(
    file: YamlFile, key: Key, item: dict[str, Any], entry: dict[str, Any], rate: StatedRate
) -> tuple[dict[str, Any], Key]:
    """The layout of a log, and where it is stated."""
    formats = file.content.get("formats", {})
    if "format" in item:
        if item["format"] not in formats:
            raise file.refuse(
                [*key, "format"],
                item["format"],
                _("one of {value}", value=", ".join(formats) or "formats, of which there are none"),
                _("correct the name or add it to formats"),
            )
        layout, layout_key = formats[item["format"]], ["formats", item["format"]]
        return _written_out(file, layout_key, layout, rate), layout_key
    if "format" not in entry:
        raise file.refuse_text(
            key,
            "no format",
            _("format, for the instrument {name} has none of its own", name=entry["name"]),
            _("name one of formats"),
        )
    layout_key = ["instrument", "format"]
    return _written_out(file, layout_key, entry["format"], rate), layout_key


def _written_out(
    file: YamlFile, key: Key, layout: dict[str, Any], rate: StatedRate
) -> dict[str, Any]:
    """The layout with the columns that its kind implies, and the rate that counts its rows."""
    if layout["kind"] == "vectornav":
        layout = vectornav_lines.layout_of(layout)
    return layout if layout["kind"] == "rawimus" else with_rate(file, key, layout, rate)


def _check_layout(file: YamlFile, key: Key, layout: dict[str, Any], entry: dict[str, Any]) -> None:
    """A layout must hold at least one sensor, in units of that sensor, or counts of known size."""
    if layout["kind"] == "rawimus":
        for sensor, count in (("gyro", "count_rad"), ("accelerometer", "count_m_s")):
            if count not in entry.get(sensor, {}) or not _stated_axes(entry, sensor):
                raise file.refuse_text(
                    ["instrument"],
                    _("no {sensor}.{count} or no axes", sensor=sensor, count=count),
                    _("the count sizes and axes of the raw fields"),
                    _("add them to the instrument"),
                )
        return
    _check_text(file, key, layout)
    if "gyro" not in layout and "accelerometer" not in layout:
        raise file.refuse_text(
            key, _("neither gyro nor accelerometer"), _("at least one of them"), "add its columns"
        )
    for sensor, units in (
        ("gyro", ("rad/s", "deg/s", "rad", "deg")),
        ("accelerometer", ("m/s2", "g", "m/s")),
    ):
        if sensor in layout and layout[sensor]["unit"] not in units:
            raise file.refuse(
                [*key, sensor, "unit"],
                layout[sensor]["unit"],
                _("one of {units}", units=", ".join(units)),
                "correct the unit",
            )
        triad = layout.get(sensor, {})
        if triad.get("unit") in INCREMENT_UNITS and are_means(layout):
            raise file.refuse(
                [*key, sensor, "unit"],
                triad["unit"],
                _("a unit of rates or forces, for rows are means"),
                _("divide the increments by their time"),
            )
        zeros = each(triad.get("zero_counts", 0))
        if max(zeros) > triad.get("limit_counts", np.inf):
            raise file.refuse(
                [*key, sensor, "limit_counts"],
                triad["limit_counts"],
                _("the largest count, above zero_counts {zero:g}", zero=max(zeros)),
                _("correct it: 65535 for unsigned counts of 16 bits"),
            )


RATES = {"sample": "rate_hz", "tick": "ticks_per_s"}  # what a time in this unit requires


UNITS = ("s", "ms", "us", "ns")  # of time, from the longest


def _check_two_columns(file: YamlFile, key: Key, time: dict[str, Any]) -> None:
    """A time in two columns has a unit for each, the longer first, and nothing else."""
    example = "{columns: [secs, nsecs], units: [s, ns]}"
    columns, units = time.get("columns", []), time.get("units", [])
    others = [own for own in time if own not in ("columns", "units")]
    found = ""
    if len(columns) < 2 or len(units) < 2:
        found = _("columns without units") if columns else _("units without columns")
    elif others:
        found = _("columns, and beside them {key}", key=others[0])
    elif columns[0] == columns[1]:
        found = _("column {column} twice", column=columns[0])
    elif UNITS.index(units[0]) >= UNITS.index(units[1]):
        found = _("{units}, of which the first is not the longer", units=", ".join(units))
    if found:
        raise file.refuse_text(
            key,
            found,
            _("whole seconds and their fraction, such as {example}", example=example),
            _("state both columns with a unit for each, or one column with its unit"),
        )


def _check_text(file: YamlFile, key: Key, layout: dict[str, Any]) -> None:
    """Its time must have a unit, and a number must not hold what separates two of them."""
    time = layout.get("time") or {}
    rate = RATES.get(time.get("unit", ""))
    if "columns" in time or "units" in time:
        _check_two_columns(file, [*key, "time"], time)
        missing = []
    elif time.get("column") is None:
        missing = [] if not time or "rate_hz" in time else ["rate_hz"]
    else:
        missing = [each for each in ("unit", rate) if each and each not in time]
    if missing:
        raise file.refuse_text(
            [*key, "time"],
            _("no key {missing!r}", missing=missing[0]),
            _("column with unit, or rate_hz; rate_hz with sample, ticks_per_s with tick"),
            f"add {missing[0]}",
        )
    if layout.get("decimal") == "," == layout.get("delimiter"):
        raise file.refuse(
            [*key, "decimal"],
            ",",
            _("another character than the delimiter"),
            _("correct decimal or delimiter"),
        )


def logs(
    manoeuvres: list[Row], entry: dict[str, Any], encoder: dict[str, Any] | None
) -> Iterator[Row]:
    """Every log with the layout of its bytes, complete with the properties of the instrument.

    `encoder`: the log of the table's encoder, if there is one.
    """
    for log, rows in by_log(manoeuvres).items():
        layout = rows[0]["layout"] | {"axes": _axes(entry)}
        if "gyro_log" in layout:
            gyros = layout["gyro_log"]
            layout["gyro_log"] = gyros | {"layout": gyros["layout"] | {"axes": _axes(entry)}}
        if layout["kind"] == "rawimus":
            layout |= {
                "gyro_count": entry["gyro"]["count_rad"],
                "accelerometer_count": entry["accelerometer"]["count_m_s"],
            }
        elif labels := sorted({column for row in rows for column in row["label_columns"]}):
            layout["label"] = labels
        if encoder is not None:
            layout["encoder"] = encoder
        yield {"log": log, "file": rows[0]["file"], "layout": json.dumps(layout, sort_keys=True)}


def by_log(manoeuvres: list[Row]) -> dict[str, list[Row]]:
    """Manoeuvres by log, whose name they get; a file in several formats counts as several logs."""
    formats: dict[str, set[str]] = {}
    for row in manoeuvres:
        formats.setdefault(row["file"], set()).add(row["format"])
    logs: dict[str, list[Row]] = {}
    for row in manoeuvres:
        single = len(formats[row["file"]]) == 1
        row["log"] = row["file"] if single else f"{row['file']}:{row['format']}"
        logs.setdefault(row["log"], []).append(row)
    return logs
