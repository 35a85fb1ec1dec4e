"""Logs whose sensors have other axes than those of the rest of the campaign."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from inertial.signal.axis_permutations import PERMUTATIONS, read_as_other_axes
from stages.segment.located import AS_PLANNED, Axes, locate
from stages.segment.rest_readings import forces_at_rest
from stages.segment.suppositions import Case

MIN_GAIN = 2  # observations more that agree with the plan, in place of as many that do not
MIN_GAIN_OF_BOTH = 3  # the same, for both sensors of one log: it may have had another attitude


def misread_logs(case: Case) -> Iterator[tuple[str, Axes]]:
    """Logs with other axes than the rest of the campaign."""
    of_window = [window.log for window in case.windows]
    if len(set(of_window)) < 2:
        return
    taken = {log for exchanged in case.exchanged for log in exchanged.logs}
    for log in dict.fromkeys(of_window[k] for k in case.lacking if of_window[k] not in taken):
        axes = _axes_of(case, [k for k, own in enumerate(of_window) if own == log])
        if axes is not None:
            yield log, axes


def _axes_of(case: Case, own: list[int]) -> Axes | None:
    """The axes by which all of a log agrees with the plan, if the data decide for them."""
    now, said = np.sum([case.located[k].agreeing for k in own], axis=0)
    for sensors in (("accel",), ("gyro",), ("accel", "gyro")):
        for permutation in PERMUTATIONS:
            axes = replace(case.everywhere, **dict.fromkeys(sensors, permutation))
            located = [locate(case.windows[k], axes, case.plans[k]) for k in own]
            right, all_of_it = np.sum([each.agreeing for each in located], axis=0)
            if right < all_of_it or right <= now:
                continue
            if right - now >= (MIN_GAIN if len(sensors) == 1 else MIN_GAIN_OF_BOTH):
                return axes
            if len(sensors) == 1 and _confirmed_by_other_sensor(case, axes, int(said)):
                return axes
            break  # if the simplest is not significant, the others are not
    return _axes_by_force(case, own, int(now), int(said))


def _confirmed_by_other_sensor(case: Case, axes: Axes, said: int) -> bool:
    """Whether the other sensor confirms that the IMU moved as planned, and only axes differ.

    A turn against the plan may be just that; so one turn cannot show the sign of a gyro alone.
    """
    if said < 2:
        return False
    return axes.gyro == case.everywhere.gyro or not axes.gyro.in_place


def _axes_by_force(case: Case, own: list[int], now: int, said: int) -> Axes | None:
    """The axes of the accelerometers in a log with one rest, from the readings of the others.

    Gravity along another axis may be an IMU in another attitude. But every accelerometer
    has a bias and a scale factor of its own, by which the other rests identify it.
    """
    if (now, said) != (0, 1) or case.everywhere != AS_PLANNED:
        return None
    (k,) = own
    rests = [place for place, what in enumerate(case.located[k].observed) if not what.moves]
    m = case.located[k].plan[0]
    if m.do != "rest" or m.up is None or not rests:
        return None
    longest = max(rests, key=lambda place: case.located[k].observed[place].seconds)
    force = case.located[k].observed[longest].force
    others = [pair for other in case.located for pair in forces_at_rest(other)]
    if not others or not np.isfinite(force).all():
        return None
    forces, ups = (np.array(column) for column in zip(*others, strict=True))
    permutation = read_as_other_axes(force, m.up, forces, ups)
    return None if permutation is None else replace(case.everywhere, accel=permutation)
