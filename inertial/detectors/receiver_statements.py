"""What a receiver states of its IMU: another type than the campaign, records that are invalid."""

from collections.abc import Iterator
from dataclasses import dataclass
from math import radians

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.runs import runs
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

# ---- A receiver that reports another type of IMU than the campaign states.

# ---- The types of IMU by the number that NovAtel's messages tell, and what a count of theirs is.
#
# Source: NovAtel OEM7 Commands and Logs Reference Manual, "CONNECTIMU" (the numbers) and
# "RAWIMUSX", Table: Raw IMU Scale Factors; the same figures in NovAtel's own driver for ROS
# (oem7_imu.cpp). The Epson units send rates: their figures are divided by the output rate.

FOOT = 0.3048  # m
MILLI_G = 9.80665e-3  # m/s²
ARC_SECOND = radians(1 / 3600)


@dataclass(frozen=True)
class ImuType:
    """A type of IMU; its counts in rad and m/s, or, where they are rates, in rad/s and m/s²."""

    name: str
    gyro: float
    accelerometer: float
    rates: bool = False

    def counts(self, interval: float) -> tuple[float, float]:
        """What a count is of an increment over `interval`, s: rad, m/s."""
        per = interval if self.rates else 1.0
        return self.gyro * per, self.accelerometer * per


def _honeywell(name: str, power: int) -> ImuType:
    return ImuType(f"Honeywell {name}", 2.0**-33, FOOT * 2.0**-power)


_KVH = (0.1 / (3600 * 256), 0.05 * 2.0**-15)
_NORTHROP = (1e-9, 2e-8)
_EPSON_320 = (radians(0.008 * 2.0**-16), 0.2 * 2.0**-16 * MILLI_G)

IMU_TYPES = {
    1: _honeywell("HG1700 AG11", 27),
    4: _honeywell("HG1700 AG17", 26),
    5: _honeywell("HG1900 CA29", 27),
    8: ImuType("Northrop Grumman LN200", 2.0**-19, 2.0**-14),
    11: _honeywell("HG1700 AG58", 27),
    12: _honeywell("HG1700 AG62", 26),
    13: ImuType("iMAR iIMU-FSAS", 0.1 * 2.0**-8 * ARC_SECOND, 0.05 * 2.0**-15),
    16: ImuType("KVH CPT IMU", *_KVH),
    20: _honeywell("HG1930 AA99", 27),
    26: ImuType("Northrop Grumman Litef ISA-100C", *_NORTHROP),
    27: _honeywell("HG1900 CA50", 27),
    28: _honeywell("HG1930 CA50", 27),
    31: ImuType("Analog Devices ADIS16488", radians(720 * 2.0**-31), 200 * 2.0**-31),
    32: ImuType("Sensonor STIM300", radians(2.0**-21), 2.0**-22),
    33: ImuType("KVH 1750", *_KVH),
    41: ImuType("Epson G320N", *_EPSON_320, rates=True),
    52: ImuType("Northrop Grumman Litef µIMU", *_NORTHROP),
    56: ImuType("Sensonor STIM300D", radians(2.0**-21), 2.0**-22),
    58: ImuType("Honeywell HG4930 AN01", 2.0**-33, 2.0**-29),
    61: ImuType("Epson G370N", radians(0.0151515 * 2.0**-16), 0.4 * 2.0**-16 * MILLI_G, rates=True),
    62: ImuType("Epson G320N, 200 Hz", *_EPSON_320, rates=True),
    68: ImuType("Honeywell HG4930 AN04", 2.0**-33, 2.0**-29),
    69: ImuType("Honeywell HG4930 AN04, 400 Hz", 2.0**-33, 2.0**-29),
}


MAX_COUNT_DIFFERENCE = 1e-3  # by which the stated sizes of a count may differ: they are rounded


class WrongImuType(Detector):
    """The type in the messages has counts of another size than the campaign's instrument.

    Cause: the campaign names another instrument, or the receiver was set up for another IMU. All
    readings, and with them biases and scale factors, are wrong by the ratio of the counts.
    """

    name = "wrong_imu_type"
    source = "NovAtel OEM7 manual, RAWIMUSX and Table: Raw IMU Scale Factors"
    unit = "1"
    severity = 3

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        if len(log.imu) > 1:
            yield log.event(float(len(log.imu)), facts=None)
            return
        for number in log.imu:
            if number not in IMU_TYPES:
                continue
            gyro, force = IMU_TYPES[number].counts(log.interval)
            stated = log.count * log.interval
            ratios = np.array([stated[3] / gyro, stated[0] / force])
            off = np.abs(ratios - 1) > MAX_COUNT_DIFFERENCE
            if off.any():
                yield log.event(float(ratios[off][0]), facts=(number, ratios))

    def describe(self, event: Event, name: str) -> Description:
        if event.facts is None:
            return Description(
                _(
                    "{name}: its messages name {size} types of IMU.",
                    name=name,
                    size=round(event.size),
                ),
                _(
                    "At most one of them is this instrument; the counts of the others are of "
                    "another size."
                ),
                _("The log is used as one. Record each IMU in a log of its own."),
            )
        number, (gyro, force) = event.facts
        return Description(
            _(
                "{name}: its messages name IMU type {number}, {name_2}; a count of this "
                "campaign's instrument is {significant} times that type's in the gyros and "
                "{significant_2} times in the accelerometers.",
                name=name,
                number=number,
                name_2=IMU_TYPES[number].name,
                significant=significant(float(gyro), 5),
                significant_2=significant(float(force), 5),
            ),
            _(
                "If the receiver is right, all readings are off by these ratios, and no motion "
                "of the table would agree with the plan."
            ),
            _("The campaign's figures are used. Name the instrument that was recorded."),
        )


# ---- Records that the instrument itself calls invalid.


class StatusInvalid(Detector):
    """A record whose status lacks a bit that must be set, or has one that must be clear.

    Cause: the instrument found a fault in itself: a sensor, its temperature, a start-up. What it
    reads then is not to be trusted.
    """

    name = "status_invalid"
    source = "the status word in the instrument's manual, as data/instruments.yaml quotes it"
    unit = "records"
    masks = True

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        there = np.isfinite(piece.status)
        bits = np.where(there, piece.status, 0).astype(np.int64)
        lacks = ~bits & log.given.must_be_set
        has = bits & log.given.must_be_clear
        for start, end in runs(there & ((lacks | has) != 0)):
            facts = (int(bits[start]), int(lacks[start]), int(has[start]))
            yield piece.event(start, end, float(end - start), facts=facts)

    def describe(self, event: Event, name: str) -> Description:
        status, lacks, has = event.facts
        single = event.size == 1
        at = f", {fixed(event.from_s, 3)} s," if np.isfinite(event.from_s) else ""
        why = [
            _(
                "{lacks} {value} not set",
                lacks=_bits(lacks),
                value=_("is") if lacks.bit_count() == 1 else _("are"),
            )
        ] * bool(lacks)
        why += [
            _(
                "{bits} {value} set",
                bits=_bits(has),
                value=_("is") if has.bit_count() == 1 else _("are"),
            )
        ] * bool(has)
        return Description(
            _(
                "{name}: the instrument marks {counted} from line {line}{at} as invalid: status "
                "{status:08x}, {why}.",
                name=name,
                counted=counted(int(event.size), "record"),
                line=event.line,
                at=at,
                status=status,
                why=_(" and ").join(why),
            ),
            _("Their readings are not to be trusted, by up to the full range of the sensor."),
            _(
                "{value} masked; the time is counted. See the status word in the instrument's "
                "manual.",
                value=_("It is") if single else _("They are"),
            ),
        )


def _bits(word: int) -> str:
    """The bits that are set, by number from 0."""
    numbers = [str(bit) for bit in range(word.bit_length()) if word >> bit & 1]
    return f"bit{'s' if len(numbers) > 1 else ''} {', '.join(numbers)}"
