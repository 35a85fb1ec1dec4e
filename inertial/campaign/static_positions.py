"""The static positions of a campaign: means of blocks, with their noise."""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields, replace
from functools import cached_property, partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.arrays import Array, Booleans
from inertial.campaign.records import Manoeuvre, Part, Performed
from inertial.estimation.accelerometers import StaticForce
from inertial.estimation.noise_model import SQRT2, sigma_of_mean
from inertial.estimation.probability import chi2_sf
from inertial.estimation.random_walk import COMMON_CLOCK, Stretch
from inertial.physics.motion import are_parts_of_turns, cross, is_vertical, level_axes, turned
from inertial.tables import ACCEL, AXES, GYRO, STATIC_PHASES
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY

if TYPE_CHECKING:
    from inertial.campaign.campaign_data import CampaignData

# --- The blocks of one manoeuvre as arrays ---


@dataclass(frozen=True)
class Blocks:
    """k blocks of one manoeuvre in their order, all of one log.

    `log`, `phase`, `counts` of samples, `seconds`, `missing` before each, s, `time` of the middle,
    s, `temperature`, K: (k,); `gyro`, rad/s, and `accel`, m/s²: (k, 3), NaN where not recorded;
    `encoder`: (k, 4), the angle of the table's encoder at the beginning and the end of each, rad,
    and its rate there, rad/s, NaN where it is not used.
    """

    log: NDArray[Any]
    phase: NDArray[Any]
    counts: Array
    seconds: Array
    missing: Array
    time: Array
    temperature: Array
    gyro: Array
    accel: Array
    encoder: Array

    def __len__(self) -> int:
        return len(self.phase)

    @property
    def steady(self) -> Booleans:
        """The blocks at the steady rate, (k,)."""
        return np.asarray(self.phase == "steady", bool)

    def those(self, which: NDArray[Any]) -> "Blocks":
        """Some of the blocks, by number or mask; the readings of a channel stay contiguous."""
        return Blocks(*(getattr(self, field.name).T[..., which].T for field in fields(self)))


NO_BLOCKS = Blocks(*(np.empty(0) for _ in range(7)), *(np.empty((0, n)) for n in (3, 3, 4)))
ENCODER = ["angle_from", "angle_to", "rate_from", "rate_to"]  # columns of the blocks


def by_manoeuvre(table: pd.DataFrame) -> dict[str, Blocks]:
    """The blocks of each manoeuvre, by its name."""
    all_blocks = _blocks(table)
    rows = table.groupby("manoeuvre").indices
    return {str(name): all_blocks.those(np.asarray(indices)) for name, indices in rows.items()}


def _blocks(table: pd.DataFrame) -> Blocks:
    names = ("count", "seconds", "missing_s", "time", "temperature")
    triples = [table[list(three)].to_numpy(np.float64) for three in (GYRO, ACCEL)]
    triples.append(table.reindex(columns=ENCODER).to_numpy(np.float64))
    return Blocks(
        table["log"].to_numpy(),
        table["phase"].to_numpy(),
        *(table[name].to_numpy(np.float64) for name in names),
        *triples,
    )


# --- Static positions of known attitude ---

WAVES = 8  # of the error of the angle within a turn
FASTER = float(np.sqrt(1 / 6 - np.sum(np.arange(1, WAVES + 1) ** -2.0) / np.pi**2))  # rms of others
UNTIMED = Stretch("")
NO_UP = _("which way is up is not known")
NO_ATTITUDE = _("its attitude is not known, for the turn is not whole")
NO_READING = _("none of its readings can be used")
NO_NOISE = _(
    "its noise is not known, for it is too short, or has no time: state sigma with mean_of in its "
    "format"
)
PER_BLOCK = ("means", "counts", "seconds", "time", "temperature")
LOUDER_P_VALUE = 1e-5  # that a stretch of white noise seems louder than it is
# Squares of neighbouring second differences of white noise correlate by 4/9 and 1/36.
DIFFERENCES_PER_DEGREE = 1 + 2 * (4 / 9 + 1 / 36)
# The median of n of them, by simulation: 0.455 (1 + 3.35/n) on average, with a variance of 0.26 n
# to 0.36 n degrees of freedom; beyond a chance of 10⁻⁵ by χ² are 5 in 100,000.
MIN_FOR_MEDIAN = 5
MEDIAN_OF_SQUARE, MEDIAN_ABOVE, DEGREES_OF_MEDIAN = 0.455, 3.35, 0.28
BLOCK_COLUMNS = ("count", "seconds", "time", "temperature")


@dataclass(frozen=True)
class StaticPosition:
    """A static position in k blocks.

    `part`: of the plan; `up`, `about`: (3,), body axes at the start of its manoeuvre; `angle`: rad,
    by which it has turned about `about` since; `means`: (k, 3), rad/s or m/s², NaN where not
    recorded; `counts`, `seconds`, `time` of the middle, s, `temperature`, K: (k,); `density`: (3,),
    white noise per √s; `stretch`: of time; `quantisation`: (3,), white noise of the integral;
    `loudness`: (3,), of a piece, by how much its noise exceeds that.
    """

    part: Part
    manoeuvre: Manoeuvre
    up: Array
    about: Array
    angle: float
    means: Array
    counts: Array
    seconds: Array
    time: Array
    temperature: Array
    density: Array
    stretch: Stretch = UNTIMED
    quantisation: Array = field(default_factory=partial(np.zeros, 3))
    loudness: Array | None = None

    @property
    def label(self) -> str:
        """Its manoeuvre, with the phase where it is one of a turn."""
        return self.part.label

    @cached_property
    def up_now(self) -> Array:
        """The direction that points up in this stretch, (3,)."""
        return turned(self.up, self.about, self.angle)

    @property
    def _level(self) -> Array | None:
        """The level axes of its position in body axes now, (2, 3), where it has turned since."""
        since = np.array([self.angle, self.manoeuvre.turned_on])
        if not are_parts_of_turns(since).any() or not self.up.any():
            return None
        axes = level_axes_of(self.manoeuvre)
        return np.array([turned(axis, self.about, self.angle) for axis in axes])

    def over(self, seconds: float = np.inf) -> tuple[Array, Array]:
        """Mean reading over the first `seconds`, and its sigma from the noise."""
        count = int(np.searchsorted(self._starts, seconds))
        with np.errstate(invalid="ignore", divide="ignore"):  # a channel that is not recorded
            summed, samples, duration = self._so_far[:, count - 1]
            louder = self.density * self._louder
            return summed / samples, sigma_of_mean(louder, self.quantisation, duration)

    def force(self, seconds: float = np.inf) -> StaticForce:
        """The observation of the accelerometers in the first `seconds`."""
        mean, sigma = self.over(seconds)
        stretch = self.during(seconds)
        return StaticForce(
            self.manoeuvre.position,
            self.up_now,
            mean,
            sigma,
            stretch=stretch,
            level=self._level,
            case=None if self._level is None else case_axes(self.up, self.about),
            turn_errors=turn_errors(
                self.manoeuvre, 1.0 if self.part.phase == "rest-after" else 0.0
            ),
            tumble_tilts=tumble_tilts(self.manoeuvre),
        )

    def mean_of(self, values: Array) -> float:
        """The mean of a quantity over all samples, from its means in the blocks, (k,)."""
        return float(np.average(values, weights=self.counts))

    def pieces(self, seconds: float) -> list["StaticPosition"]:
        """The position divided into pieces of about this duration, each with its own stretch."""
        count = max(round(float(self.seconds.sum()) / seconds), 1)
        edges = np.linspace(0, len(self.seconds), min(count, len(self.seconds)) + 1).round()
        return [
            self._piece(slice(int(first), int(after)), number)
            for number, (first, after) in enumerate(pairwise(edges))
        ]

    def _piece(self, indices: slice, number: int) -> "StaticPosition":
        start, end = _ends(self.time[indices], self.seconds[indices])
        name = f"{self.label} {number}"
        stretch = replace(self.stretch, name=name, start=start, seconds=end - start)
        columns = {name: getattr(self, name)[indices] for name in PER_BLOCK}
        return replace(self, stretch=stretch, loudness=self._loudness(indices), **columns)

    def during(self, seconds: float = np.inf) -> Stretch:
        """The stretch of time of the first `seconds`."""
        return replace(self.stretch, seconds=min(self.stretch.seconds, seconds))

    @property
    def _louder(self) -> Array:
        """How much louder the noise is here than `density` says, (3,): 1 but where that is certain.

        A level is that of a whole manoeuvre; someone who walks by is heard in a part of it.
        """
        if self.loudness is not None:
            return self.loudness
        return self._loudness(slice(0, len(self.seconds)))

    def _loudness(self, blocks: slice) -> Array:
        """That of some blocks, by second differences: a drift is next to nothing in these.

        A jump of the bias is in two or three of them, so where there are enough, those across the
        ends among them, their median is taken.
        """
        squares = self._squares[max(blocks.start - 1, 0) : blocks.stop - 1]
        squares = squares[np.isfinite(squares).all(axis=1)]
        if not (count := len(squares)):
            return np.ones(3)
        if count >= MIN_FOR_MEDIAN:
            usual = MEDIAN_OF_SQUARE * (1 + MEDIAN_ABOVE / count)
            excess, degrees = np.median(squares, axis=0) / usual, DEGREES_OF_MEDIAN * count
        else:
            excess, degrees = np.mean(squares, axis=0), count / DIFFERENCES_PER_DEGREE
        together = chi2_sf(float(excess.sum()) * degrees, len(excess) * degrees)
        each = chi2_sf(excess * degrees, np.full(len(excess), degrees))
        louder = np.minimum(each, together) < LOUDER_P_VALUE
        return np.where(louder, np.sqrt(np.maximum(excess, 1.0)), 1.0)

    @cached_property
    def _squares(self) -> Array:
        """The squares of the second differences of the blocks over their variance, (k − 2, 3)."""
        with np.errstate(invalid="ignore", divide="ignore"):
            each = 1 / self.seconds[:, None]
            variance = each * self.density**2
            first, middle, last = each[:-2], 2 * each[1:-1], each[2:]
            ends = first**2 + (first + middle) ** 2 + (middle + last) ** 2 + last**2
            white = variance[:-2] + 4 * variance[1:-1] + variance[2:]
            squares = np.diff(self.means, 2, axis=0) ** 2 / (white + ends * self.quantisation**2)
        return np.asarray(squares)

    @cached_property
    def _starts(self) -> Array:
        """Start of each block without the pauses, (k,), s."""
        return np.cumsum(self.seconds) - self.seconds

    @cached_property
    def _so_far(self) -> Array:
        """Sums of readings, samples and seconds to the end of each block, (3, k, 3)."""
        recorded = np.isfinite(self.means)
        samples, duration = recorded * self.counts[:, None], recorded * self.seconds[:, None]
        return np.cumsum([samples * np.nan_to_num(self.means), samples, duration], axis=1)


def level_axes_of(m: Manoeuvre) -> Array:
    """Two level directions at its start, (2, 3), that its position keeps in the laboratory."""
    assert m.up is not None  # else it is by hand
    return np.array([turned(axis, m.up, m.turned_on) for axis in level_axes(m.up)])


def case_axes(up: Array, about: Array) -> Array | None:
    """The level axes of the start of a turn about an axis that is not vertical, (2, 3)."""
    return None if is_vertical(up, about) else np.array(level_axes(up))


def tumble_tilts(m: Manoeuvre) -> Mapping[str, Array]:
    """The tilts that all rests of a tumble share, by name as directions in body axes, (3,).

    The axis is not level, which is fixed to the laboratory; the angles are off by the same; and the
    case does not stand on the axis as it should, about two directions that are fixed to it.
    """
    if m.tumble is None or m.up is None or m.tumble_axis is None or m.tumbled is None:
        return {}
    axis = m.tumble_axis
    start = turned(m.up, axis, -float(m.tumbled @ axis))
    tilts = {
        "lean of axis": cross(axis, m.up),
        "angle": axis,
        "case 0": start,
        "case 1": cross(axis, start),
    }
    return {f"{m.tumble} {name}": direction for name, direction in tilts.items()}


def turn_errors(m: Manoeuvre, share: float, walk: float = 0.0) -> Mapping[str, Array]:
    """The errors of the angle where a share of a turn about an axis that is not vertical is behind.

    The table stops to the sigma of its angle, which is that from one stop to the other: each has
    half of its variance. What is between is divided by the gyros, whose random walk has both ends
    known: it is a Brownian bridge, given here by its slowest waves (Karhunen & Loève).

    Parameters
    ----------
    walk : rad, sigma of the random walk of the gyros' angle over the whole turn
    """
    if m.do != "turn" or m.up is None or is_vertical(m.up, m.axis):
        return {}
    stop = (m.angle_sigma or 0.0) / SQRT2
    sizes = {"before": (1 - share) * stop, "after": share * stop}
    for k in range(1, WAVES + 1) if walk else ():
        sizes[f"wave {k}"] = walk * SQRT2 * np.sin(k * np.pi * share) / (k * np.pi)
    return {f"{m.name} {name}": size * m.axis for name, size in sizes.items() if size}


def of_faster_waves(m: Manoeuvre, ups: Array, walk: float) -> Array:
    """Sigma of means of specific force by the waves that `turn_errors` leaves out, m/s², as `ups`.

    `ups`: (…, 3), what is up for the case; `walk`: as there.
    """
    if m.up is None or is_vertical(m.up, m.axis):
        return np.zeros_like(ups)
    return np.abs(FASTER * walk * STANDARD_GRAVITY * cross(m.axis, ups))


def static_positions(data: "CampaignData", sensor: str) -> tuple[list[StaticPosition], list[Part]]:
    """The static positions of known attitude, and those left out with the reason.

    The attitude after a rotation is known where the rotation was recorded from rest to rest.
    Of the gyros also those beside turns of which only the axis is known, with zero `up`.
    `sensor` is accel or gyro.
    """
    blocks, performed = data.blocks, data.performed
    positions: list[StaticPosition] = []
    left_out: list[Part] = []
    channels = [f"{sensor}_{axis}" for axis in AXES]
    at_rest = blocks[blocks["phase"].isin(STATIC_PHASES) & (blocks["count"] > 0)]
    readings = at_rest[channels].to_numpy(np.float64)
    columns = {name: at_rest[name].to_numpy(np.float64) for name in BLOCK_COLUMNS}
    logs = at_rest["log"].to_numpy()
    rows = at_rest.groupby(["manoeuvre", "phase"]).indices
    recorded = bool(np.isfinite(blocks[channels].to_numpy(np.float64)).any())
    for m in data.plan:
        if m.do == "positions":
            left_out.append(Part(m.name, None, _("the attitudes of its rests are not known")))
        if m.do == "rest" and not performed[m.name].found:
            left_out.append(Part(m.name, None, _("not found in its log")))
        for phase in ("rest", "rest-before", "rest-after"):
            indices = rows.get((m.name, phase))
            if indices is None:
                continue
            if np.isnan(readings[indices]).all():
                if recorded:
                    left_out.append(Part(m.name, phase, NO_READING))
                continue
            count, seconds, time, temperature = (columns[name][indices] for name in BLOCK_COLUMNS)
            density = data.noise.of(m.name, "rest", channels)
            after, part = phase == "rest-after", Part(m.name, phase)
            reason = _refusal(m, performed[m.name], phase, seconds, density)
            up = np.zeros(3) if m.up is None else m.up
            axis_alone = m.up is None and m.do == "turn" and sensor == "gyro"
            if m.up is None and not axis_alone:
                left_out.append(replace(part, reason=NO_UP))
            elif reason:
                left_out.append(replace(part, reason=reason))
            else:
                positions.append(
                    StaticPosition(
                        part,
                        m,
                        up,
                        up if m.about is None else m.about,
                        (m.angle or 0.0) if after else 0.0,
                        readings[indices],
                        count,
                        seconds,
                        time,
                        temperature,
                        density,
                        replace(
                            stretch_between(
                                part.label, str(logs[indices[0]]), time, seconds, data.shared_clock
                            ),
                            switch_on=m.switch_on,
                        ),
                        data.noise.of_integral(m.name, "rest", sensor),
                    )
                )
    return positions, left_out


def _refusal(m: Manoeuvre, done: Performed, phase: str, seconds: Array, density: Array) -> str:
    """Why a static position cannot be used; empty where it can."""
    if phase == "rest-after" and (not (done.complete or done.bridged) or m.angle is None):
        return NO_ATTITUDE
    if np.isnan(seconds).any() or np.isnan(density).all():
        return NO_NOISE
    return ""


def stretch_of(m: Manoeuvre, part: Blocks, shared_clock: bool) -> Stretch:
    """The stretch of time of some blocks of a manoeuvre in their order."""
    log = str(part.log[0])
    stretch = stretch_between(m.name, log, part.time, part.seconds, shared_clock)
    return replace(stretch, switch_on=m.switch_on)


def stretch_between(
    name: str, log: str, time: Array, seconds: Array, shared_clock: bool
) -> Stretch:
    """The stretch of consecutive blocks of a log, from their middles and durations, s."""
    start, end = _ends(time, seconds)
    return Stretch(name, COMMON_CLOCK if shared_clock else log, start, end - start)


def _ends(time: Array, seconds: Array) -> tuple[float, float]:
    """Start and end of consecutive blocks, from their middles, s.

    NaN where the time goes back: nothing tells when that was.
    """
    if (np.diff(time) <= 0).any():
        return np.nan, np.nan
    return float(time[0] - seconds[0] / 2), float(time[-1] + seconds[-1] / 2)


def averaging_times(positions: list[StaticPosition], steps: int) -> list[float]:
    """Averaging times from a block to the longest static position, in equal ratios, s."""
    lengths = [position.seconds for position in positions if position.manoeuvre.do == "rest"]
    if not lengths:
        return []
    shortest = max(float(seconds.max()) for seconds in lengths)
    longest = max(float(seconds.sum()) for seconds in lengths)
    return [float(t) for t in np.unique(np.geomspace(shortest, longest, steps).round(6))]
