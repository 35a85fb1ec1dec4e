"""Readings that are in another unit, or in the counts of another instrument."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description, Detector, Event, Log, Piece
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, Rescaled
from inertial.signal.scale_factor import (
    MAX_SCALE_ERROR,
    common_turn_ratio,
    explanation_of,
    force_at_rest,
    radius_at_rest,
    turn_ratios,
)
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

UNSIGNED_ZEROS = tuple(2.0**bits for bits in (11, 13, 15, 23))  # of counts of 12, 14, 16, 24 bits
MAX_FROM_ZERO = 0.25  # of the zero, by which the median of a channel may be away from it
MAX_REMOVED = 0.05  # of gravity, that is left where a filter has subtracted it
MAX_FORCE_OF_NOISE = 30.0  # times the noise of a reading
UNKNOWN_CAUSE = _("no known unit explains it; the bias may be large, or the IMU was not at rest")


class WrongScaleFactor(Detector):
    """The specific force at rest is not gravity, by more than any bias explains.

    Cause: another unit, another full scale, or the counts of another instrument. Every parameter is
    wrong by this factor.
    """

    name = "wrong_scale_factor"
    source = "design study 41e; S0 names the iMAR-FSAS, but its gyro counts are 57.3 times as large"
    unit = "1"
    sensor = "accel"
    severity = 3

    def detect_in_log(self, log: Log) -> Iterator[Event]:
        radius = radius_at_rest(log)
        force = radius if np.isfinite(radius) else force_at_rest(log)
        ratio = force / log.given.gravity
        if np.isfinite(ratio) and abs(ratio - 1) > MAX_SCALE_ERROR["accel"]:
            zero = unsigned_zero(log)
            if zero:
                cause = _("the counts are unsigned, with their zero at {zero}", zero=f"{zero:.0f}")
                yield log.event(ratio, facts=(force, cause, zero))
                return
            # A count of a receiver is an increment, which its interval has made a rate.
            increments = log.recorded_on is not None
            count = float(np.nanmedian(log.count[:3])) * log.interval if increments else np.nan
            cause = explanation_of(ratio, "accel", log.given, count) or UNKNOWN_CAUSE
            yield log.event(ratio, facts=(force, cause, 0.0))

    def describe(self, event: Event, name: str) -> Description:
        force, cause, zero = event.facts
        action = _(
            "Correct the unit, counts_per_unit or count size, or the name of the instrument in "
            "the campaign; where other logs read right, in a format of this log's own. Where all "
            "rests confirm a known factor, segment divides by it."
        )
        if zero:
            action = _(
                "State zero_counts: {zero} for accelerometer and gyro in the campaign file.",
                zero=f"{zero:.0f}",
            )
        return Description(
            _(
                "{name}: at rest the specific force is {force} m/s², {size} times gravity: "
                "{cause}.",
                name=name,
                force=significant(force),
                size=significant(event.size),
                cause=cause,
            ),
            _(
                "What this log reads of the specific force is {size} times what it should be, and "
                "so are the bias, scale factors and cross-axis terms that follow from it.",
                size=significant(event.size),
            ),
            action,
        )


class GravityRemoved(Detector):
    """Accelerometers that read nothing at rest: what is logged is not the specific force.

    At rest the readings are as small as their noise and bias, in all axes. In another unit gravity
    would still be far above the noise, which the unit changes with it.

    Cause: the “linear acceleration” of a phone or of an attitude filter is logged, from which the
    filter's gravity is subtracted. Nothing can be calibrated by it.
    """

    name = "gravity_removed"
    source = "IEEE Std 528-2019, specific force: at rest it is the reaction to gravity"
    unit = "m/s²"
    sensor = "accel"
    severity = 3
    masks = True
    alike = "sensor"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        force, noise = force_at_rest(log), float(np.linalg.norm(log.noise[:3]))
        most = min(MAX_REMOVED * log.given.gravity, MAX_FORCE_OF_NOISE * noise)
        if force < most and np.isfinite(piece.values[:, :3]).any(axis=0).all():
            yield piece.event(0, len(piece), force, sensor=self.sensor)

    def describe(self, event: Event, name: str) -> Description:
        return Description(
            _(
                "{name}: at rest the accelerometers read {force} m/s² in all: gravity has been "
                "subtracted from the specific force.",
                name=name,
                force=significant(event.size, 2),
            ),
            _("Bias, scale factors and cross-axis terms of the accelerometers are not in the log."),
            _(
                "The readings are masked. Log the specific force, which phones call acceleration, "
                "not linear acceleration, and record again."
            ),
        )


def unsigned_zero(log: Log) -> float:
    """The count in the middle of a converter's range about which all channels read; 0 if none.

    By the medians of six signed channels one may be so large, but not all of them alike.
    """
    sizes = np.where(np.isfinite(log.count), log.count, log.quantum)
    recorded = np.isfinite(log.windows.mean).any(axis=0) & (sizes > 0)
    if np.count_nonzero(recorded) < 3:
        return 0.0
    counts = np.nanmedian(log.windows.mean[:, recorded], axis=0) / sizes[recorded]
    alike = [z for z in UNSIGNED_ZEROS if (np.abs(counts / z - 1) < MAX_FROM_ZERO).all()]
    return max(alike, default=0.0)


class WrongScaleOfTurns(PlanDetector):
    """All turns are off by one ratio, in rate and in angle.

    Cause: another unit, another full scale, or the counts of another instrument. Every parameter of
    the gyros is wrong by this ratio.
    """

    name = "wrong_scale_factor"
    source = "design study, 0: S0's log, read by the count of the iMAR-FSAS, turns at 0.17 °/s"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.undone.rescaled:
            yield Deviation(
                None,
                each.log,
                each.ratio,
                self.sensor,
                count=len(each.names),
                facts=each,
                repair=each.repair,
            )
        common = common_turn_ratio(recorded)
        if common is not None:
            ratio, why = common
            rate, _ = turn_ratios(recorded)
            number = int(np.isfinite(rate).sum())
            yield Deviation(None, "", ratio, self.sensor, count=number, facts=why)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        if isinstance(deviation.facts, Rescaled):
            return _undone(deviation.facts)
        ratio, why = deviation.size, deviation.facts
        assert ratio is not None
        rate, angle = turn_ratios(recorded)
        i = int(np.flatnonzero(np.isfinite(rate))[0])
        read = fixed(float(np.degrees(recorded.speed[i])), 5)
        far = ""
        if np.isfinite(angle[i]):
            far = _(" and by {fixed}°", fixed=fixed(float(np.degrees(recorded.moved[i])), 3))
        turns = (
            _("The turn") if deviation.count == 1 else _("All {count} turns", count=deviation.count)
        )
        verb = _("is") if deviation.count == 1 else _("are")
        return Description(
            _(
                "{turns} {verb} {ratio} times as fast and as far as planned ({name}: {read} "
                "°/s{far} in place of {fixed} °/s): {why}.",
                turns=turns,
                verb=verb,
                ratio=significant(ratio, 5),
                name=recorded.name[i],
                read=read,
                far=far,
                fixed=fixed(float(np.degrees(recorded.rate[i])), 0),
                why=why,
            ),
            _(
                "Bias, scale factors and cross terms of the gyros are {ratio} times what they "
                "should be; no angle fits the plan, so {count} {verb} left out.",
                ratio=significant(ratio, 5),
                count=counted(deviation.count, "turn"),
                verb=verb,
            ),
            _(
                "Nothing is changed. Correct the unit, counts_per_unit or count size, or the "
                "name of the instrument in the campaign."
            ),
        )


def _undone(rescaled: Rescaled) -> Description:
    """Turns that fit the plan once the size of a count is set right."""
    where = _("in {log}", log=rescaled.log) if rescaled.log else _("in all logs")
    ratio = significant(rescaled.ratio, 5)
    return Description(
        _(
            "The gyros read {ratio} times what they should {where}, by {turns} of the plan: {why}.",
            ratio=ratio,
            where=where,
            turns=counted(len(rescaled.names), "turn"),
            why=rescaled.why,
        ),
        _(
            "Taken as recorded, bias, scale factors and cross terms of the gyros would be {ratio} "
            "times what they should be.",
            ratio=ratio,
        ),
        _(
            "The readings are divided by it before the estimation, on this condition. Correct the "
            "unit, counts_per_unit or count size, or the name of the instrument; or confirm it by "
            "accept: [{repair}].",
            repair=rescaled.repair,
        ),
    )
