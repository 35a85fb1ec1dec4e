"""A temperature that the campaign states otherwise than it was recorded."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.text.messages import _
from inertial.text.numbers import significant
from inertial.text.units import ICE_POINT

ASSUMED_SIGMA = 1.0  # K, of a stated temperature without one: the display of a chamber
MAX_SIGMA = 3.0  # of the stated temperature


class TemperatureMisstated(PlanDetector):
    """The stated temperature of a manoeuvre is more than three sigma off the recorded one.

    Cause: a wrong temperature in the plan, or a thermometer that is not where the sensors are. If
    the stated one is right, the temperature at which each parameter is valid is off as much.
    """

    name = "temperature_misstated"
    source = "IEEE Std 1554-2005: temperature of the chamber and of the instrument differ"
    unit = "K"
    severity = 1

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        off = recorded.temperature - recorded.stated_temperature
        sigma = np.where(
            np.isnan(recorded.temperature_sigma), ASSUMED_SIGMA, recorded.temperature_sigma
        )
        for i in np.flatnonzero(np.abs(off) > MAX_SIGMA * sigma):
            yield self.of(recorded, int(i), float(off[i]))

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None and deviation.size is not None
        at, stated = (
            significant(float(kelvin) - ICE_POINT, 3)
            for kelvin in (recorded.temperature[i], recorded.stated_temperature[i])
        )
        return Description(
            _(
                "{name}: the thermometer reads {at} °C, and the campaign states {stated} °C.",
                name=recorded.name[i],
                at=at,
                stated=stated,
            ),
            _(
                "The recorded one counts. If the sensors were at the other, what depends on the "
                "temperature is attributed to one that is {off} K off.",
                off=significant(abs(deviation.size), 2),
            ),
            _("Correct temperature_deg_c, or state its temperature_sigma_k."),
        )
