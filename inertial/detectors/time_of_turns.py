"""The time of turns by the plan: its unit, the sampling rate, and samples that are lost."""

from collections.abc import Iterable, Iterator

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.detectors.stamp_faults import TIME_UNITS
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.signal.scale_factor import MAX_RATIO_SPREAD, turn_ratios
from inertial.signal.scatter import MAD_TO_SIGMA
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant

MAX_LISTED = 3  # turns that a sentence names
MIN_TURNS = 2  # that show a unit of the time
MAX_TIME_RATIO = 1.1  # of the thousands by which all turns take longer


def thousands_longer(recorded: Recorded) -> int:
    """By how many thousands all turns take longer than planned at the planned rate; 0: by none."""
    rate, angle = turn_ratios(recorded)
    with np.errstate(divide="ignore", invalid="ignore"):
        longer = np.log10(np.abs(angle / rate))
    longer = longer[np.isfinite(longer)]
    if len(longer) < MIN_TURNS:
        return 0
    thousands = round(float(np.median(longer)) / 3)
    alike = np.abs(longer - 3 * thousands) < np.log10(MAX_TIME_RATIO)
    return thousands if alike.all() and abs(thousands) < len(TIME_UNITS) else 0


class WrongTimeUnitOfTurns(PlanDetector):
    """All turns go at the planned rate, and a thousand times, or a thousandth, as far.

    Cause: the time is in another unit than the format states. Rates are read as they are, so every
    angle, which is a rate times a time, is off by that factor.
    """

    name = "wrong_time_unit"
    source = "milliseconds that were read as seconds: 359542° in a turn of 360°"
    severity = 3

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if thousands := thousands_longer(recorded):
            yield Deviation(None, "", 1000.0**thousands, facts=thousands)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        thousands = deviation.facts
        coarse, fine = TIME_UNITS[0], TIME_UNITS[abs(thousands)]
        stated, likely = (coarse, fine) if thousands > 0 else (fine, coarse)
        return Description(
            _(
                "All turns have the planned rate and {ratio} times the planned angle: as if the "
                "time of the logs were in {likely} where {stated} is stated.",
                ratio=f"{1000.0**thousands:g}",
                likely=likely,
                stated=stated,
            ),
            _("Angles of turns, durations and drifts are off by this factor."),
            _("Nothing is changed. Correct the unit of the time in the format."),
        )


MIN_ALIKE_TURNS = 3  # that show another rate of the samples: two may be cut off alike
MIN_RATE_SIGMAS = 5.0  # of the table's rate, and of the scatter of its turns and within them
MAX_TIME_SPREAD = 0.02  # of the ratios of the times of turns to their plan, and of their rates


def time_ratio(recorded: Recorded) -> float | None:
    """By how many times all turns take longer than planned at the planned rate.

    None where they do not, or by thousands, as in another unit.
    """
    rate, angle = turn_ratios(recorded)
    known = np.isfinite(rate) & np.isfinite(angle)
    if np.count_nonzero(known) < MIN_ALIKE_TURNS or thousands_longer(recorded):
        return None
    unsteady = float(np.median(recorded.unsteady[known]))
    rate, longer = rate[known], angle[known] / rate[known]
    ratio = float(np.median(longer))
    as_planned = np.abs(rate - 1).max() <= MAX_RATIO_SPREAD
    alike = ratio > 0 and np.abs(longer / ratio - 1).max() <= MAX_TIME_SPREAD
    off = abs(ratio - 1) > max(recorded.tolerance, MIN_RATE_SIGMAS * unsteady)
    return ratio if as_planned and alike and off else None


def slight_time_ratio(recorded: Recorded) -> float | None:
    """The same where it is small, and beyond what the table's rate is uncertain by."""
    rate, angle = turn_ratios(recorded)
    known = np.isfinite(rate) & np.isfinite(angle)
    longer = angle[known] / rate[known]
    as_recorded = bool(
        recorded.undone.restated
    )  # rates in place of the plan's: by the gyros themselves
    if len(longer) < MIN_ALIKE_TURNS or as_recorded or not np.isfinite(recorded.rate_sigma):
        return None
    ratio = float(np.median(longer))
    # Of turns without a steady rate its mean is none of the table's.
    scatter = np.hypot(np.std(longer), np.median(recorded.unsteady[known]))
    sigma = np.hypot(recorded.rate_sigma, scatter)
    within = abs(ratio - 1) <= recorded.tolerance
    return ratio if within and abs(ratio - 1) > MIN_RATE_SIGMAS * sigma else None


class SampleRateByTurns(PlanDetector):
    """All turns go at the planned rate, and by one ratio farther, or less far, than planned.

    By the reading of a gyro both ratios are off by its scale factor, so what counts is one by the
    other. Where they differ by little, the speed of the table may be off as well.

    Cause: samples are counted by a rate at which they were not taken, or the clock of the logger
    runs fast or slow. Rates are read as they are, so every angle, which is a rate times a time, is
    off by that ratio.
    """

    name = "rate_off"
    source = "125 samples per second, read as 100: 450° in a turn of 360°, at the planned rate"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        ratio = time_ratio(recorded)
        if ratio is not None:
            rate, angle = turn_ratios(recorded)
            number = int(np.count_nonzero(np.isfinite(rate) & np.isfinite(angle)))
            yield Deviation(None, "", ratio, self.sensor, count=number)
        elif (ratio := slight_time_ratio(recorded)) is not None:
            yield Deviation(None, "", ratio, self.sensor, facts=recorded.rate_sigma, severity=2)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        ratio, stated = deviation.size, 1 / recorded.given.interval
        assert ratio is not None
        if deviation.facts is not None:
            return _slightly_off(ratio, deviation.facts, stated)
        rate, angle = turn_ratios(recorded)
        i = int(np.flatnonzero(np.isfinite(rate) & np.isfinite(angle))[0])
        far, planned = np.degrees([recorded.moved[i], recorded.angle[i]]).tolist()
        samples = _("the samples were taken {ratio} times as fast", ratio=significant(ratio, 3))
        state = _("the rate at which they were taken")
        if np.isfinite(stated):
            taken = significant(stated * ratio, 3)
            samples = _(
                "{taken} samples were taken per second where {stated} are stated",
                taken=taken,
                stated=significant(stated),
            )
            state = f"rate_hz: {taken}"
        return Description(
            _(
                "All {count} turns go at the planned rate, and {ratio} times as far as planned "
                "({name}: {far}° in place of {planned}°): as if {samples}.",
                count=deviation.count,
                ratio=significant(ratio, 4),
                name=recorded.name[i],
                far=fixed(far, 2),
                planned=fixed(planned, 0),
                samples=samples,
            ),
            _(
                "Angles of turns, durations, drifts and noise densities are off by this factor; no "
                "angle fits the plan, so the turns are left out."
            ),
            _(
                "Nothing is changed. State {state}, or correct the time of the logs; if the table "
                "did turn so far, correct degrees in the plan.",
                state=state,
            ),
        )


def _slightly_off(ratio: float, rate_sigma: float, stated: float) -> Description:
    """The time of the logs, or the speed of the table, is off by little."""
    state = _("how many samples there are in a second by another clock")
    if np.isfinite(stated):
        state = f"rate_hz: {fixed(stated * ratio, 3)}"
    return Description(
        _(
            "By the time of the logs all turns are {ppm} ppm {slower} than planned, by their angle "
            "and by the rate, which the table keeps to {sigma} ppm: either the samples are taken "
            "at another rate, or the table is that much {slower}, or its turns go {further}.",
            ppm=significant(1e6 * abs(ratio - 1), 3),
            slower=_("slower") if ratio > 1 else _("faster"),
            further=_("that much further") if ratio > 1 else _("less far by that much"),
            sigma=significant(1e6 * rate_sigma),
        ),
        _(
            "If it is the samples or the angles, the scale factors of all gyros are off by {ppm} "
            "ppm; if it is the speed, they stand, for they are by the angle.",
            ppm=significant(1e6 * (ratio - 1), 3),
        ),
        _(
            "Nothing is changed. Time some thousand samples by another clock and state {state}; "
            "state rate_sigma_ppm of the table as large as its speed is uncertain; or add whole "
            "turns about a level axis, in which gravity shows how far they go.",
            state=state,
        ),
    )


MIN_SHORT_TURNS = 2  # of one alone the table may have stopped elsewhere: the model has it
ASSUMED_RATE_SIGMA = 1e-3  # of a table, relative, where none is stated
MIN_LOST_SHARE = 0.5  # of what an angle lacks for its rate, by which it is short: else the rate is
MIN_SAME_COSINE = 0.999  # of the axes of two turns of one gyro


def short_turns(recorded: Recorded) -> Booleans:
    """Which whole turns have too small an angle for their rate, by that of most others, (m,)."""
    rate, angle = turn_ratios(recorded)
    known = np.isfinite(rate) & np.isfinite(angle) & recorded.complete & (rate > 0)
    short = np.zeros(len(known), bool)
    if not known.any() or recorded.undone.restated:
        return short
    longer = np.where(known, angle, 1.0) / np.where(known, rate, np.nan)
    lacking = 1 - longer / np.nanmedian(longer)
    of_table = np.nan_to_num(recorded.rate_sigma, nan=ASSUMED_RATE_SIGMA)
    scatter = np.hypot(of_table, MAD_TO_SIGMA * np.nanmedian(np.abs(lacking)))
    short[known] = (lacking > MIN_RATE_SIGMAS * np.hypot(scatter, recorded.unsteady))[known]
    whole = _angles_of_whole(recorded, np.where(known & ~short, angle, np.nan))
    short &= 1 - angle / whole > MIN_LOST_SHARE * lacking
    few = MIN_SHORT_TURNS <= np.count_nonzero(short) < np.count_nonzero(known) / 2
    return short if few else np.zeros(len(known), bool)


def _angles_of_whole(recorded: Recorded, ratios: Array) -> Array:
    """What each turn would read over its plan, were it whole, (m,): as the others about its axis.

    Where there is none of these, as planned. `ratios`: (m,), those of whole turns, NaN of others.
    """
    same = np.abs(np.nan_to_num(recorded.about) @ np.nan_to_num(recorded.about).T) > MIN_SAME_COSINE
    own = [ratios[others & np.isfinite(ratios)] for others in same]
    return np.array([float(np.median(one)) if len(one) else 1.0 for one in own])


class LostSamplesOfTurns(PlanDetector):
    """Turns whose angle is short though their rate is not, as none of most others is.

    Cause: samples are lost, and the stamps are counted as if none were. An asymmetry of the gyros
    changes the rate they read as well, and so does a dead band; a table that stops before does not.
    """

    name = "samples_lost"
    source = "5 samples of 50 Hz lost in a turn at 40 °/s: 356° in place of 360°"
    unit = "°"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        short = np.flatnonzero(short_turns(recorded))
        if len(short):
            lacking = np.degrees(np.abs(recorded.angle[short]) - np.abs(recorded.moved[short]))
            worst = float(lacking.max())
            yield Deviation(None, "", worst, self.sensor, count=len(short), facts=short)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        short = deviation.facts
        return Description(
            _(
                "{turns} have too small an angle for their rate, which is as in the others: "
                "{listed}. Samples are lost there that the stamps do not show, or the table "
                "stopped before.",
                turns=counted(len(short), "turn"),
                listed=", ".join(angles_in_words(recorded, short[:MAX_LISTED])),
            ),
            _("Taken as planned, they make an asymmetry of the gyros, or wrong scale factors."),
            _(
                "Record them again with a counter or a clock in which lost samples show; if it was "
                "the table, state the degrees through which it turned."
            ),
        )


def angles_in_words(recorded: Recorded, turns: Iterable[int]) -> list[str]:
    """How far each of some turns goes, of the planned angle."""
    return [
        _(
            "{name} ({far}° of {planned}°)",
            name=recorded.name[i],
            far=fixed(float(np.degrees(recorded.moved[i])), 2),
            planned=fixed(float(np.degrees(recorded.angle[i])), 0),
        )
        for i in turns
    ]
