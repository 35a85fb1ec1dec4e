"""A bias that jumps within a rest."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inertial.sensors import CHANNELS
from inertial.signal.detector import Description, Detector, Event, Log, Piece, read_in
from inertial.signal.static_tilt import Jump, Resting, jumps
from inertial.signal.steps import Step
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant

MAX_RETURN_SHARE = 0.25  # of a jump: largest remainder where the bias has returned
MAX_RETURN_SIGMA = 4.0  # sigmas of the sum of the two sizes, within which it has returned as well
MIN_UPRIGHT_SHARE = 0.7  # share of the vertical from which an axis counts as upright


@dataclass(frozen=True)
class Jumped:
    """What the description of a jump needs.

    jump: as seen; back: it goes back; early, late: s by which the place may be earlier or later;
    share: of the rest, with the new bias; upright: share of the vertical in its axis, with sign;
    noise: of a reading; gravity: m/s².
    """

    jump: Jump
    back: bool
    early: float
    late: float
    share: float
    upright: float
    noise: float
    gravity: float


class BiasJump(Detector):
    """A channel that reads more, or less, from one record on, while the IMU rests.

    Means of 0.2 s to 10 s on both sides of every record are compared by the scatter that such
    differences have in this rest, so excess noise and an oscillation cost sensitivity but raise
    nothing; what drift, a random walk or settling explain as well is none. A jump of one channel
    that the other sensor shows as a turn of the case is a motion of the table.

    Cause: a loose contact, a jump of temperature or supply, or the sensor itself. The mean of the
    rest is wrong, hence bias and scale factor of the axis.
    """

    name = "bias_jump"
    source = "design study, 0: a jump at any time must be sought at every time"
    severity = 2
    alike = "event"

    def detect(self, piece: Piece, log: Log) -> Iterator[Event]:
        resting, every = jumps(piece, log)
        own = [jump for jump in every if not jump.moved]
        for i in range(len(CHANNELS)):
            yield from _events(piece, log, resting, [jump for jump in own if jump.channel == i])

    def describe(self, event: Event, name: str) -> Description:
        jumped: Jumped = event.facts
        i = event.channel
        assert i is not None  # it is one channel that jumps
        (scale, unit), axis = read_in(i), CHANNELS[i][-1]
        sensor = "accelerometer" if i < 3 else "gyro"
        back = _(" and back at {to_s} s", to_s=fixed(event.to_s, 2)) if jumped.back else ""
        place = f"{fixed(event.from_s, 2)} s"
        if jumped.early + jumped.late > 0:
            place += _(
                " (95 %: {early} s earlier to {late} s later)",
                early=fixed(jumped.early, 2),
                late=fixed(jumped.late, 2),
            )
        sentence = _(
            "{name}: the {axis} {sensor} jumps by {size} {unit} (sigma {sigma}) at "
            "{place}{back}; {significant} times the noise of a reading.",
            name=name,
            axis=axis,
            sensor=sensor,
            size=_signed(scale * event.size),
            unit=unit,
            sigma=significant(scale * jumped.jump.step.sigma, 2),
            place=place,
            back=back,
            significant=significant(abs(event.size) / jumped.noise, 2),
        )
        if i >= 3 and not jumped.jump.agreement.conclusive:
            upright = abs(jumped.upright) > MIN_UPRIGHT_SHARE
            sentence += _(
                " A slow turn about {axis} cannot be distinguished from it.",
                axis=_("the vertical") if upright else axis,
            )
        return Description(
            sentence,
            _consequence(event, i),
            _(
                "The rest is used as it is. Record it again; see whether contact, supply or "
                "temperature changed then."
            ),
        )


def _consequence(event: Event, channel: int) -> str:
    """By how much the mean of the rest is off, and what rests on it."""
    jumped: Jumped = event.facts
    (scale, unit), axis = read_in(channel), CHANNELS[channel][-1]
    off = event.size * jumped.share
    text = _(
        "The mean of this rest is off by {off} {unit} (the jump, over {share:.0%} of it)",
        off=_signed(scale * off),
        unit=unit,
        share=jumped.share,
    )
    if channel >= 3:
        return text + _(", and with it the bias of the {axis} gyro as this rest has it.", axis=axis)
    if abs(jumped.upright) > MIN_UPRIGHT_SHARE:
        ppm = off * np.sign(jumped.upright) / (2 * jumped.gravity) * 1e6
        return text + _(
            ". In a pair of {axis} up and {axis} down that is {signed} {unit} of bias and "
            "{ppm} ppm of scale factor.",
            axis=axis,
            signed=_signed(off / 2),
            unit=unit,
            ppm=_signed(ppm),
        )
    return text + _(
        ", and with it bias and cross-axis terms of the {axis} accelerometer as this "
        "rest has them.",
        axis=axis,
    )


def _events(piece: Piece, log: Log, resting: Resting, own: list[Jump]) -> Iterator[Event]:
    """The jumps of one channel; one that returns is joined with the one before it."""
    waiting = list(own)
    while waiting:
        jump = waiting.pop(0)
        back = bool(waiting) and _goes_back(jump.step, waiting[0].step)
        end = waiting[0].step.place if waiting else len(piece)
        if back:
            waiting.pop(0)
        i, step = jump.channel, jump.step
        seconds = piece.time[[step.earliest, step.place, step.latest]]
        yield piece.event(
            step.place,
            end,
            step.size,
            channel=i,
            p_value=step.p_value,
            facts=Jumped(
                jump,
                back,
                float(seconds[1] - seconds[0]),
                float(seconds[2] - seconds[1]),
                (end - step.place) / len(piece),
                float(resting.up[i % 3]) if resting.recorded("accel") else 0.0,
                float(resting.noise[i]),
                log.given.gravity,
            ),
        )


def _goes_back(step: Step, other: Step) -> bool:
    left = abs(step.size + other.size)
    unsure = MAX_RETURN_SIGMA * float(np.hypot(step.sigma, other.sigma))
    return step.size * other.size < 0 and left < max(MAX_RETURN_SHARE * abs(step.size), unsure)


def _signed(value: float) -> str:
    text = significant(value, 3)
    return text if value < 0 else f"+{text}"
