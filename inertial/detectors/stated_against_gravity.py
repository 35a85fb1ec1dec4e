"""What a campaign states and gravity contradicts: gravity itself, and the rate of the table."""

from collections.abc import Iterator

import numpy as np

from inertial.detectors.time_of_turns import MIN_RATE_SIGMAS
from inertial.physics.site import ANOMALY_SIGMA
from inertial.signal.detector import Description, Detector, Event, Given
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant
from inertial.text.units import STANDARD_GRAVITY

# ---- A stated gravity that is not that of the place.

MGAL = 1e-5  # m/s²
MAX_ROUNDING = 2e-5  # m/s²: gravity is stated to as much


class GravityError(Detector):
    """Stated gravity differs from normal gravity at latitude and height by more than 3 sigma.

    Sigma is that of the stated value and the anomalies of the earth's field together. The plan
    decides it, for all stages alike.

    Cause: gravity of another place, the unit g in its stead, or a slip of the pen. The scale
    factors of all accelerometers are off by as much as gravity.
    """

    name = "gravity_error"
    source = "normal gravity: WGS 84; anomalies: Tscherning & Rapp, OSU Report 208, 1974"
    unit = "m/s²"
    sensor = "accel"

    def detect_in_campaign(self, given: Given) -> Iterator[Event]:
        off = given.refuted_gravity - given.normal_gravity
        if np.isfinite(off):
            yield Event(0, 0, 0, np.nan, np.nan, off, facts=given)

    def describe(self, event: Event, name: str) -> Description:
        given: Given = event.facts
        stated = given.refuted_gravity
        unit = abs(stated - STANDARD_GRAVITY) < MAX_ROUNDING
        why = _(" It is the size of the unit g, which is gravity of no place.") if unit else ""
        repaired = given.gravity != stated
        parts = -event.size / stated * 1e6
        return Description(
            _(
                "Gravity is stated as {gravity} m/s²; at this latitude and height normal "
                "gravity is {normal_gravity} m/s², from which it differs by {significant} mGal, "
                "{times} sigma of what the field of the earth explains.{why}",
                gravity=fixed(stated, 5),
                normal_gravity=fixed(given.normal_gravity, 5),
                significant=significant(event.size / MGAL, 3),
                times=significant(abs(event.size) / ANOMALY_SIGMA, 2),
                why=why,
            ),
            _(
                "Used, it would put the scale factors of all accelerometers off by {parts} "
                "ppm, all by the same.",
                parts=significant(parts, 3),
            ),
            _(
                "Normal gravity is used, with the sigma of what the field of the earth differs "
                "by. Correct gravity, latitude or height; or confirm it by accept: [gravity]."
            )
            if repaired
            else _(
                "The stated value is used. Correct it, latitude or height; or leave it out, and "
                "normal gravity is taken."
            ),
        )


# ---- A table whose rate is not the stated one, as gravity shows it.

MIN_LEVEL_TURNS = 2  # about level axes: one of them by itself is a rate of its own


def gravity_ratio(recorded: Recorded) -> float | None:
    """The rate of gravity in the turns at a stated rate about level axes, by that rate.

    None where it is that rate, within what the table keeps it to.
    """
    rate, sigma = recorded.gravity_rate.T
    known = recorded.steady & np.isfinite(rate)
    if np.count_nonzero(known) < MIN_LEVEL_TURNS or not np.isfinite(recorded.rate_sigma):
        return None
    ratios = rate[known] / np.abs(recorded.rate[known])
    ratio = float(np.median(ratios))
    own = float(np.hypot(np.median(sigma[known] / rate[known]), np.std(ratios)))
    return ratio if abs(ratio - 1) > MIN_RATE_SIGMAS * np.hypot(recorded.rate_sigma, own) else None


class TableRateByGravity(PlanDetector):
    """All turns at a stated rate about level axes go by another one, as gravity turns in the case.

    The scale factors of the gyros are by the stated rate, and gravity shows the one there was.

    Cause: the drive of the table is set, or calibrated, otherwise; or the clock of the logs is off.
    """

    name = "table_rate_off"
    source = "S1: an accelerometer reads gravity, which stands still while the case turns"
    unit = "1"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if (ratio := gravity_ratio(recorded)) is not None:
            number = int(
                np.count_nonzero(recorded.steady & np.isfinite(recorded.gravity_rate[:, 0]))
            )
            yield Deviation(None, "", ratio, self.sensor, count=number)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        assert deviation.size is not None
        faster = deviation.size > 1
        ppm = significant(1e6 * abs(deviation.size - 1), 4)
        return Description(
            _(
                "In {count} turns about level axes gravity turns {ppm} ppm {faster} than stated, "
                "and the table keeps its rate to {sigma} ppm: either the table turns that much "
                "{faster}, or a second of the logs is that much {longer}.",
                count=deviation.count,
                ppm=ppm,
                faster=_("faster") if faster else _("slower"),
                longer=_("longer") if faster else _("shorter"),
                sigma=significant(1e6 * recorded.rate_sigma),
            ),
            _(
                "If it is the table, the scale factors of all gyros are {ppm} ppm too {large}, for "
                "they are by the stated rate; if it is the logs, those of gyros that read rates "
                "stand.",
                ppm=ppm,
                large=_("large") if faster else _("small"),
            ),
            _(
                "Nothing is changed. Time some rounds of the table by another clock, and correct "
                "rate_deg_s of the plan, or rate_hz of the instrument; or state rate_sigma_ppm of "
                "the table as large as its rate is uncertain."
            ),
        )
