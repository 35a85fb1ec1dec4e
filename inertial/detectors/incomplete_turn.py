"""A turn of which a part is missing."""

from collections.abc import Iterator

import numpy as np

from inertial.signal.detector import Description
from inertial.signal.plan_detector import Deviation, PlanDetector, Recorded
from inertial.signal.scale_factor import MAX_RATIO_SPREAD, common_turn_ratio, turn_ratios
from inertial.text.messages import _
from inertial.text.numbers import fixed, whole


class IncompleteTurn(PlanDetector):
    """A turn that was not recorded from rest to rest, or not to the planned angle.

    What a gap or masked records lack of it is told with these: they are the cause.
    """

    name = "incomplete_turn"
    cause = _("the log begins or ends while the table turns, or it turned by another angle")
    source = "S0, figure 5-9: 11.98 s are missing of a turn, so 240° of 360° are recorded"
    costs = _("its angle, and with it a scale factor, if the planned or a rounded one is taken")
    unit = "°"
    sensor = "gyro"

    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
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
    if rounded and abs(read / rounded - 1) < 0.5:
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
