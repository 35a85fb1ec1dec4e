"""The instrument of a receiver's counts, of those listed: by gravity, rate and whole turns."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from commands.draft.gravity import gravity_in
from commands.draft.scales import Scale, gyro_scale, turn_misfit
from commands.draft.series import Divided
from commands.draft.turning import turning
from inertial.tables.yaml_file import YamlFile
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import STANDARD_GRAVITY

INSTRUMENTS = Path(__file__).parents[2] / "data/instruments.yaml"
MAX_COUNT_ERROR, MAX_RATE_ERROR = 0.1, 0.05  # relative
RECEIVER_AXES = ["z", "-y", "x"]  # of every receiver of NovAtel


@dataclass(frozen=True)
class Receiver:
    """An instrument as the campaign file names it or writes it out."""

    instrument: str | dict[str, Any]
    accel: Scale
    gyro: Scale


def receiver_of(recordings: Sequence[Divided], rate: float) -> Receiver:
    """The instrument of these counts at `rate`, Hz."""
    length = gravity_in(recordings).length
    count = STANDARD_GRAVITY / length / rate
    seen = _("|f| at rest makes one count {count} m/s", count=significant(count))
    listed = YamlFile(INSTRUMENTS).content
    fitting = {}
    for name, entry in listed.items():
        own = entry.get("accelerometer", {}).get("count_m_s")
        same_rate = abs(entry.get("rate_hz", rate) / rate - 1) < MAX_RATE_ERROR
        if own and same_rate and abs(own / count - 1) < MAX_COUNT_ERROR:
            size = entry["gyro"]["count_rad"]
            fitting[name] = (turn_misfit(recordings, size * rate), own, size)
    if fitting:
        least = min(misfit for misfit, *_sizes in fitting.values())
        best = [name for name, own in fitting.items() if own[0] <= least + 1e-9]
        _misfit, own, size = fitting[best[0]]
        why = _("{seen}, that of {names}", seen=seen, names=", ".join(best))
        return Receiver(
            best[0],
            Scale("m/s2", 1 / (own * rate), 0.0, why, False),
            Scale("rad/s", 1 / (size * rate), 0.0, why, False),
        )
    accel = Scale("m/s2", length / STANDARD_GRAVITY, 0.0, seen, True)
    gyro = gyro_scale(recordings, turning(recordings, accel.zero), [])
    entry = {
        "axes": RECEIVER_AXES,
        "gyro": {"count_rad": float(f"{gyro.size / rate:.4g}")},
        "accelerometer": {"count_m_s": float(f"{count:.4g}")},
    }
    return Receiver(entry, accel, gyro)
