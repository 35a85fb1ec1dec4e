"""The log of the table's encoder, where a campaign has one beside the IMU's."""

from typing import Any

from stages.contracts.yaml_file import YamlFile

KEY = "encoder"


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
            f"one of {', '.join(formats) or 'formats, of which there are none'}",
            "correct the name or add it to formats",
        )
    layout = formats[stated["format"]]
    for key in ("time", "table_angle"):
        if key not in layout:
            raise file.refuse_text(
                ["formats", stated["format"]],
                f"no {key}",
                "time and table_angle, the columns of the encoder's log",
                f"add {key}",
            )
    return {
        "file": stated["log"],
        "layout": {key: layout[key] for key in layout if key not in ("gyro", "accelerometer")},
        "gps_week": stated.get("gps_week"),
        "offset": stated.get("offset_s", 0.0),
    }
