"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from itertools import pairwise

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.encoder import WithoutJumps
from inertial.campaign.findings import Detection, close_ups, table_of
from inertial.campaign.log_properties import Stated, records_of, stated_by
from inertial.campaign.masked_samples import Masks, RecordIndex, Repairs, read_once
from inertial.campaign.records import Manoeuvre, Performed, Row, clocks_of, manoeuvres_of, rows_of
from inertial.detectors import OF_PLAN, OF_RESTS
from inertial.sensors import COLUMNS
from inertial.signal.axis_permutations import AS_NAMED
from inertial.signal.detector import Log
from inertial.signal.plan_detector import SpansOff
from inertial.tables import CHANNEL_REPAIRS, MASKS, STATIC_PHASES
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from stages.segment import completeness, reduction, repair
from stages.segment.declared import DECLARED
from stages.segment.encoder import (
    ByEncoder,
    EncoderJumps,
    plan_by_encoder,
    with_jumps,
    without_unused,
)
from stages.segment.located import Located, begun_as_recorded
from stages.segment.matching import Part, between_parts, position_parts, rest_part, turn_parts
from stages.segment.plan_and_recording import ExaminationOfRests, Recording, compare, recorded_of
from stages.segment.repair import SetRight, set_right
from stages.segment.repair_readings import log_as_read, plan_as_taken
from stages.segment.rests_that_tilt import masked_tilts
from stages.segment.stated_spans import logs_in_doubt, moved_back, spans_off, whole_logs
from stages.segment.windows import Binned, Bins, Selection, Window, windows


@dataclass(frozen=True, eq=False)
class Examined:
    """What the stage quality says of the samples: its tables."""

    gaps: pd.DataFrame
    masks: pd.DataFrame
    channel_statistics: pd.DataFrame
    quality_findings: pd.DataFrame


@dataclass(frozen=True, eq=False)
class Confirmed:
    """The repairs of the stage plan, and those that the campaign file confirms: tables."""

    gravity_repairs: pd.DataFrame
    accepted: pd.DataFrame

    def refuse_unknown(self, found: Sequence[Row]) -> None:
        """A repair that the campaign file confirms is one that is `found`, here or by plan."""
        known = [*self.gravity_repairs["id"], *(row["id"] for row in found)]
        for row in rows_of(self.accepted):
            if row["repair"] not in known:
                raise Refusal(
                    "campaign.yaml",
                    row["place"],
                    repr(row["repair"]),
                    _(
                        "one of the repairs of this campaign: {known}",
                        known=", ".join(dict.fromkeys(known)) or _("there are none"),
                    ),
                    _("correct the name, or remove it from accept"),
                )


def segment(
    samples: Stream,
    stated: Stated,
    manoeuvres: pd.DataFrame,
    examined: Examined,
    confirmed: Confirmed,
    *,
    repairs: str = "apply",
    rest_block: float,
    turn_block: float,
    margin: float,
    angle_tolerance: float,
) -> Tables:
    """Segments, what was performed of each manoeuvre, blocks, traces, findings and close-ups.

    Two passes over the samples: blocks and the records of a rest are known only after manoeuvres
    were found in short means. Where the plan selects records by time or label, one of these two
    columns before; where the encoder jumps, or a rest tilts, blocks once more, without it.

    Parameters
    ----------
    repairs : apply or refuse, whether what is wrong for certain is set right
    """
    clock, ends = clocks_of(stated.clocks), records_of(stated.clocks)
    logs = stated.logs(examined.channel_statistics)
    plan = manoeuvres_of(manoeuvres)
    basis = repair.Basis(
        stated.earth_rate_up,
        stated.given,
        _counts(logs),
        list(ends),
        angle_tolerance,
        repairs == "refuse",
        set(confirmed.accepted["repair"]),
        stated.heading,
    )
    quanta = {name: log.quantum for name, log in logs.items()}
    made = _set_right(samples, plan, basis, stated.clocks, Masks(examined.masks), quanta)
    confirmed.refuse_unknown(made.rows)
    read_as = Repairs(CHANNEL_REPAIRS.frame(made.channels))
    masks = [*rows_of(examined.masks), *made.masks]
    masked = Masks(MASKS.frame(masks), read_as)
    by_name = {name: log_as_read(log, read_as) for name, log in logs.items()}
    places = _places(made, margin)

    by_clock = (clock, stated.means_of_known_noise, rest_block, turn_block)
    block_sums = reduction.Blocks(places.parts, examined.gaps, masked, *by_clock)
    segment_times, traces = reduction.Segments(places.parts), reduction.Traces(ends)
    known = {m.name for m in made.plan if m.up is not None}
    rests = ExaminationOfRests(OF_RESTS, places.parts, by_name, masked, known)
    index = RecordIndex()
    of_encoder = EncoderJumps(places.parts, made.plan, stated.angle_sigma)
    read_once(samples, [block_sums, segment_times, traces, rests, index, of_encoder.sums], read_as)
    blocks, jumps = block_sums.table(), of_encoder.result()
    of_rests, tilts = masked_tilts(list(rests.detections("segment")), blocks, made.plan)
    if jumps or tilts:
        masks += tilts
        masked = Masks(MASKS.frame(masks), read_as)
        block_sums = reduction.Blocks(places.parts, examined.gaps, masked, *by_clock)
        read_once(samples, [WithoutJumps(block_sums, of_encoder.by_log())], read_as)
        blocks = block_sums.table()
    segments = segment_times.table()
    by_encoder = plan_by_encoder(made.plan, blocks, stated.angle_sigma, angle_tolerance)
    by_encoder = with_jumps(by_encoder, jumps)
    turned, by_encoder = _turned(
        places.turns, by_encoder, blocks, block_sums, examined.gaps, made.level, angle_tolerance
    )
    plan = [by_encoder[m.name].manoeuvre if m.name in by_encoder else m for m in made.plan]
    plan = begun_as_recorded(plan, made.explained.located)
    performed = _performed(plan, places.performed | turned, block_sums, made)
    recorded = recorded_of(
        plan,
        made.explained,
        made.undone,
        Recording(
            performed,
            segments,
            blocks,
            _counts(by_name)["gyro"],
            {m.name: m.angle for m in made.plan},
            stated.angle_sigma,
            stated.rate_sigma,
            jumps,
        ),
        stated.given,
        angle_tolerance,
    )
    of_plan = compare("segment", OF_PLAN, recorded)
    detections = [*(each for each, _by in of_plan), *of_rests]
    return {
        "manoeuvres": plan_as_taken(manoeuvres, plan),
        "repairs": list(_with_findings(made.rows, of_plan, examined.quality_findings)),
        "channel_repairs": list(made.channels),
        "segments": segments,
        "performed": pd.DataFrame([asdict(performed[m.name]) for m in plan]),
        "blocks": reduction.with_temperatures(without_unused(blocks, by_encoder), plan),
        "masks": _masks(masks, of_plan),
        "traces": traces.table(),
        "findings": table_of([each.finding for each in detections]),
        "close_ups": close_ups(samples, index, detections),
    }


def _set_right(
    samples: Stream,
    plan: Sequence[Manoeuvre],
    basis: repair.Basis,
    clocks: pd.DataFrame,
    masks: Masks,
    quanta: Mapping[str, Array],
) -> SetRight:
    """The campaign with its repairs, from short means over the windows of its plan.

    Where the stated spans of a log hold hardly a manoeuvre, over all of that log as well.
    """
    by_log, ends = clocks_of(clocks), records_of(clocks)

    def binned(of: Sequence[Window]) -> list[Binned]:
        bins = Bins(of, by_log, masks, quanta)
        read_once(samples, [bins])
        return list(bins.binned())

    cut = binned(_windows(samples, plan, ends))
    off: list[SpansOff] = []
    if doubtful := logs_in_doubt(cut, plan, basis.earth_rate):
        off = list(spans_off(binned(whole_logs(plan, ends, doubtful)), basis.earth_rate))
    if off and not basis.refused:
        plan = moved_back(plan, off)
        cut = binned(_windows(samples, plan, ends))
    return set_right(cut, plan, basis, off)


def _windows(samples: Stream, plan: Sequence[Manoeuvre], ends: Mapping[str, int]) -> list[Window]:
    """The parts of logs in which manoeuvres are sought."""
    selection = Selection(plan)
    if selection.manoeuvres:
        read_once(samples, [selection])
    return windows(plan, ends, selection)


BESIDE_SOAK = 10.0  # s, of the rest beside a turn that still has the temperature of the turn


@dataclass(frozen=True)
class _Places:
    """The phases of all manoeuvres; what was performed of those that do not turn; the turns."""

    parts: list[Part]
    performed: dict[str, Performed]
    turns: list[tuple[Located, int, Manoeuvre]]


def _places(made: SetRight, margin: float) -> _Places:
    parts: list[Part] = []
    turns: list[tuple[Located, int, Manoeuvre]] = []
    performed: dict[str, Performed] = dict(completeness.left_out(made.explained, made.plan))
    for located in made.explained.located:
        binned, stretches, matched = located.binned, located.stretches, located.matched
        first = len(parts)
        beside = _beside_soaks(located.plan)
        for m in located.plan:
            place = matched.get(m.name)
            if m.name in performed:
                continue
            if m.do == "positions":
                own = list(position_parts(binned, stretches, m, matched, margin))
                parts += own
                performed[m.name] = completeness.positions(m, len(own))
            elif place is None:
                performed[m.name] = completeness.not_found(m)
            elif m.do == "rest":
                parts.append(rest_part(binned, stretches[place], m.name, margin))
                performed[m.name] = completeness.rest(binned, m, stretches[place])
            else:
                longest = beside.get(m.name, (np.inf, np.inf))
                parts += turn_parts(binned, stretches, m, matched, made.level, margin, longest)
                turns.append((located, place, m))
        if any(m.do == "positions" for m in located.plan):
            parts += between_parts([p for p in parts[first:] if p.phase in STATIC_PHASES])
    return _Places(parts, performed, turns)


def _beside_soaks(plan: Sequence[Manoeuvre]) -> dict[str, tuple[float, float]]:
    """The longest rests before and after turns between which another temperature is stated, s.

    Of the time between the two, in which the temperature changes, neither has more than is near it.
    """
    before = dict.fromkeys((m.name for m in plan), np.inf)
    after = dict(before)
    for one, other in pairwise(plan):
        if (
            None not in (one.temperature, other.temperature)
            and one.temperature != other.temperature
        ):
            after[one.name] = before[other.name] = BESIDE_SOAK
    return {name: (before[name], after[name]) for name in before}


def _turned(
    turns: Sequence[tuple[Located, int, Manoeuvre]],
    by_encoder: Mapping[str, ByEncoder],
    blocks: pd.DataFrame,
    sums: reduction.Blocks,
    gaps: pd.DataFrame,
    level: Array,
    tolerance: float,
) -> tuple[dict[str, Performed], dict[str, ByEncoder]]:
    """What was performed of the turns, and what the encoder gives of each."""
    in_motion = dict(list(blocks[~blocks["phase"].isin(STATIC_PHASES)].groupby("manoeuvre")))
    performed, told_of = {}, dict(by_encoder)
    for located, place, stated in turns:
        told = told_of.get(stated.name, ByEncoder(stated))
        clipped = sums.clipped(stated.name).get("", np.zeros(6, bool))[3:]
        own = in_motion.get(stated.name, blocks.iloc[:0])
        given = (own, gaps, level, tolerance, clipped)
        done = completeness.turn(located, place, told.manoeuvre, *given)
        if done.complete and told.on_record is not None:
            told = told.from_rest_to_rest
            done = completeness.turn(located, place, told.manoeuvre, *given)
        if located.axes.gyro != AS_NAMED:
            done, told = completeness.by_other_axes(done), replace(told, used=False)
        told_of[stated.name] = told
        performed[stated.name] = replace(done, sentence=f"{done.sentence} {told.remark}".rstrip())
    return performed, told_of


def _performed(
    plan: Sequence[Manoeuvre],
    performed: Mapping[str, Performed],
    sums: reduction.Blocks,
    made: SetRight,
) -> dict[str, Performed]:
    """The same with what is cut off in each manoeuvre, and how the IMU moved between them."""
    done = {
        m.name: completeness.with_clipped(performed[m.name], sums.clipped(m.name)) for m in plan
    }
    for located in made.explained.located:
        for each in completeness.with_ways(done, located, made.level):
            done[each.manoeuvre] = each
    return done


def _masks(rows: Sequence[Row], of_plan: Sequence[tuple[Detection, str]]) -> pd.DataFrame:
    """Those of the stage quality, and of the readings that no repair sets right, by finding."""
    told = {by: each.finding.id for each, by in of_plan if by}
    return MASKS.frame(
        [row | {"finding": told.get(row["finding"], row["finding"])} for row in rows]
    )


def _with_findings(
    rows: Sequence[Row], of_plan: Sequence[tuple[Detection, str]], of_quality: pd.DataFrame
) -> Iterator[Row]:
    """The repairs, each with the finding that tells of it."""
    told = {by: each.finding.id for each, by in of_plan if by}
    of_counts = of_quality[of_quality["cause"] == "wrong_scale_factor"]
    for row in rows:
        finding = told.get(row["finding"])
        if row["repair"] == "count_size" and finding is None:
            same = of_counts[(of_counts["sensor"] == row["sensor"])]
            finding = next(iter(same["id"]), None)
        yield row | {"finding": finding}


def _counts(logs: Mapping[str, Log]) -> dict[str, dict[str, float]]:
    """By sensor and log, what a count is by the campaign, m/s and rad, where it is an increment."""
    return {
        sensor: {
            name: float(np.nanmedian(log.count[channels])) * log.interval
            for name, log in logs.items()
            if log.increments and np.isfinite(log.count[channels]).any()
        }
        for sensor, channels in COLUMNS.items()
    }


STAGE = Stage(
    segment, DECLARED, gathers={"stated": stated_by, "examined": Examined, "confirmed": Confirmed}
)
