"""Accelerometers whose readings have all the same magnitude."""

from collections.abc import Iterator, Mapping

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log
from inertial.signal.scale_factor import quiet_force
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.messages import _
from inertial.text.numbers import significant

MIN_WINDOWS = 20  # at rest
MIN_TURNED = np.deg2rad(45.0)  # between two attitudes: in one alone an axis may stand still
MAX_SCATTER = 0.03  # of the magnitude, in that of the components


class NormalisedForce(Detector):
    """The magnitude of the specific force does not scatter, while its components do.

    By the means of rests in several attitudes. A sensor has as much noise along gravity as across
    it, and bias and scale factors make the magnitude another in each attitude.

    Cause: the “gravity” of a phone or of an attitude filter is logged, which is a direction times a
    constant. It tells nothing of bias and scale factors.
    """

    name = "normalised_force"
    source = "Android, TYPE_GRAVITY: the direction of gravity, of the magnitude 9.80665 m/s²"
    unit = "m/s²"
    sensor = "accel"
    severity = 3

    def detect_between_logs(self, logs: Mapping[str, Log]) -> Iterator[Event]:
        read = [log for log in logs.values() if len(quiet_force(log)) and not log.increments]
        own = [quiet_force(log) for log in read]
        if sum(map(len, own)) < MIN_WINDOWS:
            return
        force = np.concatenate(own)
        magnitude = np.linalg.norm(force, axis=1)
        usual = float(np.median(magnitude))
        scatter = MAD_TO_SIGMA * float(np.median(np.abs(magnitude - usual)))
        changes = np.concatenate([np.diff(each, axis=0) for each in own]) / np.sqrt(2)
        of_means = MAD_TO_SIGMA * float(np.median(np.median(np.abs(changes), axis=0)))
        samples = np.median([log.records / len(log.windows.mean) for log in read])
        of_noise = np.median([log.noise[:3] for log in read]) / np.sqrt(samples)
        along = force @ force[0] / (magnitude * magnitude[0])
        turned = along.min() < np.cos(MIN_TURNED)
        if turned and scatter < MAX_SCATTER * min(of_means, of_noise):
            yield Event(0, 0, 0, np.nan, np.nan, usual, sensor=self.sensor)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            _(
                "The readings of the accelerometers have the magnitude {force} m/s² in all "
                "attitudes, without noise: they are a direction that was multiplied by a constant.",
                force=significant(event.size, 6),
            ),
            _("Bias and scale factors of the accelerometers are not in the logs."),
            _(
                "The directions are used. Log the specific force, which phones call acceleration, "
                "not gravity, and record again."
            ),
        )
