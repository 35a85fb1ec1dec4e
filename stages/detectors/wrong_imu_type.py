"""A receiver that says that another type of IMU is connected than the campaign does."""

from collections.abc import Iterator

import numpy as np

from stages.detectors.detector import Detector, Event, Log, Words
from stages.detectors.imu_types import IMU_TYPES
from stages.notation.numbers import significant

SAME = 1e-3  # by which the stated sizes of a count may differ: they are rounded


class WrongImuType(Detector):
    """The type in the messages has counts of another size than the campaign's instrument."""

    name = "wrong_imu_type"
    cause = "the campaign names another instrument, or the receiver was set up for another IMU"
    source = "NovAtel OEM7 manual, RAWIMUSX and Table: Raw IMU Scale Factors"
    costs = "all readings and with them biases and scale factors, by the ratio of the counts"
    unit = "1"
    severity = 3
    everywhere = True

    def concludes(self, log: Log) -> Iterator[Event]:
        if len(log.imu) > 1:
            yield log.event(float(len(log.imu)), facts=None)
            return
        for number in log.imu:
            if number not in IMU_TYPES:
                continue
            gyro, force = IMU_TYPES[number].counts(log.step)
            stated = log.count * log.step
            ratios = np.array([stated[3] / gyro, stated[0] / force])
            off = np.abs(ratios - 1) > SAME
            if off.any():
                yield log.event(float(ratios[off][0]), facts=(number, ratios))

    def tells(self, event: Event, name: str) -> Words:
        if event.facts is None:
            return Words(
                f"{name}: its messages tell {round(event.size)} types of IMU.",
                "At most one of them is this instrument; the counts of the others are of another"
                " size.",
                "The log is used as one. Record each IMU in a log of its own.",
            )
        number, (gyro, force) = event.facts
        return Words(
            f"{name}: its messages tell IMU type {number}, {IMU_TYPES[number].name}; a count of"
            f" this campaign's instrument is {significant(float(gyro), 5)} times that type's in the"
            f" gyros and {significant(float(force), 5)} times in the accelerometers.",
            "If the receiver is right, all readings are off by these ratios, and no motion of"
            " the table would agree with the plan.",
            "The campaign's figures are used. Name the instrument that was recorded.",
        )
