"""Whether the residuals, given the named effects, have a structure.

Functions of the motion are fitted like an effect, with all else: so tilts, gravity and random
walks enter as they do there.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from types import MappingProxyType

import numpy as np

from inertial.arrays import Array, Integers
from inertial.campaign.equations import Campaign
from inertial.campaign.hypotheses import MAX_CARRYING
from inertial.estimation.triad import linear_names
from inertial.model_selection.cause import UNKNOWN_STRUCTURE
from inertial.model_selection.structure_tests import (
    TESTS,
    Conditions,
    ScoreEquations,
    Structure,
    structures,
)
from inertial.physics.effect import Effect, Parameter, Reading
from inertial.physics.motion import Motion
from inertial.sensors import FILE_KEYS, PLURAL, UNITS
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import p_is, significant
from inertial.text.parameters import AXES
from stages.criticism.finding_rows import (
    ONLY_CONSISTENT,
    TableRow,
    finding_id,
    finding_row,
    member_rows,
    snr_of,
)

PRIOR_SIGMA = 1e4  # of a named effect's parameters, in their typical sizes
BINS = 60  # of a figure
MIN_INFORMATION = 1e-6  # of that of a function alone; with less the function counts as absorbed


class Functions(Effect):
    """Functions of one motion, (n, k), that the reading of one axis may contain; no effect."""

    cause = "unknown"
    source = "score test (Rao)"
    sizes = MappingProxyType({"usual": 1.0})

    def __init__(self, sensor: str, axis: int, name: str, functions: Array) -> None:
        self.sensor, self.axis, self.functions = sensor, axis, functions
        self.name = name
        count = functions.shape[1]
        self.parameters = tuple(Parameter(str(i), "", 1.0, "") for i in range(count))

    def signature(self, motion: Motion) -> Reading:
        traces = {name: np.zeros((len(motion.rate), 3, len(self.parameters))) for name in FILE_KEYS}
        traces[self.sensor][:, self.axis] = self.functions
        return Reading(**traces)


@dataclass(frozen=True)
class TestedFit:
    """The fit whose residuals are tested: mount, named effects, manoeuvres used (None: all)."""

    campaign: Campaign
    named: Sequence[Effect]
    only: frozenset[str] | None = None


@dataclass(frozen=True)
class Tested:
    """The six tests of the residuals; `noise_degrees`, `level`: as in `structure_tests`."""

    fitted: TestedFit
    noise_degrees: float
    level: float
    tests: Sequence[Structure]

    @property
    def detected(self) -> list[Structure]:
        """The tests that detect a structure, the most significant first."""
        return sorted((test for test in self.tests if test.detected), key=lambda test: test.p_value)

    @property
    def possible(self) -> set[str]:
        """The kinds of which the recording has what they depend on."""
        return {test.kind for test in self.tests if test.possible}

    def of(self, sensor: str) -> list[Structure]:
        """Those in the readings of a sensor, `gyro` or `accel`."""
        return [test for test in self.detected if test.sensor == sensor]


@dataclass(frozen=True)
class Point:
    """The residual of an axis in a bin of the variable of a test.

    `x`: s, rad, rad/s, K, or rad from upright; `residual`, `sigma`, and `structure`, the
    fitted functions of the test: rad/s or m/s².
    """

    x: float
    residual: float
    sigma: float
    structure: float


def structure_tests(
    campaign: Campaign, named: Sequence[Effect], noise_degrees: float, level: float
) -> Tested:
    """The tests of the residuals given the named effects.

    `level`: accepted probability that any detects a structure where there is none.
    """
    return _tests(TestedFit(campaign, named), noise_degrees, level)


def _tests(fitted: TestedFit, noise_degrees: float, level: float) -> Tested:
    equations = [
        equation
        for sensor in FILE_KEYS
        for axis in range(3)
        for degrees in [fitted.campaign.noise_degrees(sensor, noise_degrees)]
        for equation in _equations(fitted, sensor, axis, degrees)
    ]
    return Tested(fitted, noise_degrees, level, structures(equations, level))


def carrying(tested: Tested, sensor: str) -> tuple[str, ...]:
    """The manoeuvres without which a sensor has no structure; none where no few carry it.

    They are left out one after the other, each time that without which the most significant
    structure explains least; those that turn out not to be needed are put back.
    """
    left_out, remaining = list[str](), tested.of(sensor)
    if not remaining:
        return ()
    campaign = tested.fitted.campaign
    names = list(dict.fromkeys(campaign.manoeuvres_of(sensor)))

    def without(some: Sequence[str]) -> TestedFit:
        return replace(tested.fitted, only=frozenset(campaign.manoeuvres).difference(some))

    def found(some: Sequence[str]) -> list[Structure]:
        return _tests(without(some), tested.noise_degrees, tested.level).of(sensor)

    while remaining and len(left_out) < min(MAX_CARRYING, len(names) // 2):
        others = [name for name in names if name not in left_out]
        explained = [_explained(without([*left_out, name]), remaining[0]) for name in others]
        left_out.append(others[int(np.argmin(explained))])
        remaining = found(left_out)
    if remaining:
        return ()
    for name in left_out[:-1]:
        fewer = [other for other in left_out if other != name]
        if not found(fewer):
            left_out = fewer
    return tuple(left_out)


def moved_by(
    campaign: Campaign, sensor: str, carried: Sequence[str], effects: Sequence[Effect] = ()
) -> float | None:
    """The largest shift of a parameter of the joint result by what is not noise, in its sigma.

    Without the manoeuvres that carry a structure, and with the named effects, there is none, so
    what the parameters then are differs by what these do to them, and by noise. None where no few
    carry it, or where not all are determined without.
    """
    if not carried:
        return None
    others = set(campaign.manoeuvres).difference(carried)
    systems = [
        campaign.system(sensor, [], PRIOR_SIGMA),
        campaign.system(sensor, effects, PRIOR_SIGMA, others),
    ]
    whole, without = (None if one is None else one.solve_shared() for one in systems)
    if whole is None or without is None:
        return None
    twelve = range(len(linear_names()))
    if not (whole.determined[twelve] <= without.determined[twelve]).all():
        return None
    sigma = np.sqrt(np.diag(whole.covariance)[twelve])
    return float(np.max(np.abs(without.values[twelve] - whole.values[twelve]) / sigma))


def _explained(fitted: TestedFit, test: Structure) -> float:
    """The reduction of χ² by a structure of this shape, its amplitude estimated again."""
    chosen, values = test.values
    assert test.equations is not None  # it is detected
    structure = test.equations.tested.functions[:, chosen] @ values
    own = [structure[:, None]]
    rest, columns, _ = _residuals(fitted, test.sensor, AXES.index(test.axis), own)
    information = float(columns[:, 0] @ columns[:, 0])
    return float(columns[:, 0] @ rest) ** 2 / information if information > 0 else 0.0


def points(tested: Tested, test: Structure) -> Iterator[Point]:
    """The residuals in bins along which a structure is detected, all else as fitted."""
    sensor, axis = test.sensor, test.axis
    campaign = tested.fitted.campaign
    own = campaign.stretches(sensor)
    conditions = conditions_of(campaign.motion, own, sensor, AXES.index(axis))
    abscissa = _abscissa(conditions, test.kind, AXES.index(axis))
    bins = [group for group in _bins(abscissa) if len(group)]
    chosen, values = test.values
    assert test.equations is not None  # it is detected
    shown = np.zeros((len(abscissa), 1 + len(bins)))
    shown[:, 0] = test.equations.tested.functions[:, chosen] @ values
    for column, group in enumerate(bins, 1):
        shown[group, column] = 1.0
    rest, columns, _ = _residuals(tested.fitted, sensor, AXES.index(axis), [shown])
    for column, group in enumerate(bins, 1):
        own_column = columns[:, column]
        information = float(own_column @ own_column)
        if information > 0:
            yield Point(
                float(abscissa[group].mean()),
                float(own_column @ rest) / information,
                float(information**-0.5),
                float(own_column @ columns[:, 0]) / information,
            )


def _abscissa(conditions: Conditions, kind: str, axis: int) -> Array:
    """The abscissa of a figure of the structure, (n,)."""
    if kind in ("time", "change"):
        return conditions.time
    if kind == "attitude":
        return np.asarray(np.arccos(np.clip(conditions.up[:, axis], -1.0, 1.0)))
    return np.asarray(getattr(conditions, kind))


def _bins(abscissa: Array) -> list[Integers]:
    """The readings in bins of equal width, those of unknown abscissa in none."""
    known = np.isfinite(abscissa)
    low, high = float(np.min(abscissa[known])), float(np.max(abscissa[known]))
    width = (high - low) / BINS or 1.0
    place = np.where(known, np.minimum((abscissa - low) / width, BINS - 1), -1).astype(np.int64)
    return [np.flatnonzero(place == number) for number in range(BINS)]


def _equations(
    fitted: TestedFit, sensor: str, axis: int, noise_degrees: float
) -> Iterator[ScoreEquations]:
    campaign = fitted.campaign
    if getattr(campaign.solution, FILE_KEYS[sensor]) is None:
        return
    if fitted.only is not None and fitted.only.isdisjoint(campaign.manoeuvres_of(sensor)):
        return
    conditions = conditions_of(campaign.motion, campaign.stretches(sensor), sensor, axis)
    tested = [(kind, groups) for kind, test in TESTS.items() for groups in test(conditions)]
    if not tested:
        return  # nothing of this sensor is simulated
    functions = [groups.functions for _, groups in tested]
    rest, columns, degrees = _residuals(fitted, sensor, axis, functions)
    first = 0
    for kind, groups in tested:
        own = slice(first, first + groups.functions.shape[1])
        reduced = columns[:, own]
        yield ScoreEquations(
            kind,
            sensor,
            AXES[axis],
            groups,
            reduced.T @ reduced,
            reduced.T @ rest,
            float(rest @ rest),
            degrees,
            noise_degrees,
        )
        first = own.stop


def _residuals(
    fitted: TestedFit, sensor: str, axis: int, functions: Sequence[Array]
) -> tuple[Array, Array, int]:
    """The residuals, (m,), the functions with all that is fitted removed, (m, k), and the degrees.

    `functions`: of the stretches of the sensor.
    """
    campaign = fitted.campaign
    whole = np.zeros((len(campaign.motion.rate), sum(each.shape[1] for each in functions)))
    whole[campaign.stretches(sensor)] = np.hstack(list(functions))
    effects = [*fitted.named, Functions(sensor, axis, "tested", whole)]
    only = None if fitted.only is None else set(fitted.only)
    system = campaign.system(sensor, effects, PRIOR_SIGMA, only)
    assert system is not None  # else there are no tests
    rest, columns, raw = system.projected(sum(len(effect.parameters) for effect in fitted.named))
    absorbed = np.sum(columns**2, axis=0) < MIN_INFORMATION * raw
    return rest, np.where(absorbed, 0.0, columns), system.rows - system.parameters


def conditions_of(motion: Motion, part: slice, sensor: str, axis: int) -> Conditions:
    """The conditions of the readings of one axis, in a part of the motion."""
    angle = np.where(motion.rate != 0, motion.angle, np.nan)
    rate = motion.omega[:, axis] if sensor == "gyro" else motion.rate
    each = (motion.time, angle, rate, motion.up, motion.temperature)
    return Conditions(*(values[part] for values in each))


# ---- Rows: the tests, the residuals in bins, and findings.

CAUSE = "unknown_structure"
X_UNITS = {
    "time": "s",
    "change": "s",
    "angle": "rad",
    "rate": "rad/s",
    "attitude": "rad",
    "temperature": "K",
}
SCAN_UNITS = {"time": "Hz", "change": "s", "angle": "cycles per revolution"}

NOT_NOISE = _("The residuals of the {sensors} are not noise: {description} ({p_value}).")
ALSO = _("The structure shows in {others} too.")
CARRIED = _("With {manoeuvres} left out the tests detect none.")
NO_TEMPERATURE = _(
    "The recording has no temperature that changes, so it does not show whether they go with it."
)
NOT_CARRIED = _("No small group of manoeuvres was found without which it vanishes.")
CONSEQUENCE = _(
    "No effect by name is added to the joint result of this sensor, and its sigmas do not allow "
    "for the structure."
)
MOVES = _(" With and without {manoeuvres} a parameter differs by {moves} σ at most.")
ACTION = _("Inspect the picture of the residuals for what they depend on.")
ACTION_IF_CARRIED = _(
    "Look at the picture of the residuals; record again, or leave out of the plan, {manoeuvres}."
)
DESCRIPTIONS = {  # by the kind of the test, and whether a value of a scan is known
    ("time", True): _("about {axis} they oscillate in time, every {period} s"),
    ("time", False): _("about {axis} they drift smoothly with time"),
    ("angle", True): _(
        "about {axis} they depend on the angle of the table, {value:g} times per revolution"
    ),
    ("angle", False): _("about {axis} they depend on the angle of the table"),
    ("rate", False): _("on {axis} they depend on the rate of the turns"),
    ("attitude", False): _("on {axis} they depend on the attitude"),
    ("temperature", False): _("on {axis} they depend on the temperature"),
    ("change", True): _("on {axis} they change at {value:.0f} s"),
}


def structure_rows(
    tested: Tested, reported: Mapping[str, Sequence[str]], mount: str
) -> Iterator[TableRow]:
    """The six tests, the residuals in bins where a test detects a structure, and findings.

    `reported`: of each sensor whose structure is a finding of its own, the effects with which the
    data are no more than consistent.
    """
    for test in tested.tests:
        scanned = bool(np.isfinite(test.scan_value))
        yield (
            "structures",
            {
                "mount": mount,
                "kind": test.kind,
                "sensor": test.sensor or None,
                "axis": test.axis or None,
                "scan_value": test.scan_value if scanned else None,
                "scan_unit": SCAN_UNITS[test.kind] if scanned else None,
                "statistic": test.statistic if test.possible else None,
                "degrees": test.degrees if test.possible else None,
                "p_value": test.p_value if test.possible else None,
                "detected": test.detected,
            },
        )
    for test in tested.detected:
        shared = {"mount": mount, "kind": test.kind, "sensor": test.sensor, "axis": test.axis}
        shared |= {"x_unit": X_UNITS[test.kind], "unit": UNITS[test.sensor]}
        for point in points(tested, test):
            yield "structure_points", shared | asdict(point)
    for sensor in PLURAL:
        if sensor in reported:
            yield from _finding(tested, sensor, reported[sensor], mount)


def _finding(
    tested: Tested, sensor: str, consistent: Sequence[str], mount: str
) -> Iterator[TableRow]:
    tests, carried = tested.of(sensor), carrying(tested, sensor)
    best, described = tests[0], _description(tests[0])
    sentence = [
        NOT_NOISE.format(sensors=PLURAL[sensor], description=described, p_value=p_is(best.p_value))
    ]
    if others := [_name(test) for test in tests[1:]]:
        sentence.append(ALSO.format(others=_(" and in ").join(others)))
    sentence.append(CARRIED.format(manoeuvres=listed(carried)) if carried else NOT_CARRIED)
    if best.kind in ("time", "change") and "temperature" not in tested.possible:
        sentence.append(NO_TEMPERATURE)
    action = ACTION_IF_CARRIED.format(manoeuvres=listed(carried)) if carried else ACTION
    if consistent:
        names = _(" and ").join(in_words(name) for name in consistent)
        sentence.append(ONLY_CONSISTENT.format(effects=names))
    moves = moved_by(tested.fitted.campaign, sensor, carried, tested.fitted.named)
    identifier = finding_id(f"{CAUSE}/{sensor}", mount)
    yield finding_row(
        CAUSE,
        mount,
        id=identifier,
        sensor=sensor,
        count=len(tests),
        size=best.statistic**0.5,
        unit="sigma",
        p_value=best.p_value,
        sentence=" ".join(sentence),
        consequence=consequence(carried, moves),
        action=action,
        verdict=UNKNOWN_STRUCTURE,
        statistic=best.statistic,
        degrees=best.degrees,
        moves=moves,
        snr=snr_of(best.statistic, best.degrees),
    )
    yield from member_rows(identifier, mount, consistent)
    for rank, manoeuvre in enumerate(carried, 1):
        row = {"finding": identifier, "mount": mount, "rank": rank, "manoeuvre": manoeuvre}
        yield "structure_manoeuvres", row


def consequence(carried: Sequence[str], moves: float | None) -> str:
    """What a structure does that few manoeuvres carry; `moves`: see `moved_by`."""
    if moves is None:
        return CONSEQUENCE
    return CONSEQUENCE + MOVES.format(manoeuvres=listed(carried), moves=significant(moves, 2))


def _description(test: Structure) -> str:
    """The most significant structure, in words."""
    scanned = test.scan_value > 0
    period = significant(1 / test.scan_value) if scanned else ""
    template = DESCRIPTIONS[test.kind, bool(scanned) or test.kind == "change"]
    return template.format(axis=test.axis, value=test.scan_value, period=period)


def _name(test: Structure) -> str:
    return (
        f"{'a change in time' if test.kind == 'change' else test.kind} ({test.sensor} {test.axis})"
    )
