"""Base class of detectors that compare the recording with its plan, and their data."""

from abc import ABC, abstractmethod
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from inertial.arrays import Array, Booleans, Integers, finite_or_none
from inertial.signal.axis_permutations import Permutation
from inertial.signal.detector import Description, Given
from inertial.text.messages import _


@dataclass(frozen=True)
class SignChange:
    """Gyro `axis` (0, 1, 2) changes its sign between two manoeuvres, one after the other.

    later: whether it is reversed from `after` on, else up to `before`; logs: those in which it is;
    parted: whether it changes in one of them.
    """

    axis: int
    before: str
    after: str
    later: bool
    logs: Sequence[str]
    parted: bool


@dataclass(frozen=True)
class Edge:
    """Where a part begins or ends: between two manoeuvres, and between two times of a log, s.

    before, after : empty where nothing tells how far beyond the other one it lies
    from_s, to_s : NaN where there is no time, or where it lies between two logs
    """

    before: str
    after: str
    from_s: float
    to_s: float


@dataclass(frozen=True)
class ReversedPart:
    """Gyro `axis` (0, 1, 2) reads its negative in a part of a recording.

    begins, ends : None where that is so from the start on, or to the end; turns : about this axis
    that read as planned; logs : in which it is so; parted : whether one of them is so in a part
    """

    axis: int
    begins: Edge | None
    ends: Edge | None
    turns: Sequence[str]
    logs: Sequence[str]
    parted: bool


@dataclass(frozen=True)
class Misread:
    """A sensor with exchanged or reversed axes; `log` is empty where all logs have it so.

    axes: takes its readings to the axes of the plan; explains: manoeuvres that fit only so.
    repair: id of its repair; undone: whether that is applied. rivals: the ids of others that
    explain as much, each with what would have to be true, in words. spans: of half a second, in
    which the gyros turn gravity as the accelerometers see it only so; 0: the plan shows it.
    change: where it begins, or ends, to be so; None where it is so all along. part: the part of the
    recording in which gravity shows it to be so, alone.
    """

    sensor: str
    axes: Permutation
    log: str
    explains: Sequence[str]
    repair: str = ""
    undone: bool = False
    rivals: Sequence[tuple[str, str]] = ()
    spans: int = 0
    change: SignChange | None = None
    part: ReversedPart | None = None


@dataclass(frozen=True)
class Swapped:
    """Manoeuvres that are found in each other's place, and the logs that hold them.

    repair, undone, rivals: as of Misread.
    """

    names: Sequence[str]
    logs: Sequence[str]
    repair: str = ""
    undone: bool = False
    rivals: Sequence[tuple[str, str]] = ()


def rivals_in_words(rivals: Sequence[tuple[str, str]]) -> str:
    """What explains as much, as a sentence that follows another one; empty where nothing does."""
    if not rivals:
        return ""
    return _(
        " That {rivals} explains as much, so nothing is set right.",
        rivals=_(", or that ").join(words for _id, words in rivals),
    )


def confirming(repair: str, rivals: Sequence[tuple[str, str]]) -> str:
    """How the laboratory confirms one of several that explain as much."""
    if not rivals:
        return ""
    ids = [f"accept: [{one}]" for one in (repair, *(one for one, _words in rivals))]
    return _(" The laboratory decides, by one of {ids} in the campaign file.", ids=", ".join(ids))


@dataclass(frozen=True)
class Rescaled:
    """Turns that were `ratio` times the planned ones, which is undone; log: empty where in all.

    why: what makes such a ratio, in words; names: the turns; repair: id of its repair.
    """

    ratio: float
    why: str
    log: str
    names: Sequence[str]
    repair: str


@dataclass(frozen=True)
class Reversed:
    """Turns that the plan counts the other way, which is undone; why: in words.

    about: a body axis, or negative; empty: all turns; by_gravity: whether gravity shows that the
    signs of the gyros are right; upended: whether the IMU stood the other way up in them instead.
    """

    repair: str
    names: Sequence[str]
    about: str
    why: str
    by_gravity: bool
    upended: bool = False


@dataclass(frozen=True)
class SpansOff:
    """Spans of a log that are all stated late by so many s, ± `open`, which is undone.

    late: negative where they are early; names: the manoeuvres; repair: id of its repair.
    """

    log: str
    late: float
    open: float
    names: Sequence[str]
    repair: str = ""


@dataclass(frozen=True)
class MarksOff:
    """Marks of the plan that contradict its turns, for nothing moved between the manoeuvres.

    names: the manoeuvres whose marks are taken for wrong; pair: one that is right, and one of
    these, of one course; off: rad, by how much at most; decided: whether the earth's rate at rest
    shows which are right; undecided: whether nothing does. repair: id of its repair; undone:
    whether that is applied.
    """

    names: Sequence[str]
    pair: tuple[str, str]
    off: float
    decided: bool
    undecided: bool
    repair: str = ""
    undone: bool = False


@dataclass(frozen=True)
class Undone:
    """What was set right, for the findings that tell of it.

    rescaled: count sizes of the gyros; restated: rates of the plan; reversed: turns that are taken
    the other way; spans_off: stated spans that are off by one time; marks_off: marks that turns
    contradict.
    rivals: for the id of a repair that is not applied those of others that explain as much.
    changes: for that of one of signs, which is not applied, where these change.
    """

    misread: list[Misread] = field(default_factory=list)
    swapped: list[Swapped] = field(default_factory=list)
    rescaled: list[Rescaled] = field(default_factory=list)
    restated: list[Rescaled] = field(default_factory=list)
    reversed: list[Reversed] = field(default_factory=list)
    spans_off: list[SpansOff] = field(default_factory=list)
    rivals: dict[str, Sequence[tuple[str, str]]] = field(default_factory=dict)
    changes: dict[str, SignChange] = field(default_factory=dict)
    marks_off: list[MarksOff] = field(default_factory=list)


@dataclass(frozen=True)
class StaticMeans:
    """The n rests of the manoeuvres of a plan, one after the other, those of turns too.

    manoeuvre: (n,), place in the plan; after_turn: (n,), whether it is that after a turn; force:
    (n, 3), m/s², mean; time, seconds: (n,), s, its middle and duration; scatter: (n, 3), m/s²·√s,
    of its blocks, by their duration; NaN where they are few.
    """

    manoeuvre: Integers
    after_turn: Booleans
    force: Array
    time: Array
    seconds: Array
    scatter: Array


@dataclass(frozen=True)
class Recorded:
    """The m manoeuvres of a plan, and what was recorded of each, SI and radians, body axes.

    name, log, position, do: what the plan calls it, where it is recorded, in which position of the
    table, and rest, turn or positions; tumble: which one a rest is of, none: of none; steady: only
    its steady part is planned to be recorded.
    up, about: (m, 3), planned directions, NaN where none; angle, rate, seconds: (m,), planned, the
    first two signed about `about`, NaN where none; by an encoder, where one is used, in place of
    the stated_angle. angle_sigma, rate_sigma: of the table, rad, and relative (NaN: not stated).
    found, complete, lost: (m,), the last where gaps and masks alone are why it is not complete;
    said: what was recorded of it, in words.
    force: (m, 3), mean of its rest, or of that before its turn; of one that is not found, of what
    its log holds instead; turned: (m, 3), angles of its motion; NaN where not recorded.
    moved: (m,), angle about `about`; speed: (m,), mean rate of its steady part about `about`;
    gravity_rate: (m, 2), rad/s, by the accelerometers in it, and its sigma, NaN where not level;
    unsteady: (m,), what quarters of that scatter by, relative, 0 where not known;
    static_means: of all rests;
    after_stop: (m,), rad, what it turns farther in the rest after it, NaN where not known;
    turned_farther: (m,), rad, the angle of its gyros about `about` beyond what they read there in
    the rests of its position, NaN where that is not known.
    jump_turn, jump_size, jump_sigma, jump_at: (j,), in which of them the encoder jumps where the
    gyros do not, by how much, and at which angle, rad; `angle` is without.
    lacking, lacking_s: (m,), angle and time that are missing; duration: (m,), s, of the rest
    or from start to stop.
    first, after: (m,), records of it, or of what its log holds instead, −1 where there are none;
    from_s, to_s: (m,).
    gyros: (m, 3), whether its log has readings of them.
    count: (m,), rad, what a count of its gyros is by the campaign, NaN where not stated.
    temperature: (m,), K, recorded, NaN where it mostly is not; stated_temperature and its
    temperature_sigma: those of the plan, NaN where not stated.
    gyro_signs: (3,), +1 right and −1 wrong, by the earth rate, 0 where it does not show.
    misread, swapped: what explains that the plan is not found as it is; undone: what was set right.
    divided: the rests of each still stretch that only the plan divides.
    tolerance: accepted difference of an angle or a rate from the plan's, 1.
    """

    given: Given
    tolerance: float
    name: Sequence[str]
    log: Sequence[str]
    position: Sequence[str]
    tumble: Sequence[str | None]
    do: Sequence[str]
    steady: Booleans
    up: Array
    about: Array
    angle: Array
    stated_angle: Array
    angle_sigma: float
    rate_sigma: float
    rate: Array
    seconds: Array
    found: Booleans
    complete: Booleans
    lost: Booleans
    said: Sequence[str]
    force: Array
    turned: Array
    moved: Array
    speed: Array
    gravity_rate: Array
    unsteady: Array
    after_stop: Array
    turned_farther: Array
    jump_turn: Integers
    jump_size: Array
    jump_sigma: Array
    jump_at: Array
    static_means: StaticMeans
    lacking: Array
    lacking_s: Array
    duration: Array
    first: Integers
    after: Integers
    from_s: Array
    to_s: Array
    gyros: Booleans
    count: Array
    temperature: Array
    stated_temperature: Array
    temperature_sigma: Array
    gyro_signs: Sequence[int]
    misread: Sequence[Misread]
    swapped: Sequence[Swapped]
    undone: Undone
    divided: Sequence[Sequence[str]]

    @property
    def explained(self) -> set[str]:
        """Manoeuvres of which something is known that explains why they are not as planned."""
        misread = {name for each in self.misread if not each.undone for name in each.explains}
        swapped = {name for each in self.swapped if not each.undone for name in each.names}
        return misread | swapped


@dataclass(frozen=True)
class Deviation:
    """A difference between recording and plan.

    at: number of the manoeuvre, None where it is the whole campaign or a log; log: empty for the
    campaign; first, after: records that show it, −1 where none do; facts: what its description
    needs; severity: where it is not that of the detector; repair: id of the repair of this.
    """

    at: int | None
    log: str
    size: float | None
    sensor: str | None = None
    axis: str | None = None
    first: int = -1
    after: int = -1
    from_s: float | None = None
    to_s: float | None = None
    count: int = 1
    facts: Any = None
    severity: int | None = None
    repair: str = ""


class PlanDetector(ABC):
    """One way in which a recording and its plan disagree; `severity` and `unit` as of a Detector.

    A class states its name and source, and in its docstring the cause and what it costs the result.
    """

    name: ClassVar[str]
    source: ClassVar[str]
    unit: ClassVar[str] = "1"
    severity: ClassVar[int] = 2
    sensor: ClassVar[str | None] = None

    @abstractmethod
    def detect(self, recorded: Recorded) -> Iterator[Deviation]:
        """Deviations, in the order of the plan."""

    @abstractmethod
    def describe(self, deviation: Deviation, recorded: Recorded) -> Description:
        """A deviation in words."""

    def of(self, recorded: Recorded, i: int, size: float | None, **more: Any) -> Deviation:
        """A deviation of manoeuvre i, at the records that it has."""
        place = {
            "first": int(recorded.first[i]),
            "after": int(recorded.after[i]),
            "from_s": finite_or_none(recorded.from_s[i]),
            "to_s": finite_or_none(recorded.to_s[i]),
        }
        known: dict[str, Any] = {"sensor": self.sensor, **place, **more}
        return Deviation(i, recorded.log[i], size, **known)
