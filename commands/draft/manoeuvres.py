"""What was done: static positions and turns, with attitude, angle and rate, as far as logs show."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from commands.draft.sensors import Kind, Part, are_means
from commands.draft.series import MIN_REST_S, Divided, Still
from inertial.arrays import Array, nearest_axis

# ---- Rotations about one body axis in a recording, and the angle and rate that were meant.

MAX_FACE_ANGLE = np.radians(15)  # of gravity to an axis, that is meant to be a face
MAX_AXIS_ANGLE = np.radians(25)  # of a turn to an axis, that is meant to be about it
MIN_TURN = np.radians(60)  # of an angle, to be a turn
MIN_STRAIGHT = 0.85  # share of all rotation that is about one axis
MAX_OFF_ROUND = 0.12  # of an angle by hand to the quarter turns that are meant
MAX_RIPPLE = 0.02  # of the rate of a table at its steady rate, and of its angle to the round one


def face(vector: Array, most: float = MAX_FACE_ANGLE) -> str | None:
    """The signed axis along a vector, (3,), such as a specific force; None where there is none."""
    if not np.isfinite(vector).all() or not np.linalg.norm(vector):
        return None
    i = nearest_axis(vector)
    if abs(vector[i]) < np.cos(most) * np.linalg.norm(vector):
        return None
    return f"{'+' if vector[i] > 0 else '-'}{'xyz'[i]}"


@dataclass(frozen=True)
class Turn:
    """A rotation about one body axis, bins [first, after): net angle, (3,), rad, and its rate.

    straight: share of all rotation that is about this axis; rate: rad/s, in its middle half, and
    ripple, the scatter of it, relative.
    """

    first: int
    after: int
    net: Array
    straight: float
    rate: float
    ripple: float

    @property
    def angle(self) -> float:
        """Without its sign, rad."""
        return float(np.linalg.norm(self.net))

    @property
    def axis(self) -> str:
        """The signed axis nearest to it."""
        return face(self.net, np.pi) or "+z"


def turns_in(own: Divided) -> Iterator[Turn]:
    """Rotations about one axis; what follows about the same one after a pause belongs to it."""
    moves = [stretch for stretch in own.stretches if stretch.moves]
    pause = MIN_REST_S / own.series.bin_seconds()
    while moves and len(own.series.gyro):
        first, after = moves[0].first, moves[0].after
        turn = _rotation(own, first, after)
        used = 1
        for stretch in moves[1:]:
            if stretch.first - after >= pause:
                break
            further = _rotation(own, stretch.first, stretch.after)
            if further.net @ turn.net < np.cos(MAX_AXIS_ANGLE) * further.angle * turn.angle:
                break
            after, used = stretch.after, used + 1
            turn = _rotation(own, first, after)
        moves = moves[used:]
        large = turn.angle > MIN_TURN or (first == 0 and after == own.series.bins)
        if turn.straight > MIN_STRAIGHT and large and face(turn.net, MAX_AXIS_ANGLE):
            yield turn


def _rotation(own: Divided, first: int, after: int) -> Turn:
    """What the gyros have between two bins, and what is slow just before and after."""
    step = own.series.bin_seconds()
    rates = (own.rates - own.level)[max(first - 2, 0) : after + 2]
    net = rates.sum(axis=0) * step
    axis = net / (np.linalg.norm(net) or 1.0)
    path = float(np.linalg.norm(rates, axis=1).sum() * step)
    k = len(rates)
    middle = (rates @ axis)[k // 4 : max(k - k // 4, k // 4 + 1)]
    rate = float(middle.mean())
    ripple = float(middle.std() / abs(rate)) if rate and len(middle) > 3 else 1.0
    return Turn(first, after, net, float(np.linalg.norm(net)) / (path or 1.0), rate, ripple)


def about_vertical(own: Divided) -> dict[int, Turn]:
    """The turns about the vertical, by the number of the rest before each."""
    rests = own.rests
    turns = {}
    for turn in turns_in(own):
        before = sum(rest.after <= turn.first + 1 for rest in rests) - 1
        behind = sum(rest.first < turn.after - 1 for rest in rests)
        if before >= 0 and behind == before + 1 < len(rests):
            up = face(rests[before].accel)
            if up and up == face(rests[behind].accel) and up[1] == turn.axis[1]:
                turns[before] = turn
    return turns


def round_angle(seen: float, by_table: bool) -> float:
    """The angle that was meant: a multiple of 90°, or of 5° where none is near."""
    quarters = np.round(seen / 90) or np.sign(seen)
    off = abs(seen / (90 * quarters) - 1)
    if off < (MAX_RIPPLE if by_table else MAX_OFF_ROUND):
        return float(90 * quarters)
    return float(5 * np.round(seen / 5))


def rounded_rate(rate: float) -> float:
    """A rate as one sets it, to one or two digits where that is near, °/s."""
    for digits in (1, 2):
        plain = float(f"{rate:.{digits}g}")
        if abs(plain / rate - 1) < MAX_RIPPLE / 2:
            return plain
    return float(f"{rate:.3g}")


# ---- Manoeuvres.

MIN_POSITIONS = 3  # static positions, to be a session of them
MIN_FACES, MIN_SESSION_TURNS = 5, 2  # of a session beside a journey
MAX_LEANING = np.radians(25)  # of what is mounted, on slopes
MIN_FREE = 10  # rests that determine scale factors, cross terms and biases by |f| = g
MIN_ON_FACES = 0.85  # share of all time at rest on faces, to be a session of faces
SHARE_OF_SHORTEST = 0.7  # of the shortest static position, from which on one counts
MAX_BESIDE_S = 5.0  # s, of a rest beside a turn that belong to it


@dataclass(frozen=True)
class Manoeuvre:
    """One line of the plan: rest, turn or positions, with what is known of it.

    up, about: signed axis, or None; degrees, rate: of a turn, °, °/s; seen: the angle that the
    gyros have, °; seconds; rows: of the first file, (first, after), None for the whole of it; held:
    in the position of the manoeuvre before it: a table turned by whole rounds between, or not.
    """

    do: str
    part: Part
    up: str | None = None
    about: str | None = None
    degrees: float | None = None
    seen: float | None = None
    rate: float | None = None
    steady: bool = False
    by_table: bool = False
    seconds: float | None = None
    rows: tuple[int, int] | None = None
    count: int = 0  # static positions that were found
    held: bool = False
    force: tuple[float, ...] = ()  # what the accelerometers read at rest, (3,)

    @property
    def whole(self) -> bool:
        """Whether a table turned by whole rounds."""
        return self.by_table and self.degrees is not None and self.degrees % 360 == 0


def plan_of(kinds: Sequence[Kind]) -> list[Manoeuvre]:
    """The manoeuvres of all recordings in their order."""
    return [
        m
        for kind in kinds
        for m in (map(_of_means, kind.parts) if kind.means else _of_samples(kind))
    ]


def _of_means(part: Part) -> Manoeuvre:
    """Each row is a static position; or all are one, each at its temperature."""
    accel, count = part.series.accel, part.logs[0].rows
    if are_means(accel):
        return Manoeuvre("positions", part, rows=part.rows, count=count)
    return Manoeuvre("rest", part, up=face(accel.mean(axis=0)), count=count)


def _of_samples(kind: Kind) -> list[Manoeuvre]:
    """What each recording holds; of one whose end holds no samples the rows are stated."""
    return [
        replace(m, rows=m.rows or part.rows) if part.logs[0].left_out else m
        for part, own in zip(kind.parts, kind.divided, strict=True)
        for m in _manoeuvres(part, own)
    ]


def _manoeuvres(part: Part, own: Divided) -> Iterator[Manoeuvre]:
    """What one recording holds: positions, faces and turns in order, or a single manoeuvre.

    Many faces without turns are positions: the motions from one to the next are all that shows M of
    the gyros, and they need no attitude.
    """
    rests = own.rests
    if len(rests) >= MIN_POSITIONS and len(own.series.accel):
        between = about_vertical(own)
        session = _session(rests, between)
        free = len(rests) >= MIN_FREE and not between and len(own.series.gyro) > 0
        if not session or free:
            shortest = min(rest.seconds for rest in rests)
            seconds = max(np.floor(SHARE_OF_SHORTEST * shortest), MIN_REST_S)
            yield Manoeuvre("positions", part, seconds=float(seconds), count=len(rests))
        else:
            yield from _in_order(part, own, between, session)
    elif turns := list(turns_in(own)):
        yield _turn(part, own, max(turns, key=lambda turn: turn.angle))
    elif rests:
        rest = max(rests, key=lambda rest: rest.seconds)
        rows = None if len(rests) == 1 else _rows(part, own, *own.inside(rest))
        up, force = face(rest.accel), tuple(rest.accel)
        yield Manoeuvre("rest", part, up=up, seconds=rest.seconds, rows=rows, force=force)


def _session(rests: Sequence[Still], turns: Mapping[int, Turn]) -> range:
    """Which rests are a session of faces: all, or those before or after a journey; else none.

    On a journey an IMU rests again and again: in one attitude, in which it is mounted, or in any;
    then only a session with turns about the vertical is told from a session of positions.
    """
    seconds = np.array([rest.seconds for rest in rests])
    faces = [face(rest.accel) for rest in rests]
    there = np.array([up is not None for up in faces])
    up = np.array([rest.accel / np.linalg.norm(rest.accel) for rest in rests])
    every = range(len(rests))
    for k in range(len(rests), 0, -1):
        for own, others in ((every[:k], every[k:]), (every[-k:], every[:-k])):
            on_faces = there[own] @ seconds[own] >= MIN_ON_FACES * seconds[own].sum()
            if not others:
                found = on_faces
            else:
                mounted = (up[others] @ up[others[0]]).min() > np.cos(MAX_LEANING)
                turned = sum(i in own and i + 1 in own for i in turns) >= MIN_SESSION_TURNS
                several = len({faces[i] for i in own} - {None}) >= MIN_FACES
                found = on_faces and several and (mounted or turned)
            if found:
                return own if not others else _trimmed(own, faces, turns, at_end=own.start == 0)
    return every[:0]


def _trimmed(
    own: range, faces: Sequence[str | None], turns: Collection[int], *, at_end: bool
) -> range:
    """A session without what follows its last new face, or comes before, and the turns there."""
    step = 1 if at_end else -1
    new = {faces[i]: i for i in own[::-step]}
    new.pop(None, None)
    edge = max(new.values()) if at_end else min(new.values())
    while edge + step in own and min(edge, edge + step) in turns:
        edge += step
    return range(own.start, edge + 1) if at_end else range(edge, own.stop)


def _in_order(
    part: Part, own: Divided, turns: Mapping[int, Turn], session: range
) -> Iterator[Manoeuvre]:
    """Static positions and the turns about the vertical between them; other motions are changes."""
    rests = own.rests
    turns = {k: turn for k, turn in turns.items() if k in session and k + 1 in session}
    most = round(MAX_BESIDE_S / own.series.bin_seconds())
    held = False
    for k in session:
        rest = rests[k]
        # A rest beside a turn belongs to it; a longer one is a static position besides.
        first, after = own.inside(rest)
        first += min(most, after - first) if k - 1 in turns else 0
        after -= min(most, after - first) if k in turns else 0
        seconds = (after - first) * own.series.bin_seconds()
        if seconds > MIN_REST_S and (up := face(rest.accel)):
            rows = _rows(part, own, first, after)
            own_rest = Manoeuvre("rest", part, up=up, seconds=seconds, rows=rows)
            yield replace(own_rest, held=held, force=tuple(rest.accel))
            held = True
        if k in turns:
            following = rests[k + 1]
            both = k + 1 in turns  # the rest between two turns is shared
            start = max(rest.first if k - 1 not in turns else _middle(rest), rest.after - most)
            stop = min(_middle(following) if both else following.after, following.first + most)
            turn = _turn(part, own, turns[k], rest, _rows(part, own, start, stop))
            yield replace(turn, held=held and turn.whole)
            held = turn.whole
        else:
            held = False


def _middle(rest: Still) -> int:
    return (rest.first + rest.after) // 2


def _turn(
    part: Part,
    own: Divided,
    turn: Turn,
    before: Still | None = None,
    rows: tuple[int, int] | None = None,
) -> Manoeuvre:
    """A turn with its round angle, and its rate where a table keeps it."""
    if before is None:
        before = next((r for r in reversed(own.rests) if r.after <= turn.first + 1), None)
    about = turn.axis
    up = face(before.accel if before else own.forces.mean(axis=0))
    about = up if up is not None and up[1] == about[1] else "+" + about[1]
    along = float(turn.net["xyz".index(about[1])])
    sign = float(np.sign(along if about[0] == "+" else -along))
    seen = sign * float(np.degrees(turn.angle))
    by_table = turn.ripple < MAX_RIPPLE
    steady = by_table and turn.first == 0 and turn.after == own.series.bins
    rate = rounded_rate(abs(float(np.degrees(turn.rate)))) if by_table else None
    return Manoeuvre(
        "turn",
        part,
        up=up,
        about=about,
        degrees=None if steady else round_angle(seen, by_table),
        seen=seen,
        rate=rate if not steady or rate is None else sign * rate,
        steady=steady,
        by_table=by_table,
        seconds=(turn.after - turn.first) * own.series.bin_seconds(),
        rows=rows,
    )


def _rows(part: Part, own: Divided, first: int, after: int) -> tuple[int, int]:
    """The rows of the log, or of its label, between two bins."""
    begin, end = part.rows
    scale = (end - begin) / own.series.bins
    return begin + round(first * scale), begin + round(after * scale)


def leaning(plan: Sequence[Manoeuvre]) -> float | None:
    """The rms of the angle about each level axis by which cases on their faces lean, rad.

    With cross-axis terms; without biases, which both faces of an axis show.
    """
    there = [m for m in plan if m.do == "rest" and m.up is not None and len(m.force)]
    if not there:
        return None
    forces = np.array([m.force for m in there])
    axes = np.array(["xyz".index(str(m.up)[1]) for m in there])
    signs = np.array([1 if str(m.up)[0] == "+" else -1 for m in there])
    for i in range(3):
        along = [forces[(axes == i) & (signs == sign), i] for sign in (1, -1)]
        if all(map(len, along)):
            forces[:, i] -= (along[0].mean() + along[1].mean()) / 2
    level = np.arange(3) != axes[:, np.newaxis]
    lengths = np.linalg.norm(forces, axis=1, keepdims=True)
    return float(np.sqrt(np.mean(np.square(forces / lengths)[level])))
