"""What was recorded of each manoeuvre, compared with its plan: rests, turns, ways between them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import degrees

import numpy as np
import pandas as pd

from inertial.arrays import Array, Booleans, Integers
from inertial.campaign.records import Manoeuvre, Performed
from inertial.signal.axis_permutations import AS_NAMED
from inertial.signal.detector import channel_name
from inertial.signal.rests_and_motions import BinStretch
from inertial.tables import CHANNELS
from inertial.text.messages import _
from inertial.text.numbers import fixed
from inertial.text.units import STANDARD_GRAVITY
from stages.segment.located import Located
from stages.segment.matching import motion
from stages.segment.recording_explanations import ExplainedRecording
from stages.segment.windows import Binned, rate_about

# ---- What was recorded of each manoeuvre but the turns, compared with its plan; ways between them.

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
        what = _("its log holds") if len(exchanged.logs) > 1 else _("in its place stands")
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
                " Not used in {phase}, for readings are cut off at the end of the range or below a "
                "threshold: {names}.",
                phase=phase,
                names=names,
            )
            if phase not in ("", "rest")
            else _(
                " Not used, for readings are cut off at the end of the range or below a threshold: "
                "{names}.",
                names=names,
            )
        )
    return replace(done, sentence=sentence)


def with_ways(
    performed: dict[str, Performed], located: Located, level: Array
) -> Iterator[Performed]:
    """The manoeuvres with what sensors remember of the way to them, as read; `level`: see `turn`.

    That is the peak of the force along each axis, the sense of the last rate about it, and when the
    last turn ended. The table may turn an axis over between two positions, which the plan does not
    tell.
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
            moves = [np.arange(s.first, s.after) for s in before if s.moves]
            bins = np.concatenate([np.empty(0, np.int64), *moves])
            rates = binned.rates[bins] - level
            x, y, z = (_sense(axis) for axis in rates.T)
            turns = bins[(np.abs(rates) > MIN_SENSE_RATE).any(axis=1)]
            ends = binned.last_s[turns[np.isfinite(binned.last_s[turns])]]
            stopped = float(ends[-1]) if len(ends) else None
            done = replace(done, sense_x=x, sense_y=y, sense_z=z, stopped=stopped)
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


# ---- What was recorded of a turn: its angle and rate, whether all of it is there, what is missing.

MAX_MISSING_RUN = 3  # samples in a row that may be interpolated where the rate changes
MAX_MISSING_SHARE = 0.1  # of the time of the ramps, or of a turn: what may be interpolated in all
# s of steady rate that must be recorded on either side of what is missing, or as much as is
# missing where that is less: ten of the bins in which the end of a ramp is sought, so that no
# part of a ramp hides in the gap; on S0's turn the rate before and the rate after are then known
# to 20 ppm each, better than the table keeps it.
MIN_STEADY_S = 1.0


@dataclass(frozen=True)
class Missing:
    """What is missing of a turn: time, s, and its angle by the rate before and after, rad.

    `hindrance`: why it cannot be bridged, in words; empty where it can, or nothing is missing.
    """

    seconds: float
    angle: float
    hindrance: str


def missing_of(moving: pd.DataFrame, about: Array) -> Missing:
    """What is missing of a turn.

    A stretch of steady rate can be bridged. Where the rate changes, or a hand turns, only a few
    samples between good ones can: lost records of a link, or masked ones.

    Parameters
    ----------
    moving : its k blocks in motion
    about : (k,), rad/s, their rates about its axis
    """
    seconds = moving["seconds"].to_numpy(np.float64)
    missing = moving["missing_s"].to_numpy(np.float64)
    holes = np.flatnonzero(missing)
    steady = (moving["phase"] == "steady").to_numpy(bool)
    inside = np.zeros(len(moving), bool)
    inside[1:] = steady[1:] & steady[:-1]
    beside = np.append(0.0, (about[1:] + about[:-1]) / 2)
    if steady.any():
        beside[inside] = np.average(about[steady], weights=seconds[steady])
    angle = float(beside[holes] @ missing[holes])
    hindrance = _hindrance(moving, holes, inside) if len(holes) else ""
    return Missing(float(np.maximum(missing, 0.0).sum()), angle, hindrance)


def _hindrance(moving: pd.DataFrame, holes: Integers, inside: Booleans) -> str:
    """Why what is missing before the blocks `holes` cannot be bridged; empty where it can."""
    missing = moving["missing_s"].to_numpy(np.float64)
    seconds = moving["seconds"].to_numpy(np.float64)
    step = float(seconds.sum() / moving["count"].sum())
    steady = (moving["phase"] == "steady").to_numpy(bool)
    by_hand = bool((moving["phase"] == "turning").any())
    where = _("a turn by hand has no steady rate") if by_hand else _("the rate is not steady there")
    if (missing < -step / 2).any():
        return _("the time goes back while it turns")
    for hole in holes[inside[holes]]:
        enough = min(MIN_STEADY_S, missing[hole])
        before = float(seconds[:hole][steady[:hole]].sum())
        after = float(seconds[hole:][steady[hole:]].sum())
        if min(before, after) < enough - step / 2:
            side = _("before") if before < after else _("after")
            return _(
                "only {before:.2f} s of steady rate are recorded {side} them, of {enough:.2f} s "
                "that are needed",
                before=min(before, after),
                side=side,
                enough=enough,
            )
    ramps = holes[~inside[holes]]
    if not len(ramps):
        return ""
    if missing[ramps].max() > (MAX_MISSING_RUN + 0.5) * step:
        return _(
            "{where}, and more than {number} samples in a row are missing",
            where=where,
            number=MAX_MISSING_RUN,
        )
    if missing[ramps].sum() > MAX_MISSING_SHARE * seconds[~steady].sum():
        return _(
            "{where}, and more than {share:.0%} of its samples are missing",
            where=where,
            share=MAX_MISSING_SHARE,
        )
    return ""


@dataclass(frozen=True)
class _Turned:
    """A turn as it is in its log.

    `angle`: rad, without what is missing; None without time; `rate`: of its steady part, rad/s;
    `seconds`: from rest to rest; `reasons` against it, for the log begins or ends while it turns;
    `remark`: what its sigma covers, or what is interpolated.
    """

    m: Manoeuvre
    angle: float | None
    rate: float | None
    seconds: float
    missing: Missing
    reasons: tuple[str, ...]
    remark: str


def turn(
    located: Located,
    place: int,
    m: Manoeuvre,
    moving: pd.DataFrame,
    gaps: pd.DataFrame,
    level: Array,
    tolerance: float,
    clipped: Booleans,
) -> Performed:
    """A turn: its angle, its rate, whether all of it was recorded, or what is missing is known.

    `moving`: its blocks in motion; `gaps`: of all logs; `level`: (3,), rad/s, the gyros at rest;
    `clipped`: (3,), the gyros that are cut off at the end of their range in it.
    """
    if moving.empty:
        return Performed(m.name, _("it turns, but its gyros are masked."), True, False)
    binned = located.binned
    first, after = motion(binned, located.stretches, place)
    about = rate_about(m.axis, moving[list(CHANNELS[3:])].to_numpy(np.float64) - level)
    length = moving["seconds"].to_numpy(np.float64)
    timed = bool(np.isfinite(length).all())
    of_log = gaps[gaps["log"] == binned.window.log]
    reasons, remark = _cut_off(binned, first, after, binned.about(m.axis, level), m)
    turned = _Turned(
        m,
        float(np.nansum(about * length)) if timed else None,
        _steady_rate(moving, about),
        binned.duration(first, after),
        missing_of(moving, np.nan_to_num(about)),
        tuple(reasons),
        remark,
    )
    if (clipped & (m.axis != 0)).any():
        return _clipped(turned)
    if _few_are_masked(moving, turned.missing, of_log):
        turned = _interpolated(turned)
    if m.recorded == "steady":
        return _at_steady_rate(turned)
    return _from_rest_to_rest(turned, tolerance)


def _steady_rate(moving: pd.DataFrame, about: Array) -> float | None:
    """The mean rate of the steady part, rad/s; none where there is no such part."""
    steady = (moving["phase"] == "steady").to_numpy(bool) & np.isfinite(about)
    if not steady.any():
        return None
    return float(np.average(about[steady], weights=moving["count"].to_numpy(np.float64)[steady]))


def _cut_off(
    binned: Binned, first: int, after: int, about: Array, m: Manoeuvre
) -> tuple[list[str], str]:
    """Where the log begins or ends while it turns: as reasons against it, and as a remark.

    A hand stops within a bin: what is cut off then is less than the sigma of the angle.
    """
    reasons: list[str] = []
    remark = ""
    edges = [(_("begins"), about[0])] if first == 0 else []
    edges += [(_("ends"), about[-1])] if after == binned.bins else []
    for what, edge in edges:
        if abs(edge) * binned.bin_seconds / 2 < (m.angle_sigma or 0.0):
            remark += _(
                "; the log {what} at {degrees:.0f} °/s, which its sigma covers",
                what=what,
                degrees=degrees(abs(edge)),
            )
        else:
            reasons.append(_("the log {what} while it turns", what=what))
    return reasons, remark


def _clipped(turned: _Turned) -> Performed:
    """A turn whose gyro is cut off: its angle is not measured."""
    missing, reasons = turned.missing, list(turned.reasons)
    reasons += [missing.hindrance] if missing.hindrance else []
    whole = missing.seconds == 0 and not (reasons and turned.m.recorded == "whole")
    sentence = _("turned, by an angle that is not measured")
    sentence += f"{turned.remark}: {_(', and ').join(reasons)}." if reasons else "."
    return Performed(
        turned.m.name,
        sentence,
        True,
        whole,
        seconds=turned.seconds,
        missing_s=missing.seconds,
        bridged=not whole and not reasons,
        lost=not whole,
    )


def _few_are_masked(moving: pd.DataFrame, missing: Missing, gaps: pd.DataFrame) -> bool:
    """Whether all that is missing are a few masked samples here and there: the turn is whole."""
    holes = moving["missing_s"].to_numpy(np.float64)
    step = float(moving["seconds"].sum() / moving["count"].sum())
    first, last = moving["from_record"].min(), moving["to_record"].max()
    return bool(
        missing.seconds > 0
        and not missing.hindrance
        and not gaps["record"].between(first, last).any()
        and holes.max() <= (MAX_MISSING_RUN + 0.5) * step
        and missing.seconds <= MAX_MISSING_SHARE * moving["seconds"].sum()
    )


def _interpolated(turned: _Turned) -> _Turned:
    """The same turn with the few samples that are masked in it."""
    missing = turned.missing
    masked = _("; {seconds:.2f} s are masked and interpolated", seconds=missing.seconds)
    return replace(
        turned,
        angle=None if turned.angle is None else turned.angle + missing.angle,
        missing=Missing(0.0, 0.0, ""),
        remark=masked + turned.remark,
    )


def _at_steady_rate(turned: _Turned) -> Performed:
    """A turn of which only the steady part is in the log."""
    m, rate, missing_s = turned.m, turned.rate, turned.missing.seconds
    sentence = _("no steady rate.")
    if rate is not None:
        sentence = _("steady at {signed} °/s.", signed=fixed(degrees(rate), 4))
    whole = missing_s == 0
    return Performed(
        m.name, sentence, True, whole, turned.angle, None, missing_s, rate, turned.seconds
    )


def _from_rest_to_rest(turned: _Turned, tolerance: float) -> Performed:
    """A turn with the rests beside it; `tolerance`: of its angle, a share of the planned one."""
    m, angle, rate, missing = turned.m, turned.angle, turned.rate, turned.missing
    if angle is None:
        return Performed(m.name, _("it turns, but has no time."), True, False, rate=rate)
    of = f"{fixed(degrees(angle), 2)}°"
    of += _(" of {signed}°", signed=fixed(degrees(m.angle), 0)) if m.angle else ""
    reasons = list(turned.reasons)
    known = 0.0 if missing.hindrance else missing.angle
    off = m.angle and abs((angle + known) / m.angle - 1) > tolerance
    if off and not (reasons or missing.hindrance):
        reasons.append(_("the angle is not the planned one"))
    lost = (
        [_("{seconds:.2f} s are missing while it turns", seconds=missing.seconds)]
        if missing.seconds
        else []
    )
    lost += [missing.hindrance] if missing.hindrance else []
    if not reasons and not lost:
        sentence = _("{of} from rest to rest{remark}.", of=of, remark=turned.remark)
        return Performed(m.name, sentence, True, True, angle, 0.0, 0.0, rate, turned.seconds)
    bridged = not reasons and not missing.hindrance
    lacking = missing.angle if bridged else m.angle - angle if m.angle is not None else None
    why = _(", and ").join([*lost, *reasons])
    sentence = _("{of} recorded{remark}: {why}", of=of, remark=turned.remark, why=why)
    sentence += _lacking_in_words(lacking, m)
    if bridged:
        sentence += _(" The rate before and after gives them, so the joint fit uses the turn.")
    return Performed(
        m.name,
        sentence,
        True,
        False,
        angle,
        lacking,
        missing.seconds,
        rate,
        turned.seconds,
        bridged,
        lost=not reasons,
    )


def _lacking_in_words(lacking: float | None, m: Manoeuvre) -> str:
    """The end of a sentence: what a turn lacks of its planned angle, or how far beyond it it is."""
    if lacking is None:
        return "."
    if m.angle and lacking * m.angle < 0:
        return _("; it is {beyond}° too far.", beyond=fixed(abs(degrees(lacking)), 2))
    return _("; {signed}° are missing.", signed=fixed(degrees(lacking), 2))


def by_other_axes(done: Performed) -> Performed:
    """A turn that is found only because axes of the gyros are exchanged or reversed.

    An estimate that takes them as they are named would be led far astray.
    """
    why = _(" It is left out of the estimates, for axes of the gyros are exchanged or reversed.")
    return replace(done, complete=False, bridged=False, sentence=done.sentence + why)
