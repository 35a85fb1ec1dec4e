"""Every finding of the earlier stages as a hypothesis about the same recording."""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import pandas as pd

from inertial.campaign.records import Row, clocks_of, rows_of
from inertial.text.messages import _
from inertial.text.units import ARC_SECOND

FOUND, ONE_OF_CLASS, UNKNOWN_STRUCTURE = "found", "one_of_class", "unknown_structure"
LAW = "law"  # of no effect of the catalogue
SENSE_OF_TURNS = "sense_of_turns"  # an asymmetry of the gyros that may be the table's
JUMP_NOT_TESTABLE = "jump_not_testable"  # a jump that only the other sensor can show
STEP_IN_TURN = "step_in_turn"  # of the angle, in one turn alone: what it means an effect tells
RECORDING, PLAN, POSITIONS, MODEL = "quality", "segment", "accelerometer", "criticism"
NOISE = "noise"
COUNTS = "gyroscope"  # the stage that finds counts of another size than stated
RIVAL = "rival"  # state of a repair that others explain as well
PLANNED = "plan"  # the stage that repairs what the campaign file states
TABLE_MOVING = "table_moving"
SLIP = "mounting_slip"  # shown by one turn, it turns the axes of all that follows
MOUNTINGS = ("mounting_shift", SLIP)  # effects that turn the axes of both sensors from then on
# Another zero of the middle axis; with the inner one upright that turns, or the outer one.
ZERO_SHIFTS = ("table_zero_shift", "table_zero_shift_outer")
# Effects by which the case is not in the attitude that is stated.
OF_ATTITUDES = frozenset(
    {
        *MOUNTINGS,
        "table_position_error",
        "table_axis_error",
        "table_axis_non_orthogonality",
        "table_inner_axis",
        *ZERO_SHIFTS,
        "table_tilt",
        "table_tilt_ramp",
        "table_tilt_jump",
        "turn_angle_error",
        "table_angle_scale",
        "tumble_eccentricity",
    }
)
CONFIRMED = _("Nothing more: the campaign file confirms it by accept: [{repair}].")
TIME = "t0"  # the parameter of effects that set in at a moment
CLEAR_SIGMAS = 3.0  # of an angle
MAX_CARRYING = 3  # manoeuvres that carry a structure of the residuals; it is elsewhere with more
CLOCK = "clock_scale"  # in ppm
MAX_UNLIKE = 0.1  # of what a clock is off by, by which logs differ
MIN_SPOILING = 2  # severity of a fault that leaves a mark on what is estimated


@dataclass(frozen=True)
class Hypothesis:
    """What would have to be true, where, how large, how sure, and what was done about it.

    `stage`: whose finding it is; `manoeuvres`: those whose records it touches, or without which
    it is not there, none where that is not known or they are many; `verdict`: of
    criticism, else empty; `members`: effects that it may be, the most probable first; `places`:
    positions or turns that an effect of a single one may be at, the likeliest first;
    `repair`: the row of the repair that undoes it, if any; `rivals`: of repairs of which each
    would, so that none is applied; `masked`: whether its records are; `time`: s since the first
    sample of all logs, with its sigma, where it is one moment; `angle`: rad, by which it turns the
    case, where it does; `share`: by which the turns go further in their time than planned, if all
    do; `alike`: whether it is a clock that is off by the same in all logs, from end to end.
    """

    id: str
    stage: str
    cause: str
    row: Row = field(repr=False)
    manoeuvres: frozenset[str] = frozenset()
    verdict: str = ""
    members: tuple[str, ...] = ()
    places: tuple[str, ...] = ()
    repair: Row | None = None
    rivals: tuple[Row, ...] = ()
    masked: bool = False
    time: tuple[float, float] | None = None
    angle: float | None = None
    share: float | None = None
    alike: bool = False

    @property
    def sensor(self) -> str | None:
        """The sensor concerned, gyro or accel; None: not one of them alone."""
        return self.row["sensor"] or None

    @property
    def axis(self) -> str | None:
        """The axis concerned, if it is one."""
        return self.row["axis"] or (self.repair["axis"] if self.repair else None) or None

    @property
    def manoeuvre(self) -> str | None:
        """The manoeuvre concerned, if it is one."""
        return self.row["manoeuvre"] or None

    @property
    def mount(self) -> str:
        """The mount concerned; empty where it is not one alone."""
        return self.row["mount"] or ""

    @property
    def named(self) -> bool:
        """Whether it is an effect that criticism names, or a class of effects."""
        return self.stage == MODEL and self.verdict in (FOUND, ONE_OF_CLASS, LAW)

    @property
    def causes(self) -> frozenset[str]:
        """What it may be."""
        return frozenset((self.cause, *self.members))

    @property
    def size(self) -> float:
        """How large it is, in its unit; 0 where that is not known."""
        return abs(float(self.row["size"] or 0.0))

    @property
    def action(self) -> str:
        """What to do; nothing more where the campaign file confirms what was set right."""
        if self.repair is not None and self.repair["state"] == "confirmed":
            return CONFIRMED.format(repair=self.repair["id"])
        return str(self.row["action"])

    @property
    def unresolved(self) -> bool:
        """Whether it is a fault that leaves a mark, and is neither masked nor set right."""
        spoils = int(self.row["severity"]) >= MIN_SPOILING and self.stage != MODEL
        return spoils and not self.masked and (self.repair is None or bool(self.rivals))


@dataclass(frozen=True, eq=False)
class Findings:
    """The tables of the stages that hand over hypotheses, as stages name them."""

    quality_findings: pd.DataFrame
    segment_findings: pd.DataFrame
    noise_findings: pd.DataFrame
    accelerometer_findings: pd.DataFrame
    gyroscope_findings: pd.DataFrame
    criticism_findings: pd.DataFrame
    members: pd.DataFrame
    cause_positions: pd.DataFrame
    structure_manoeuvres: pd.DataFrame
    plan_repairs: pd.DataFrame
    segment_repairs: pd.DataFrame
    channel_repairs: pd.DataFrame
    masks: pd.DataFrame
    gaps: pd.DataFrame
    segments: pd.DataFrame
    effects: pd.DataFrame
    clocks: pd.DataFrame

    @cached_property
    def by_stage(self) -> dict[str, list[Row]]:
        """The findings of each stage."""
        return {
            RECORDING: rows_of(self.quality_findings),
            PLAN: rows_of(self.segment_findings),
            NOISE: rows_of(self.noise_findings),
            POSITIONS: rows_of(self.accelerometer_findings),
            COUNTS: rows_of(self.gyroscope_findings),
            MODEL: rows_of(self.criticism_findings),
        }

    @cached_property
    def repairs(self) -> list[Row]:
        """What plan and segment set right."""
        return [*rows_of(self.plan_repairs), *rows_of(self.segment_repairs)]


def hypotheses(findings: Findings) -> Iterator[Hypothesis]:
    """All findings as hypotheses; a repair without a finding, such as of gravity, is one itself."""
    members: dict[str, list[str]] = {}
    for row in sorted(rows_of(findings.members), key=lambda row: row["rank"]):
        members.setdefault(row["finding"], []).append(row["effect"])
    repair_of, without = _repairs(findings)
    places: dict[str, list[str]] = {}
    for row in sorted(rows_of(findings.cause_positions), key=lambda row: row["rank"]):
        places.setdefault(row["finding"], []).append(row["position"])
    times, angles, shares = _moments(findings), _angles(findings), _shares(findings)
    touched, carrying = _touched(findings), dict[str, set[str]]()
    for row in rows_of(findings.structure_manoeuvres):
        carrying.setdefault(row["finding"], set()).add(row["manoeuvre"])
    for stage, rows in findings.by_stage.items():
        for row in rows:
            at = tuple(places.get(row["id"], ()))
            row = row | {"manoeuvre": row["manoeuvre"] or next(iter(at), None)}
            own = {row["manoeuvre"]} if row["manoeuvre"] else set()
            yield Hypothesis(
                id=row["id"],
                stage=stage,
                cause=row["cause"],
                row=row,
                manoeuvres=frozenset().union(
                    own, touched.get(row["id"], ()), carrying.get(row["id"], ())
                ),
                verdict=row.get("verdict") or "",
                members=tuple(members.get(row["id"], ())),
                places=at,
                repair=next(iter(repair_of.get(row["id"], ())), None),
                rivals=tuple(r for r in repair_of.get(row["id"], ()) if r["state"] == RIVAL),
                masked=row["id"] in touched,
                time=times.get(row["id"]),
                angle=angles.get(row["id"]),
                share=shares.get(row["id"]),
                alike=_is_alike(row, findings.clocks),
            )
    for row in without:
        cause = _CAUSE_OF_REPAIR[row["repair"]]
        yield Hypothesis(row["id"], PLANNED, cause, _as_finding(row), repair=row)


def _moments(findings: Findings) -> dict[str, tuple[float, float]]:
    """By finding its time, s since the first sample of all logs, and sigma, if it is a moment."""
    moments = {
        row["finding"]: (row["value"], row["sigma"])
        for row in rows_of(findings.effects)
        if row["finding"] and row["parameter"] == TIME and row["value"] is not None and row["sigma"]
    }
    clocks = clocks_of(findings.clocks)
    for row in (row for rows in findings.by_stage.values() for row in rows):
        if row["log"] in clocks and row["from_s"] is not None and row["to_s"] is not None:
            middle = (row["from_s"] + row["to_s"]) / 2 + clocks[row["log"]].offset
            moments.setdefault(row["id"], (middle, (row["to_s"] - row["from_s"]) / 2))
    return moments


def _angles(findings: Findings) -> dict[str, float]:
    """By finding the angle by which the case turns, rad, about the axes that show it clearly."""
    squares: dict[str, float] = {}
    for row in rows_of(findings.effects):
        if row["finding"] and row["effect"] in MOUNTINGS and row["unit"] == "rad" and row["sigma"]:
            clear = abs(row["value"]) > CLEAR_SIGMAS * row["sigma"]
            squares.setdefault(row["finding"], 0.0)
            squares[row["finding"]] += row["value"] ** 2 if clear else 0.0
    angles = {finding: square**0.5 for finding, square in squares.items() if square}
    for row in (row for rows in findings.by_stage.values() for row in rows):
        if row["cause"] in (TABLE_MOVING, STEP_IN_TURN) and row["size"] is not None:
            angles[row["id"]] = row["size"] * (ARC_SECOND if row["unit"] == "″" else 1.0)
    return angles


def _shares(findings: Findings) -> dict[str, float]:
    """By finding the share by which all turns go further in their time than planned."""
    by_plan = {
        row["id"]: row["size"] - 1
        for row in findings.by_stage[PLAN]
        if row["cause"] == "rate_off" and row["size"] is not None
    }
    by_model = {
        row["finding"]: row["value"]
        for row in rows_of(findings.effects)
        if row["finding"] and row["effect"] == "table_angle_scale" and row["value"] is not None
    }
    return by_plan | by_model


def _is_alike(row: Row, clocks: pd.DataFrame) -> bool:
    """Whether it is the clock of rates, off by as much in all logs; one of a part has no sensor."""
    if (row["cause"], row["sensor"]) != (CLOCK, "gyro"):
        return False
    intervals = clocks["interval"].dropna()
    return bool(intervals.max() / intervals.min() - 1 < MAX_UNLIKE * 1e-6 * abs(row["size"]))


def _repairs(findings: Findings) -> tuple[dict[str, list[Row]], list[Row]]:
    """The repairs by the id of the finding that they undo, and those that no finding reports.

    A repair of the plan does not have that id: it is matched by cause and sensor.
    """
    axes: dict[str, set[str]] = {}
    for row in rows_of(findings.channel_repairs):
        if row["axis"] == row["from_axis"] and row["factor"] == 1:
            continue
        axes.setdefault(row["repair"], set()).add(row["axis"])
    every = [row for rows in findings.by_stage.values() for row in rows]
    ids = {row["id"] for row in every}
    repair_of: dict[str, list[Row]] = {}
    without = []
    for row in findings.repairs:
        own = axes.get(row["id"], set())
        repair = row | {"axis": row["axis"] or (next(iter(own)) if len(own) == 1 else None)}
        cause = _CAUSE_OF_REPAIR[row["repair"]]
        alike = [f["id"] for f in every if (f["cause"], f["sensor"]) == (cause, row["sensor"])]
        if row["finding"] in ids:
            repair_of.setdefault(row["finding"], []).append(repair)
        elif alike:
            repair_of.setdefault(alike[0], []).append(repair)
        else:
            without.append(repair)
    return repair_of, without


_CAUSE_OF_REPAIR = {
    "gravity": "gravity_error",
    "axes": "axis_swap",
    "signs": "sign_flip",
    "count_size": "wrong_scale_factor",
    "sense_of_table": "wrong_direction",
    "other_way_up": "wrong_direction",
    "exchanged_manoeuvres": "manoeuvre_swapped",
    "stated_rate": "wrong_rate",
    "stated_spans": "wrong_spans",
    "stated_marks": "wrong_mark",
}


def _as_finding(repair: Row) -> Row:
    both = repair["value"] is not None and repair["stated"] is not None
    return {
        **{key: repair[key] for key in ("id", "sensor", "axis", "log", "manoeuvre", "unit")},
        "mount": "",
        "from_s": None,
        "to_s": None,
        "count": 1,
        "size": repair["stated"] - repair["value"] if both else None,
        "p_value": None,
        "severity": 3,
        "sentence": repair["sentence"],
        "consequence": "",
        "action": "",
    }


def _touched(findings: Findings) -> dict[str, set[str]]:
    """By finding the manoeuvres of which it masks or lacks records."""
    segments = findings.segments
    touched: dict[str, set[str]] = {}
    masks = findings.masks
    for log, first, after, finding in zip(
        masks["log"], masks["from_record"], masks["to_record"], masks["finding"], strict=True
    ):
        here = touched.setdefault(finding, set())
        if len(here) < len(segments):
            here |= _in(segments, log, first, after)
    lost = set[str]()
    for log, record in zip(findings.gaps["log"], findings.gaps["record"], strict=True):
        lost |= _in(segments, log, record - 1, record + 1)
    for row in findings.by_stage.get(RECORDING, ()):
        if row["cause"] == "gap":
            touched.setdefault(row["id"], set()).update(lost)
    return touched


def _in(segments: pd.DataFrame, log: str, first: int, after: int) -> set[str]:
    """The manoeuvres of a log to which some of these records belong."""
    same = (segments["log"] == log).to_numpy(bool)
    inside = (segments["from_record"].to_numpy(np.int64) < after) & (
        segments["to_record"].to_numpy(np.int64) > first
    )
    return set(segments["manoeuvre"].to_numpy(object)[same & inside])
