"""Turns that are not as planned: a part is missing, the other way, faster or slower."""

from collections.abc import Iterator

import numpy as np

from inertial.arrays import Booleans
from inertial.detectors.stamps_misstated import TIME_UNITS
from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded, Rescaled, Reversed
from inertial.signal.scale_factor import MAX_RATIO_SPREAD, common_turn_ratio, turn_ratios
from inertial.text.messages import _
from inertial.text.numbers import counted, fixed, significant, whole

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
    as_recorded = bool(recorded.restated)  # rates in place of the plan's: by the gyros themselves
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
            "at another rate, or the table is that much {slower}.",
            ppm=significant(1e6 * abs(ratio - 1), 3),
            slower=_("slower") if ratio > 1 else _("faster"),
            sigma=significant(1e6 * rate_sigma),
        ),
        _(
            "If it is the samples, the scale factors of all gyros are off by {ppm} ppm; if it is "
            "the table, they stand, for they are by the angle.",
            ppm=significant(1e6 * (ratio - 1), 3),
        ),
        _(
            "Nothing is changed. Time some thousand samples by another clock and state {state}; or "
            "state rate_sigma_ppm of the table as large as its speed is uncertain.",
            state=state,
        ),
    )


MIN_SHORT_TURNS = 2  # of one alone the table may have stopped elsewhere: the model has it
ASSUMED_RATE_SIGMA = 1e-3  # of a table, relative, where none is stated
NORMAL_MEDIAN = 1.4826  # sigma of a normal distribution over its median absolute deviation


def short_turns(recorded: Recorded) -> Booleans:
    """Which whole turns have too small an angle for their rate, by that of most others, (m,)."""
    rate, angle = turn_ratios(recorded)
    known = np.isfinite(rate) & np.isfinite(angle) & recorded.complete & (rate > 0)
    short = np.zeros(len(known), bool)
    if not known.any() or recorded.restated:
        return short
    longer = angle[known] / rate[known]
    lacking = 1 - longer / np.median(longer)
    of_table = np.nan_to_num(recorded.rate_sigma, nan=ASSUMED_RATE_SIGMA)
    scatter = np.hypot(of_table, NORMAL_MEDIAN * np.median(np.abs(lacking)))
    short[known] = lacking > MIN_RATE_SIGMAS * np.hypot(scatter, recorded.unsteady[known])
    few = MIN_SHORT_TURNS <= np.count_nonzero(short) < np.count_nonzero(known) / 2
    return short if few else np.zeros(len(known), bool)


class LostSamplesOfTurns(PlanDetector):
    """Turns whose angle is short though their rate is not, as none of most others is.

    Cause: samples are lost, and the stamps are counted as if none were. An asymmetry of the gyros
    changes the rate they read as well; a table that stops before does not.
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
        listed = [
            _(
                "{name} ({far}° of {planned}°)",
                name=recorded.name[i],
                far=fixed(float(np.degrees(recorded.moved[i])), 2),
                planned=fixed(float(np.degrees(recorded.angle[i])), 0),
            )
            for i in short[:MAX_LISTED]
        ]
        return Description(
            _(
                "{turns} have too small an angle for their rate, which is as in the others: "
                "{listed}. Samples are lost there that the stamps do not show, or the table "
                "stopped before.",
                turns=counted(len(short), "turn"),
                listed=", ".join(listed),
            ),
            _("Taken as planned, they make an asymmetry of the gyros, or wrong scale factors."),
            _(
                "Record them again with a counter or a clock in which lost samples show; if it was "
                "the table, state the degrees through which it turned."
            ),
        )


class IncompleteTurn(PlanDetector):
    """A turn that was not recorded from rest to rest, or not to the planned angle.

    What a gap or masked records lack of it is told with these: they are the cause.

    Cause: the log begins or ends while the table turns, or it turned by another angle. If the
    planned angle or a rounded one is taken, a scale factor is wrong.
    """

    name = "incomplete_turn"
    source = "S0, figure 5-9: 11.98 s are missing of a turn, so 240° of 360° are recorded"
    unit = "°"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        if thousands_longer(recorded) or time_ratio(recorded) is not None:
            return
        common = common_turn_ratio(recorded)
        _, angle = turn_ratios(recorded)
        # By other axes no turn is used, though it may be whole.
        misread = any(
            each.sensor == "gyro" and not each.log and not each.undone for each in recorded.misread
        )
        for i, name in enumerate(recorded.name):
            whole_planned = recorded.do[i] == "turn" and not recorded.steady[i]
            if not whole_planned or not recorded.found[i]:
                continue
            if recorded.complete[i] or recorded.lost[i]:
                continue
            # Where all turns have another angle, that of one with a gap is not known at all.
            scaled = common is not None and (
                abs(angle[i] / common[0] - 1) <= MAX_RATIO_SPREAD or recorded.lacking_s[i] > 0
            )
            reversed_ = angle[i] < 0
            refused = misread and recorded.lacking_s[i] == 0
            if scaled or reversed_ or refused or name in recorded.explained:
                continue
            missing = float(np.degrees(recorded.lacking[i]))
            yield self.of(recorded, i, missing if np.isfinite(missing) else None)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        assert i is not None  # it is a turn that is not complete
        return Description(
            f"{recorded.name[i]}: {recorded.said[i]}",
            _if_taken(recorded, i),
            _("It is left out of the joint estimate and of the angle method. Record it again."),
        )


def _if_taken(recorded: Recorded, i: int) -> str:
    """What the scale factor would be wrong by if one took another angle than the recorded one."""
    common = common_turn_ratio(recorded)
    scale = common[0] if common else 1.0
    planned, read = np.degrees([recorded.angle[i], recorded.moved[i] / scale]).tolist()
    if not np.isfinite(planned * read) or not planned * read:
        return _("Its angle is not known, so it gives no scale factor.")
    said = [
        _(
            "Taken for {planned}°, {wrong_by}",
            planned=fixed(planned, 0),
            wrong_by=_wrong_by(read / planned - 1),
        )
    ]
    if common:
        said[0] = _(
            "Without the common ratio it is {read}°. {said}", read=fixed(read, 2), said=said[0]
        )
    # The formula of two turns takes the time of a whole one, whatever the log holds of it.
    whole_turn = abs(recorded.angle[i] / recorded.rate[i]) if recorded.rate[i] else 0.0
    seconds = float(np.fmax(recorded.duration[i], whole_turn))
    if seconds > 0 and abs(planned - read) > 0:
        said[0] += _(", bias by {fixed} °/s", fixed=fixed(abs(planned - read) / (2 * seconds), 4))
    rounded = round(read)
    too_far = abs(read) > abs(planned)  # no part of the planned angle, which one might round
    if rounded and abs(read / rounded - 1) < 0.5 and not too_far:
        said.append(
            _(
                "rounded to {rounded}°, {wrong_by}",
                rounded=fixed(rounded, 0),
                wrong_by=_wrong_by(read / rounded - 1),
            )
        )
    return "; ".join(said) + "."


def _wrong_by(error: float) -> str:
    """A scale error of one turn, and of a pair with one that is right the other way."""
    return _(
        "its scale error is wrong by {whole} ppm ({whole_2} ppm in a pair with a turn "
        "that is right)",
        whole=whole(error * 1000000.0),
        whole_2=whole(error / 2 * 1000000.0),
    )


class WrongDirection(PlanDetector):
    """A turn that is opposite to the planned direction by its gyro.

    Cause: the sign of the planned angle, or the table turned the other way. A scale factor would
    have the wrong sign.
    """

    name = "wrong_direction"
    source = "S0: shun and ni; judge a turn by the sign on the gyro, not by the word"
    severity = 3
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.reversed:
            axis = each.about if len(each.about) == 1 else None
            yield Deviation(
                None,
                "",
                -1.0,
                self.sensor,
                axis,
                count=len(each.names),
                facts=each,
                repair=each.repair,
            )
        for i, name in enumerate(recorded.name):
            ratio = ratio_of(recorded, i)
            if recorded.found[i] and ratio < 0 and name not in recorded.explained:
                yield self.of(recorded, i, ratio)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        i = deviation.at
        if i is None:
            return _the_other_way(deviation.facts, recorded)
        assert deviation.size is not None
        name, turned, planned = recorded.name[i], recorded.moved[i], recorded.angle[i]
        unit = "°"
        if not np.isfinite(turned * planned):
            turned, planned, unit = recorded.speed[i], recorded.rate[i], " °/s"
        far = [fixed(float(np.degrees(turned)), 2), fixed(float(np.degrees(planned)), 0)]
        return Description(
            _(
                "{name} turns against the planned direction: by {far}{unit} in place of "
                "{far_2}{unit}.",
                name=name,
                far=far[0],
                unit=unit,
                far_2=far[1],
            ),
            _(
                "Taken as planned, its scale error would be {fixed} %; it is left out of all "
                "methods.",
                fixed=fixed((deviation.size - 1) * 100, 0),
            ),
            _what_to_state(deviation.size, recorded, i),
        )


def _what_to_state(ratio: float, recorded: Recorded, i: int) -> str:
    """What the plan should have of a turn against it; `ratio`: recorded over planned."""
    if abs(ratio + 1) > recorded.tolerance or not np.isfinite(recorded.angle[i]):
        return _("Correct the sign of degrees or rate, or the axes of the gyros.")
    return _(
        "If the table was turned so, state degrees: {degrees} for {name}; otherwise correct the "
        "axes of the gyros.",
        degrees=f"{-float(np.degrees(recorded.angle[i])):.10g}",
        name=recorded.name[i],
    )


def ratio_of(recorded: Recorded, i: int) -> float:
    """Recorded over planned, of the rate or else of the angle; NaN where either is not known."""
    by_rate = float(recorded.speed[i] / recorded.rate[i]) if recorded.rate[i] else np.nan
    if np.isfinite(by_rate) or not recorded.angle[i]:
        return by_rate
    return float(recorded.moved[i] / recorded.angle[i])


def _the_other_way(turns: Reversed, recorded: Recorded) -> Description:
    """Turns against the plan, while earth and gravity show that the gyros' signs are right."""
    seen = ""
    if turns.by_gravity:
        seen = _(", while the gyros turn gravity as the accelerometers see it turn")
    elif any(sign > 0 for sign in recorded.gyro_signs):
        seen = _(", while the gyros see the earth turn as it does")
    sentence = (
        _(
            "{turns} of {count} are against the planned direction{seen}: {why}.",
            turns=counted(len(turns.names), "turn"),
            count=sum(do == "turn" for do in recorded.do),
            seen=seen,
            why=turns.why,
        )
        if turns.about
        else _(
            "All {count} turns are against the planned direction{seen}: the table counts its angle "
            "the other way.",
            count=len(turns.names),
            seen=seen,
        )
    )
    return Description(
        sentence,
        _("Taken as planned, the scale errors of their gyros would be −200 %."),
        _(
            "They are taken the other way, on this condition. Correct the signs of degrees or rate "
            "in the plan; or confirm it by accept: [{repair}].",
            repair=turns.repair,
        ),
    )


class WrongRate(PlanDetector):
    """A turn whose rate is not the planned one, where no ratio explains all of them.

    Cause: the rate of the plan, or of the table. Where the rate is the reference, a scale factor is
    wrong.
    """

    name = "wrong_rate"
    source = "S0, table 5-6: the rate in the steady part"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        for each in recorded.restated:
            yield Deviation(
                None,
                "",
                each.ratio,
                self.sensor,
                count=len(each.names),
                facts=each,
                severity=1,
                repair=each.repair,
            )
        if common_turn_ratio(recorded) is not None:
            return
        rate, angle = turn_ratios(recorded)
        for i, ratio in enumerate(rate):
            if ratio > 0 and abs(ratio - 1) > recorded.tolerance:
                as_planned = abs(angle[i] - 1) <= recorded.tolerance
                yield self.of(recorded, i, float(ratio), severity=1 if as_planned else 3)

    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        if isinstance(deviation.facts, Rescaled):
            return _restated(deviation.facts)
        i, ratio = deviation.at, deviation.size
        assert i is not None and ratio is not None
        read, planned = np.degrees([recorded.speed[i], recorded.rate[i]]).tolist()
        _unused, angle = turn_ratios(recorded)
        if deviation.severity == 1:
            consequence = _(
                "Its angle is as planned ({fixed}°), so its scale factor holds; the rate is not "
                "used.",
                fixed=fixed(float(np.degrees(recorded.moved[i])), 2),
            )
        elif np.isfinite(angle[i]):
            consequence = _(
                "Its angle is {significant} times the planned one, so it is left out.",
                significant=significant(float(angle[i]), 4),
            )
        else:
            consequence = _(
                "Taken as planned, its scale error would be {fixed} %.",
                fixed=fixed((ratio - 1) * 100, 1),
            )
        return Description(
            _(
                "{name} turns at {read} °/s, {ratio} times the planned {planned} °/s; the other "
                "turns are not off by this ratio.",
                name=recorded.name[i],
                read=significant(read),
                ratio=significant(ratio, 5),
                planned=significant(planned),
            ),
            consequence,
            _("Correct the rate of the plan, or see what the table did."),
        )


def _restated(restated: Rescaled) -> Description:
    """Turns through their planned angles, all at one multiple of the planned rate."""
    return Description(
        _(
            "{turns} go through the planned angles at {ratio} times the planned rate: {why}.",
            turns=counted(len(restated.names), "turn"),
            ratio=significant(restated.ratio, 5),
            why=restated.why,
        ),
        _("The angles are as planned, so the scale factors hold."),
        _("The rates are taken as recorded. Correct the rate of the plan."),
    )
