"""The rows of the causes: what each is, its cure, its gain, and by how much it moves the result."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.explanations import PER_RUN, PERIODIC, has_own_error, is_of_wrong_place
from inertial.campaign.hypotheses import (
    COUNTS,
    FOUND,
    JUMP_NOT_TESTABLE,
    LAW,
    MIN_SPOILING,
    MODEL,
    MOUNTINGS,
    OF_ATTITUDES,
    ONE_OF_CLASS,
    RECORDING,
    SENSE_OF_TURNS,
    UNKNOWN_STRUCTURE,
    Hypothesis,
)
from inertial.campaign.records import Performed, Row
from inertial.campaign.unknown_attitude import MOVED
from inertial.campaign.where_causes_act import shows_wrong_stamps
from inertial.effects import LAWS
from inertial.sensors import PLURAL
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed, plural
from inertial.text.parameters import MIXTURE
from stages.diagnosis.cause_sentences import (
    ALONE,
    BY_MEMBERS,
    BY_MEMBERS_AND_WITHOUT,
    HARMLESS,
    IN_COVARIANCE,
    NO_ATTITUDE,
    NO_JUMP,
    OF_EACH_MANOEUVRE,
    OF_GYROS,
    ONE_CHANGE,
    ONLY_MODELLED,
    OWN_ERROR,
    STAMPS_RIGHT,
    STAMPS_WRONG,
    TURN_AGAIN,
    WITH_AND_WITHOUT,
    WITHOUT_STAMPS,
)
from stages.diagnosis.decision import MAX_MOVE, UNEXPLAINED
from stages.diagnosis.gravity_by_latitude import Gravity
from stages.diagnosis.sensor_results import SensorResult
from stages.diagnosis.sizes_of_causes import (
    CLOCK,
    MAX_HARMLESS_MOVE,
    Size,
    gain_of,
    most_moved_by,
    moved_by,
    moved_by_measure,
    moved_by_runs,
    moved_by_turning,
    turns_of,
)

MIN_MOVE = 0.01  # sigma: less is nothing
REPAIRED, MODELLED, CURVE, MASKED = "repaired", "modelled", "curve", "masked"
INTERPOLATED, LEFT_OUT, NONE = "interpolated", "left_out", "none"
APPLIED = ("applied", "confirmed")  # states of a repair that the blocks were made with
GOOD_TO_KNOW, SPOILS = 1, 3  # severity of a finding
ENCODER_JUMP, QUANTISATION = "encoder_jump", "quantisation"  # the former segment takes out
SWAPPED = "manoeuvre_swapped"
DIFFERENT_THINGS = ("manoeuvre_missing", SWAPPED)  # each is one of its own

DONE = {
    REPAIRED: _("It was set right before anything was estimated."),
    MODELLED: _("It is in the model of the result, estimated with the parameters."),
    CURVE: _("The result gives it as a curve of the temperature, with its sigma."),
    MASKED: _("The readings are masked; nothing is estimated from them."),
    INTERPOLATED: _("What is missing is interpolated from the steady rate before and after."),
    LEFT_OUT: _("The manoeuvres concerned are left out of the estimates."),
    NONE: _("Nothing was done about it."),
}


@dataclass(frozen=True)
class Cause:
    """A cause, or equal ones, with their consequences, and what was done about it.

    `moves`: largest shift of a parameter of the result that it causes or, undone, caused, in its
    sigma; None where it is not known. `sensors`: gyro, accel, those whose result it concerns;
    `modelled`: those of them whose result has it in its model; `freed`: the manoeuvre whose own
    error it is there, or that is left out for it; `turns`: by how many sigma one of its class turns
    a sensor's axes; `spoilt`: by how many sigma it moves the result of a sensor; `restored`: on
    which condition it does not: that the gravity to which that result is referred is right, or that
    attitudes are; `doubted`: the sensors that attitudes would move if they were what is wrong;
    `saturated`: whether these effects have a term for nearly every manoeuvre, so that none is sure.
    """

    members: tuple[ExplainedFindings, ...]
    sensors: tuple[str, ...]
    cure: str
    done: str
    moves: float | None
    held_out_drop: float | None = None
    gain: str | None = None
    modelled: frozenset[str] = frozenset()
    freed: str | None = None
    turns: Mapping[str, float] = field(default_factory=dict)
    spoilt: Mapping[str, float] = field(default_factory=dict)
    restored: str | None = None
    most_moved: str = ""
    doubted: frozenset[str] = frozenset()
    saturated: bool = False

    def of(self, sensor: str) -> Cause:
        """What it is for the result of one sensor, with its consequences there."""
        members = tuple(
            replace(member, consequences=tuple(_of_sensor(member.consequences, sensor)))
            for member in self.members
        )
        if sensor in self.spoilt:
            cure = REPAIRED if self.restored else NONE
            return replace(self, members=members, cure=cure, moves=self.spoilt[sensor])
        if sensor in self.doubted:
            return replace(self, members=members, restored=NO_ATTITUDE)
        cure = MODELLED if sensor in self.modelled else self.cure
        moves = max(filter(None, (self.moves, self.turns.get(sensor))), default=self.moves)
        return replace(self, members=members, cure=cure, moves=moves, restored=None)

    @property
    def main(self) -> Hypothesis:
        """The largest of the equal ones, which represents all."""
        return max(
            (member.cause for member in self.members),
            key=lambda h: (h.row["severity"], abs(h.row["size"] or 0.0)),
        )

    @property
    def manoeuvre(self) -> str | None:
        """The manoeuvre concerned, if it is one."""
        return self.main.manoeuvre or self.freed

    @property
    def id(self) -> str:
        """Its identifier."""
        return f"diagnosis/{self.main.id}"

    @property
    def verdict(self) -> str:
        """How sure its name is."""
        law = self.main.verdict == LAW and self.cure != MODELLED
        if law or self.saturated:  # other manoeuvres do not confirm it
            return UNKNOWN_STRUCTURE
        if self.main.stage == MODEL:
            return self.main.verdict or UNKNOWN_STRUCTURE
        return ONE_OF_CLASS if self.main.rivals else FOUND

    @property
    def condition(self) -> str | None:
        """What must be true for the result to be right, where nobody has confirmed it."""
        if self.restored:
            return self.restored
        if self.cure == LEFT_OUT and self.main.stage == MODEL:
            return ALONE.format(manoeuvre=self.manoeuvre)
        if self.main.cause == SENSE_OF_TURNS:
            return OF_GYROS
        if self.main.cause == JUMP_NOT_TESTABLE:
            return NO_JUMP.format(sensors=PLURAL[self.sensors[0]])
        if self._once_or_in_each_run:
            return ONE_CHANGE.format(sensors=PLURAL[self.sensors[0]])
        of_gyros = (self.main.cause, self.main.sensor) == (CLOCK, "gyro")
        if of_gyros and (self.moves or 0) > MAX_MOVE and not self._stamps_wrong:
            return STAMPS_RIGHT
        repair = self.main.repair
        return repair["condition"] if repair is not None and repair["state"] == "applied" else None

    @property
    def _once_or_in_each_run(self) -> bool:
        """Whether the model has a bias that changes once, which may as well do so in each run."""
        each = any(name in self.main.causes for name in PER_RUN)
        return self.cure == MODELLED and each and self.main.cause not in PER_RUN

    @property
    def _stamps_wrong(self) -> bool:
        """Whether turns show that it is the stamps that are off, and not the rate of samples."""
        return any(shows_wrong_stamps(m.cause, o) for m in self.members for o in m.consequences)

    @property
    def spoils(self) -> bool:
        """Whether it is not removed and moves a parameter by more than its sigma, or may do so."""
        if self.cure != NONE or self.condition:
            return False
        if self.moves is not None:
            return self.moves > MAX_MOVE
        left = {each.cause for member in self.members for each in member.consequences}
        structured = UNKNOWN_STRUCTURE in {self.verdict, *left}
        return structured or int(self.main.row["severity"]) >= SPOILS

    @property
    def name(self) -> str:
        """The cause in a few words, with its class and its place."""
        if self.saturated:
            return in_words(UNKNOWN_STRUCTURE)
        names = [in_words(name) for name in self.main.members] or list(
            dict.fromkeys(_of_rival(row) for row in self.main.rivals)
        )
        of_both = self.verdict == FOUND and self.main.stage == MODEL and len(names) > 1
        if of_both and self.main.sensor is None:
            words = _(" and ").join(names)
        else:
            names = names if self.verdict == ONE_OF_CLASS else []
            words = _(" or ").join(names or [in_words(self.main.cause)])
        axis = None if self.main.cause in LAWS else self.main.axis  # whose names hold it
        place = _(" or ").join(self.main.places) or self.manoeuvre
        words += _(" of the {axis} axis", axis=axis) if axis and self._one("axis") else ""
        return words + (_(" ({place})", place=place) if place else "")

    def _one(self, place: str) -> bool:
        return len({getattr(member.cause, place) for member in self.members}) == 1

    @property
    def _moves_nothing(self) -> bool:
        """Whether it is an effect of which the result is free, in the model or not."""
        return self.main.stage == MODEL and self.moves is not None and self.moves < MIN_MOVE

    def row(self, sizes: Mapping[str, Size], sentences: Mapping[str, str]) -> Row:
        """Its row; `sizes`, `sentences`: of effects, by the finding that names them."""
        main, repair = self.main, self.main.repair
        size = sizes.get(main.id, Size(main.row["size"], None, main.row["unit"]))
        count = sum(int(member.cause.row["count"]) for member in self.members)
        sentence = sentences.get(main.id, main.row["sentence"])
        if self.saturated:
            names = dict.fromkeys(in_words(member.cause.cause) for member in self.members)
            sentence = OF_EACH_MANOEUVRE.format(
                sensors=PLURAL[main.sensor or "gyro"], effects=listed([*names])
            )
        elif len(self.members) > 1 and int(main.row["count"]) > 1:  # its sentence says which it is
            sentence += " " + _("In all there are {count} of them.", count=count)
        elif len(self.members) > 1:
            sentence += " " + plural(
                "There is {count} of them; the largest is described.",
                "There are {count} of them; the largest is described.",
                count,
            )
        stamps = self._stamps_wrong
        return {
            "id": self.id,
            "cause": UNKNOWN_STRUCTURE if self.saturated else main.cause,
            "verdict": self.verdict,
            "mount": main.mount,
            "sensor": main.sensor,
            "axis": (main.axis if self._one("axis") else None) or size.axis,
            "log": main.row["log"] if len(self.members) == 1 else None,
            "manoeuvre": self.manoeuvre if self._one("manoeuvre") else None,
            "count": count,
            "sentence": f"{sentence} {STAMPS_WRONG}" if stamps else sentence,
            "size": size.value,
            "sigma": size.sigma,
            "unit": size.unit,
            "snr": main.row.get("snr"),
            "p_value": main.row["p_value"],
            "cure": self.cure,
            "gain": self.gain,
            "fitting_before": repair["fitting_before"] if repair else None,
            "fitting_after": repair["fitting_after"] if repair else None,
            "held_out_drop": self.held_out_drop,
            "moves": self.moves,
            "condition": self.condition,
            "consequence": "" if self._moves_nothing else self.most_moved + main.row["consequence"],
            "done": self.done,
            "action": TURN_AGAIN if self.saturated else WITHOUT_STAMPS if stamps else main.action,
        }


def _of_rival(repair: Row) -> str:
    """A repair of which others explain as much, in a few words."""
    name = in_words(repair["repair"])
    sensor = repair["sensor"]
    return _("{name} of the {sensors}", name=name, sensors=PLURAL[sensor]) if sensor else name


@dataclass(frozen=True)
class Evidence:
    """What the cures and gains of causes are read from.

    `results`: by sensor and mount; `walks`: ids of findings about random walks, which the
    covariance includes; `performed`: by the name of the manoeuvre; `curves`: sensors and mounts
    whose changes with temperature are known as curves, without their levels; `gravity`: by finding
    of a wrong latitude the one to which the accelerometers are referred.
    """

    results: Mapping[tuple[str, str], SensorResult]
    walks: frozenset[str]
    performed: Mapping[str, Performed]
    curves: frozenset[tuple[str, str]] = frozenset()
    gravity: Mapping[str, Gravity] = field(default_factory=dict)

    def causes(self, explained: Sequence[ExplainedFindings]) -> list[Cause]:
        """Every cause once: equal faults of one sensor, and lines of one turn, are one."""
        groups: dict[Any, list[ExplainedFindings]] = {}
        saturated = set[str]().union(*(r.decision.saturated for r in self.results.values()))
        for number, each in enumerate(explained):
            cause, alike = each.cause, (each.cause.cause, each.cause.mount, each.cause.sensor)
            lines = cause.cause in PERIODIC and cause.manoeuvre  # of one turn: the spectrum of it
            alone = cause.stage == MODEL or cause.cause in DIFFERENT_THINGS or cause.repair
            key: Any = number if alone and not lines else (*alike, cause.masked, lines)
            if cause.id in saturated:
                key = cause.mount, cause.sensor
            groups.setdefault(key, []).append(each)
        return [self._cause(tuple(group)) for group in groups.values()]

    def _cause(self, members: tuple[ExplainedFindings, ...]) -> Cause:
        main = max(members, key=lambda m: m.cause.row["severity"]).cause
        saturated = any(main.id in result.decision.saturated for result in self.results.values())
        own = list(self._own(main))
        cure, moves, drop = self._cure(main, own, members)
        if saturated:
            each = (self._cure(m.cause, [*self._own(m.cause)], (m,))[1] for m in members)
            moves = max((move for move in each if move is not None), default=None)
        apart = [{**result.decision.freed, **result.decision.left_out} for result in own]
        freed = next(filter(None, (manoeuvres.get(main.id) for manoeuvres in apart)), None)
        modelled = frozenset(r.sensor for r in own if main.stage == MODEL and r.models(main.causes))
        done = main.repair["sentence"] if cure == REPAIRED and main.repair else DONE[cure]
        done = (mean := _mean_of(main, own) if cure == MODELLED else "") or done
        if main.id in self.walks or _rounds(main):
            done = IN_COVARIANCE
        elif cure == NONE and (moves is not None and moves < MAX_HARMLESS_MOVE):
            done = HARMLESS
        elif (
            not mean
            and cure != LEFT_OUT
            and (freed := freed or (main.manoeuvre if has_own_error(main) else None))
        ):
            done = OWN_ERROR.format(manoeuvre=freed)
        elif cure == NONE and modelled:
            done = ONLY_MODELLED.format(sensors=_(" and ").join(PLURAL[s] for s in modelled))
        spoilt = self._by_gravity_of_wrong_place(members)
        doubted = self._doubted(main, moves)
        sensors = tuple(dict.fromkeys([*(result.sensor for result in own), *spoilt, *doubted]))
        gain, turns = gain_of(main, drop, own), {} if freed else turns_of(main, own)
        given = (members, sensors, cure, done, moves, drop, gain, modelled, freed, turns, spoilt)
        condition = self.gravity[main.id].condition if main.id in self.gravity else None
        return Cause(*given, condition, most_moved_by(main, moves, own), doubted, saturated)

    def _doubted(self, cause: Hypothesis, moves: float | None) -> frozenset[str]:
        """The gyros, where a structure of the accelerometers may be of attitudes that are wrong.

        `moves`: by how many sigma it shifts the accelerometers. Their cross-axis terms tell how
        large an angle that is.
        """
        if cause.verdict != UNKNOWN_STRUCTURE or cause.sensor != "accel":
            return frozenset()
        own = {s: r for (s, mount), r in self.results.items() if mount == cause.mount}
        if cause.causes.isdisjoint(OF_ATTITUDES) or not {"gyro", "accel"} <= own.keys():
            return frozenset()
        accel, gyro = (own[sensor].cross_sigma for sensor in ("accel", "gyro"))
        if not gyro or (moves is not None and accel and moves * accel <= MAX_MOVE * gyro):
            return frozenset()
        return frozenset({"gyro"})

    def _by_gravity_of_wrong_place(self, members: Sequence[ExplainedFindings]) -> dict[str, float]:
        """By how many sigma the gravity of a latitude that is wrong moves the accelerometers."""
        if members[0].cause.id in self.gravity:
            return {"accel": self.gravity[members[0].cause.id].moved}
        own = [result for (sensor, _), result in self.results.items() if sensor == "accel"]
        repairs = [
            other.repair
            for member in members
            for other in member.consequences
            if other.repair is not None and is_of_wrong_place(member.cause, other)
        ]
        moved = [by for repair in repairs if (by := moved_by(repair, own)) is not None]
        return {"accel": max(moved)} if moved else {}

    def _own(self, cause: Hypothesis) -> Iterator[SensorResult]:
        """The results that a cause concerns: of its sensor, and where the model has its effect."""
        for (sensor, mount), result in self.results.items():
            if cause.mount and mount and cause.mount != mount:
                continue
            if self._in_turns(cause) and sensor == "accel":
                continue  # no mean of theirs is of a turn
            of_both = cause.sensor is None or _may_be_shift(cause)
            of_both = of_both or sensor in {rival["sensor"] for rival in cause.rivals}
            of_both = of_both or any(name.startswith(sensor) for name in cause.causes & {*PER_RUN})
            if of_both or cause.sensor == sensor or cause.causes & result.effects.keys():
                yield result

    def _in_turns(self, cause: Hypothesis) -> bool:
        """Whether it is a fault of the recording that touches turns alone."""
        done = [self.performed[name] for name in cause.manoeuvres if name in self.performed]
        return cause.stage == RECORDING and bool(done) and all(each.rate for each in done)

    def _cure(
        self, cause: Hypothesis, own: Sequence[SensorResult], members: Sequence[ExplainedFindings]
    ) -> tuple[str, float | None, float | None]:
        """The cure, the largest shift of a parameter in sigma, and the gain on held-out data."""
        if cause.cause == ENCODER_JUMP or cause.repair is not None:
            repaired = _cure_of_repaired(cause.repair, own)
            there = self.performed.get(cause.manoeuvre or "")
            lost = cause.cause == SWAPPED and there is not None and not there.complete
            return (LEFT_OUT, None, None) if repaired[0] == NONE and lost else repaired
        if cause.row.get("predictor") == "temperature" and self.curves & {
            (result.sensor, result.mount) for result in own
        }:
            return CURVE, None, None
        if cause.cause in PER_RUN and cause.row["unit"] != "sigma":  # no scatter stands for it
            return NONE, moved_by_runs(cause.row["size"], own), None
        if cause.stage == MODEL:
            return self._cure_of_effect(cause, own)
        if (moves := moved_by_measure(cause, own)) is not None:
            return NONE, moves, None
        in_matrix = cause.stage == COUNTS and int(cause.row["severity"]) < SPOILS
        if in_matrix or has_own_error(cause) or _rounds(cause):  # or in the covariance
            left_out = cause.manoeuvre and (in_matrix or cause.cause == MOVED)
            return LEFT_OUT if left_out else MODELLED, None, None
        touched = frozenset().union(*(member.cause.manoeuvres for member in members))
        done = [self.performed[name] for name in touched if name in self.performed]
        if cause.cause == "gap":
            cure = _cure_of_gap(done)
            return cure, 0.0 if cure == NONE else None, None
        if cause.masked:
            return MASKED, None, None
        if int(cause.row["severity"]) == GOOD_TO_KNOW:
            return NONE, 0.0, None
        incomplete = bool(done) and not any(each.complete or each.bridged for each in done)
        return LEFT_OUT if incomplete else NONE, None, None

    def _cure_of_effect(
        self, cause: Hypothesis, own: Sequence[SensorResult]
    ) -> tuple[str, float | None, float | None]:
        if cause.id in self.walks:
            return MODELLED, None, None
        if cause.cause == UNEXPLAINED and all(result.decision.widened > 1 for result in own):
            return MODELLED, None, None
        if any(cause.id in result.decision.left_out for result in own):
            return LEFT_OUT, cause.row["moves"], None
        modelled = [result for result in own if result.models(cause.causes)]
        others = [result for result in own if result not in modelled]
        freed = any(cause.id in result.decision.freed for result in modelled)
        turned = cause.cause in MOUNTINGS and not freed
        kept = others if turned else [each for each in others if each.shows(cause.causes)]
        moves = [move for result in kept or own if (move := result.moves(cause.causes)) is not None]
        if cause.row.get("moves") is not None:
            moves.append(float(cause.row["moves"]))
        if turned:
            moves += moved_by_turning(modelled, others)
        drops = [result.drop for result in modelled if result.drop is not None]
        largest = max(moves, default=None)
        if modelled and not kept:
            return MODELLED, largest, max(drops, default=None)
        if kept and not turned and all(result.covers_misfit for result in kept):
            # What manoeuvres differ by is in the sigmas, so the shift is measured in these.
            return (MODELLED if modelled else NONE), largest, max(drops, default=None)
        return NONE, largest, None


def _cure_of_repaired(
    repair: Row | None, own: Sequence[SensorResult]
) -> tuple[str, float | None, None]:
    """Of what a repair sets right, if it is applied; without one it always is."""
    applied = repair is None or repair["state"] in APPLIED
    return REPAIRED if applied else NONE, moved_by(repair, own) if repair else None, None


def _cure_of_gap(touched: Sequence[Performed]) -> str:
    """The cure of a gap in these manoeuvres; a rest, or a pause between two, needs none."""
    if not all(each.complete or each.bridged for each in touched):
        return LEFT_OUT
    return INTERPOLATED if any(each.rate for each in touched) else NONE


def _may_be_shift(cause: Hypothesis) -> bool:
    """Whether it is a shift in the fixture, or one of a class with it.

    What the residuals of one sensor are no more than consistent with, those of the other are
    tested for themselves.
    """
    return not cause.causes.isdisjoint(MOUNTINGS) and cause.cause != UNKNOWN_STRUCTURE


def _rounds(cause: Hypothesis) -> bool:
    """Whether it is counts that are so coarse that means are off by their rounding."""
    return cause.cause == QUANTISATION and int(cause.row["severity"]) >= MIN_SPOILING


def _of_sensor(findings: Sequence[Hypothesis], sensor: str) -> Iterator[Hypothesis]:
    return (each for each in findings if each.sensor in (None, sensor))


def _mean_of(cause: Hypothesis, own: Sequence[SensorResult]) -> str:
    """What the parameters are a mean over, as a sentence; "" where they are of one fit."""
    means = [result for result in own if result.chosen.method == MIXTURE]
    without = any(result.decision.joint_share and result.models(cause.causes) for result in means)
    if means and (cause.verdict == ONE_OF_CLASS or len(cause.places) > 1):
        return BY_MEMBERS_AND_WITHOUT if without else BY_MEMBERS
    return WITH_AND_WITHOUT if without else ""
