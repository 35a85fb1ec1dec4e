"""A stated gravity that is not that of the place."""

from collections.abc import Iterator

import numpy as np

from inertial.physics.site import ANOMALY_SIGMA
from inertial.signal.detector import Description, Detector, Event, Given
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant
from inertial.text.units import STANDARD_GRAVITY

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
