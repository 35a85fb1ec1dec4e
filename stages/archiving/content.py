"""What makes a calibration another one: its numbers, and what they were made from."""

import hashlib
import json

from inertial.campaign.records import Row


def content_of(calibration: Row) -> str:
    """SHA-256 over IMU and campaign, numbers, inputs and settings of a row of the archive.

    The code does not belong to it: a program that was only tidied up gives the same numbers,
    and they are the same calibration.
    """
    told = {
        "of": [calibration[key] for key in ("campaign", "simulated", "instrument", "serial")],
        "date": calibration["date"],
        "parameters": sorted(
            [row["id"], row["unit"], row["frame"], row["value"], row["sigma"]]
            for row in calibration["parameters"]
        ),
        "covariance": sorted(
            [row["first"], row["second"], row["covariance"]] for row in calibration["covariance"]
        ),
        "inputs": sorted([row["file"], row["sha256"]] for row in calibration["inputs"]),
        "settings": {row["stage"]: row["settings"] for row in calibration["made_by"]},
    }
    return hashlib.sha256(json.dumps(told, sort_keys=True).encode()).hexdigest()
