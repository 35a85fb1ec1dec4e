"""What was recorded of each manoeuvre, against what the plan says of it."""

from collections.abc import Iterator, Sequence
from math import degrees, pi

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from stages.contracts.findings import Finding
from stages.contracts.records import Manoeuvre, Performed
from stages.segmentation.matching import Part, motion
from stages.segmentation.motion import Stretch
from stages.segmentation.windows import BIN, Binned

Array = NDArray[np.float64]


def not_found(m: Manoeuvre) -> Performed:
    """A manoeuvre of which the log has nothing."""
    what = "no rest in the planned direction" if m.do == "rest" else "no turn about its axis"
    told = f"{m.name} is not in {m.log}: {what} was found where the plan has it."
    return Performed(m.name, told, found=False, complete=False)


def positions(m: Manoeuvre, number: int) -> Performed:
    """A search for positions, and how many it found."""
    told = f"{number} rests of at least {m.seconds:g} s were found; their attitudes are unknown."
    return Performed(m.name, told, found=number > 0, complete=number > 0)


def rest(one: Binned, m: Manoeuvre, stretch: Stretch) -> Performed:
    """A rest and its duration."""
    seconds = one.duration(stretch.first, stretch.after)
    if not np.isfinite(one.first_s[stretch.first]):
        records = int(one.edges[stretch.after] - one.edges[stretch.first])
        return Performed(m.name, f"{records} records at rest, without time.")
    of = f" of the {m.seconds:g} s planned" if m.seconds else ""
    return Performed(m.name, f"{seconds:.2f} s at rest{of}.", seconds=seconds)


def turn(
    one: Binned,
    found: Sequence[Stretch],
    place: int,
    m: Manoeuvre,
    parts: Sequence[Part],
    gaps: pd.DataFrame,
    level: Array,
    interval: float,
    tolerance: float,
) -> Performed:
    """A turn: its angle, its rate, and whether all of it was recorded."""
    first, after = motion(one, found, place)
    about = one.about(m.axis, level)
    moving = [part for part in parts if not part.phase.startswith("rest")]
    lost = gaps[
        (gaps["log"] == one.window.log)
        & (gaps["record"] > moving[0].first)
        & (gaps["record"] < moving[-1].after)
    ]
    missing_s = float(lost["missing"].sum()) * interval
    rate = _steady_rate(one, about, parts, first, after)
    seconds = one.duration(first, after)
    timed = bool(np.isfinite(one.first_s[first]))
    angle = float(np.nansum(about[first:after] * one.seconds[first:after])) if timed else None
    if m.recorded == "steady":
        said = (
            f"steady at {_signed(degrees(rate), 4)} °/s." if rate is not None else "no steady rate."
        )
        whole = missing_s == 0
        return Performed(m.name, said, True, whole, angle, None, missing_s, rate, seconds)

    if angle is None:
        return Performed(m.name, "it turns, but has no time.", True, False, rate=rate)
    of = f"{_signed(degrees(angle), 2)}°"
    of += f" of {_signed(degrees(m.angle), 0)}°" if m.angle else ""
    reasons = [f"{missing_s:.2f} s are missing while it turns"] if missing_s else []
    remark = ""
    # A hand stops within a bin: what is cut off then is less than the sigma of the angle.
    edges = [("begins", about[0])] if first == 0 else []
    edges += [("ends", about[-1])] if after == one.bins else []
    for what, edge in edges:
        if abs(edge) * BIN / 2 < (m.angle_sigma or 0.0):
            remark += f"; the log {what} at {degrees(abs(edge)):.0f} °/s, which its sigma covers"
        else:
            reasons.append(f"the log {what} while it turns")
    if not reasons and m.angle and abs(angle / m.angle - 1) > tolerance:
        reasons.append("the angle is not the planned one")
    if not reasons:
        told = f"{of} from rest to rest{remark}."
        return Performed(m.name, told, True, True, angle, 0.0, 0.0, rate, seconds)
    missing = m.angle - angle if m.angle is not None else None
    if missing_s and rate is not None and not edges:
        missing = rate * missing_s
    told = f"{of} recorded: {', and '.join(reasons)}"
    told += f"; {_signed(degrees(missing), 2)}° are missing." if missing is not None else "."
    return Performed(m.name, told, True, False, angle, missing, missing_s, rate, seconds)


def _signed(value: float, digits: int) -> str:
    """A number with a minus sign, not a hyphen."""
    return f"{value:.{digits}f}".replace("-", "−")


def _steady_rate(
    one: Binned, about: Array, parts: Sequence[Part], first: int, after: int
) -> float | None:
    steady = [part for part in parts if part.phase == "steady"]
    if not steady:
        return None
    inside = (one.edges[:-1] >= steady[0].first) & (one.edges[1:] <= steady[0].after)
    return float(np.nanmean(about[inside] if inside.any() else about[first:after]))


def findings(m: Manoeuvre, done: Performed, tolerance: float) -> Iterator[Finding]:
    """What the plan has and the recording has not."""
    if not done.found:
        yield Finding(
            id=f"segment/manoeuvre_missing/{m.name}",
            cause="manoeuvre_missing",
            sentence=done.sentence,
            consequence="It is left out; the others are used.",
            action="Correct the plan, or record it.",
            severity=2,
            manoeuvre=m.name,
            log=m.log,
        )
        return
    if m.do != "turn":
        return
    if not done.complete and m.recorded == "whole":
        missing = done.missing_angle
        yield Finding(
            id=f"segment/incomplete_turn/{m.name}",
            cause="incomplete_turn",
            sensor="gyro",
            size=None if missing is None else degrees(missing),
            unit="°",
            sentence=f"{m.name}: {done.sentence}",
            consequence="Its angle is not known, so it gives no scale factor.",
            action="It is left out of the angle method. Record it again.",
            severity=2,
            manoeuvre=m.name,
            log=m.log,
        )
    turned, wanted = (done.rate, m.rate) if m.rate is not None else (done.angle, m.angle)
    if turned is None or wanted is None:
        return
    ratio = turned / wanted
    if ratio < 0:
        yield Finding(
            id=f"segment/wrong_direction/{m.name}",
            cause="wrong_direction",
            sensor="gyro",
            size=ratio,
            sentence=f"{m.name} turns against the planned direction.",
            consequence="The sign of its scale factor would be wrong; it is left out.",
            action="Correct the sign of degrees, or the axes of the gyros.",
            severity=3,
            manoeuvre=m.name,
            log=m.log,
        )
    elif m.rate is not None and abs(ratio - 1) > tolerance:
        swapped = min(abs(ratio * pi / 180 - 1), abs(ratio * 180 / pi - 1)) < tolerance
        cause = ": degrees are taken for radians, or the other way round" if swapped else ""
        yield Finding(
            id=f"segment/wrong_rate/{m.name}",
            cause="wrong_rate",
            sensor="gyro",
            size=ratio,
            sentence=f"{m.name} turns at {degrees(turned):.4g} °/s, {ratio:.6g} times the planned"
            f" {degrees(wanted):.4g} °/s{cause}.",
            consequence="Its angle does not agree with the plan either.",
            action="Correct the rate of the plan, or the unit or count size of the gyros.",
            severity=3,
            manoeuvre=m.name,
            log=m.log,
        )
