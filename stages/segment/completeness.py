"""What was recorded of each manoeuvre but the turns, compared with its plan; ways between them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from inertial.arrays import Array, Booleans
from inertial.campaign.records import Manoeuvre, Performed
from inertial.signal.axis_permutations import AS_NAMED
from inertial.signal.detector import channel_name
from inertial.signal.rests_and_motions import BinStretch
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY
from stages.segment.located import Located
from stages.segment.recording_explanations import ExplainedRecording
from stages.segment.windows import Binned

MIN_PEAK_FORCE = 0.1 * STANDARD_GRAVITY  # m/s², of a peak between two positions beyond both
MIN_SENSE_RATE = np.radians(1.0)  # rad/s, of a turn about an axis between two manoeuvres


def not_found(m: Manoeuvre) -> Performed:
    """A manoeuvre of which the log has nothing."""
    what = _("no rest in the planned direction") if m.do == "rest" else _("no turn about its axis")
    sentence = _(
        "{name} is not in {log}: {what} was found where the plan has it.",
        name=m.name,
        log=m.log,
        what=what,
    )
    return Performed(m.name, sentence, found=False, complete=False)


def left_out(
    explained: ExplainedRecording, plan: Sequence[Manoeuvre]
) -> Iterator[tuple[str, Performed]]:
    """Manoeuvres that are found otherwise than planned, so that only the laboratory can decide.

    They bear another's name, or stand in its place, or their log alone has axes that are taken
    for others.
    """
    why: dict[str, str] = {}
    for exchanged in explained.exchanged:
        names, half = exchanged.names, len(exchanged.names) // 2
        what = _("its log holds") if len(exchanged.logs) == 2 else _("in its place stands")
        for name, other in zip(names, names[half:] + names[:half], strict=True):
            why[name] = _("{name} is left out: {what} {other}.", name=name, what=what, other=other)
    for m in plan:
        if m.log in explained.misread:
            why[m.name] = _(
                "{name} is left out: in {log} axes are exchanged or reversed.",
                name=m.name,
                log=m.log,
            )
    for name, sentence in why.items():
        yield name, Performed(name, sentence, found=False, complete=False)


def positions(m: Manoeuvre, number: int) -> Performed:
    """A search for positions, and how many it found."""
    sentence = _(
        "{number} rests of at least {seconds:g} s were found; their attitudes are unknown.",
        number=number,
        seconds=m.seconds,
    )
    return Performed(m.name, sentence, found=number > 0, complete=number > 0)


def rest(binned: Binned, m: Manoeuvre, stretch: BinStretch) -> Performed:
    """A rest and its duration."""
    seconds = binned.duration(stretch.first, stretch.after)
    if not np.isfinite(binned.first_s[stretch.first]):
        records = int(binned.edges[stretch.after] - binned.edges[stretch.first])
        return Performed(m.name, _("{records} records at rest, without time.", records=records))
    of = _(" of the {seconds:g} s planned", seconds=m.seconds) if m.seconds else ""
    return Performed(
        m.name, _("{seconds:.2f} s at rest{of}.", seconds=seconds, of=of), seconds=seconds
    )


def with_clipped(done: Performed, clipped: Mapping[str, Booleans]) -> Performed:
    """The same, with the channels that are cut off in it, by phase, (6,); "" is that of motion."""
    sentence = done.sentence
    for phase, channels in clipped.items():
        names = ", ".join(channel_name(int(i)) for i in np.flatnonzero(channels))
        sentence += (
            _(
                " Not used in {phase}, for readings touch the end of the range: {names}.",
                phase=phase,
                names=names,
            )
            if phase not in ("", "rest")
            else _(" Not used, for readings touch the end of the range: {names}.", names=names)
        )
    return replace(done, sentence=sentence)


def with_ways(
    performed: dict[str, Performed], located: Located, level: Array
) -> Iterator[Performed]:
    """The manoeuvres with what sensors remember of the way to them, as read; `level`: see `turn`.

    That is the peak of the force along each axis, and the sense of the last rate about it. The
    table may turn an axis over between two positions, which the plan does not tell.
    """
    binned, since = located.binned, 0
    found = ((place, name) for name, place in located.matched.items() if place is not None)
    for place, name in sorted(found):
        done, before = performed[name], located.stretches[since:place]
        if located.axes.accel == AS_NAMED:
            first, after = located.stretches[since].first, located.stretches[place].first
            way = binned.forces[max(first - 1, 0) : after + 1]
            x, y, z = (_peak(axis) for axis in way.T)
            done = replace(done, peak_x=x, peak_y=y, peak_z=z)
        if located.axes.gyro == AS_NAMED:
            moves = [binned.rates[s.first : s.after] for s in before if s.moves]
            rates = np.concatenate([np.empty((0, 3)), *moves]) - level
            x, y, z = (_sense(axis) for axis in rates.T)
            done = replace(done, sense_x=x, sense_y=y, sense_z=z)
        yield done
        since = place + 1


def _peak(force: Array) -> float | None:
    """The last extreme that is clearly beyond both ends; None where there is none."""
    force = force[np.isfinite(force)]
    if len(force) < 3:
        return None
    low, high = sorted(force[[0, -1]])
    found = [int(np.argmax(force))] if force.max() > high + MIN_PEAK_FORCE else []
    found += [int(np.argmin(force))] if force.min() < low - MIN_PEAK_FORCE else []
    return float(force[max(found)]) if found else None


def _sense(rate: Array) -> float | None:
    """The sign of the last rate that is a turn, ±1; None where there is none."""
    turns = rate[np.abs(rate) > MIN_SENSE_RATE]
    return float(np.sign(turns[-1])) if len(turns) else None
