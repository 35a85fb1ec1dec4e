"""By how much parameters may change until the IMU is due for calibration again."""

from collections.abc import Iterator
from typing import Any

from inertial.tables.yaml_file import YamlFile
from stages.plan.certificate import LIMITS, SENSORS


def allowed_changes(campaign: YamlFile) -> Iterator[dict[str, Any]]:
    """The changes that a campaign file allows under `may_change`, in SI."""
    stated = campaign.content.get("may_change", {})
    for key, sensor in SENSORS:
        for name, limit in stated.get(key, {}).items():
            kind, size, unit = LIMITS[name]
            yield {"sensor": sensor, "kind": kind, "limit": limit * size, "unit": unit}
