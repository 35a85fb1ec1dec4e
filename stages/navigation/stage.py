"""Free inertial navigation of the campaign's own rests and turns, before and after calibration.

At rest, and after a whole turn, the truth is known: the attitude is that of the start, velocity and
position are zero. Before as after calibration the attitude at the start is found from the same
readings, corrected in the same way: level by the accelerometers, north as the plan has it, or else
by the earth's rate where the gyros show it. So what an alignment absorbs, as the mounting rotation
that both triads share and the level part of an accelerometer's bias, counts neither as an error
before nor as a gain.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.masked_samples import Repairs
from inertial.campaign.records import Part, Row, rows_of
from inertial.campaign.solution import switch_ons_of
from inertial.estimation.triad import linear_names, triad_of_errors
from inertial.physics.forward import Triad
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.parameters import BIAS, sign_of
from stages.navigation.corridor import Uncertain, uncertain
from stages.navigation.declared import DECLARED
from stages.navigation.navigator import Navigator, reason_rows
from stages.navigation.windows import Readings, Window, readings, windows

ALREADY = _("the logs are compensated already, so there is nothing before calibration")


@dataclass(frozen=True, eq=False)
class CorrectedSamples:
    """The samples as they were recorded, with their repairs, and as compensated."""

    samples: Stream
    compensated: Stream
    channel_repairs: pd.DataFrame

    def readings(self, wanted: Sequence[Window]) -> Iterator[Readings]:
        """Of some windows, before and after."""
        return readings(self.samples, self.compensated, wanted, Repairs(self.channel_repairs))


@dataclass(frozen=True, eq=False)
class ResultTables:
    """The tables of the result and its uncertainty."""

    result: pd.DataFrame
    covariance: pd.DataFrame
    accelerometer_fit: pd.DataFrame
    gyroscope_fit: pd.DataFrame

    def of_mount(self, mount: str) -> list[Row]:
        """The parameters of a mount."""
        return [row for row in rows_of(self.result) if row["mount"] == mount]

    def uncertain(self, data: CampaignData) -> Uncertain | None:
        """What is known of a mount, in the course of time and temperature of its campaign."""
        between = {
            "accel": switch_ons_of(self.accelerometer_fit, data.mount),
            "gyro": switch_ons_of(self.gyroscope_fit, data.mount),
        }
        course = data.course
        return uncertain(
            self.of_mount(data.mount), self.covariance, lambda m: m.along(*course), between
        )


def navigation(
    mounts: Sequence[CampaignData],
    corrected: CorrectedSamples,
    segments: pd.DataFrame,
    campaign: pd.DataFrame,
    published: pd.DataFrame,
    result_tables: ResultTables,
) -> Tables:
    """Errors after 60 s, 10 min and whole turns; the longest course; the shares of the sources."""
    rows: dict[str, list[Row]] = {name: [] for name in DECLARED.writes}
    (facts,) = rows_of(campaign)
    before = published_triads(rows_of(published))
    for data in mounts:
        known = result_tables.uncertain(data)
        if known is None or facts["compensated"]:
            reason = why_not(result_tables.of_mount(data.mount), data.gravity.number)
            reason = ALREADY if facts["compensated"] else reason
            rows["navigation_errors"] += reason_rows([Part("", None, reason)], data.mount)
            continue
        wanted, short = windows(data, segments)
        navigator = Navigator(data, known, before)
        for each in corrected.readings(wanted):
            navigator.add(each)
        navigator.predict(short)
        rows["navigation_errors"] += navigator.error_rows
        rows["navigation_courses"] += navigator.course_rows
        rows["navigation_shares"] += navigator.share_rows
    return rows


def published_triads(rows: Sequence[Row]) -> dict[str, Triad]:
    """M and bias of accel and gyro by published values; what is not published is nominal.

    Empty where none of them is.
    """
    names = linear_names()
    values = {
        (row["sensor"], row["quantity"]): row["value"] for row in rows if row["quantity"] in names
    }
    if not values:
        return {}
    return {
        sensor: triad_of_errors([values.get((sensor, name), 0.0) for name in names])
        for sensor in ("accel", "gyro")
    }


# ---- What a calibration that leaves parameters open says about navigation, and why it is not tried

SECONDS = 60.0
THE_SENSORS = {"gyro": _("the gyros"), "accel": _("the accelerometers")}
MOST_NAMED = 6


def why_not(rows: Sequence[Row], gravity: float) -> str:
    """Which of M and bias are not determined, why, and what the biases that are lead to.

    To first order at rest: attitude b t, position g b t³/6 by a gyro's bias, b t²/2 by an
    accelerometer's (Titterton & Weston 2004, short-term propagation of errors).

    Parameters
    ----------
    rows : the result of one mount; `gravity`: m/s²
    """
    parts = []
    for sensor, name in THE_SENSORS.items():
        own = {row["parameter"]: row for row in rows if row["sensor"] == sensor}
        values = {key: (own.get(key) or {}).get("value") for key in linear_names()}
        missing = [key for key, value in values.items() if value is None]
        if not missing:
            continue
        reasons = dict.fromkeys(
            str(own[key]["reason"] or "").removesuffix(".") for key in missing if key in own
        )
        why = "; ".join(list(filter(None, reasons))[:2])
        listed = ", ".join(map(sign_of, missing[:MOST_NAMED]))
        if len(missing) > MOST_NAMED:
            listed += _(" and {count} more", count=len(missing) - MOST_NAMED)
        parts.append(_("of {sensor} {listed} are not determined", sensor=name, listed=listed))
        parts[-1] += f" ({why})" if why else ""
    sentence = _("Nothing is navigated, for {parts}", parts="; ".join(parts))
    known = _by_biases(rows, gravity)
    return f"{sentence}. {known}" if known else sentence


def _by_biases(rows: Sequence[Row], gravity: float) -> str:
    """What the uncertainty of the biases that are determined leads to after a minute at rest."""
    sigma = {
        sensor: [
            float(row["sigma"])
            for row in rows
            if row["sensor"] == sensor and row["parameter"] in BIAS and row["sigma"] is not None
        ]
        for sensor in THE_SENSORS
    }
    said = []
    if sigma["gyro"]:
        size = max(sigma["gyro"])
        said.append(
            _(
                "a gyro's bias {angle}″ of attitude and {metres} m",
                angle=significant(np.degrees(size * SECONDS) * 3600, 2),
                metres=significant(gravity * size * SECONDS**3 / 6, 2),
            )
        )
    if sigma["accel"]:
        metres = significant(max(sigma["accel"]) * SECONDS**2 / 2, 2)
        said.append(_("an accelerometer's bias {metres} m", metres=metres))
    if not said:
        return ""
    return _(
        "Of what is determined the largest σ adds, after {seconds:g} s at rest without an "
        "alignment to absorb it: {said}",
        seconds=SECONDS,
        said=", ".join(said),
    )


STAGE = Stage(
    navigation,
    DECLARED,
    gathers={**MOUNTS, "corrected": CorrectedSamples, "result_tables": ResultTables},
)
