"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, replace

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from inertial.campaign.close_ups import close_ups
from inertial.campaign.findings import Detection, table_of
from inertial.campaign.log_properties import Stated, records_of, stated_by
from inertial.campaign.masked_samples import Masks, RecordIndex, Repairs, read_once
from inertial.campaign.records import Manoeuvre, Performed, Row, clocks_of, manoeuvres_of, rows_of
from inertial.detectors import OF_PLAN, OF_RESTS
from inertial.signal.detector import SENSORS, Log
from inertial.tables import CHANNEL_REPAIRS, STATIC_PHASES
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Stream
from inertial.tables.stage import Stage, Tables
from inertial.text.messages import _
from stages.segment import completeness, reduction, repair
from stages.segment.declared import DECLARED
from stages.segment.detection import ExaminationOfRests, compare, recorded_of
from stages.segment.encoder import ByEncoder, plan_by_encoder, without_unused
from stages.segment.explanations import Explained
from stages.segment.matching import (
    AS_NAMED,
    Located,
    Part,
    between_parts,
    position_parts,
    rest_part,
    turn_parts,
)
from stages.segment.repair import set_right
from stages.segment.repair_readings import log_as_read, plan_as_taken
from stages.segment.windows import Bins, Selection, Window, windows

Array = NDArray[np.float64]


def segment(
    samples: Stream,
    stated: Stated,
    manoeuvres: pd.DataFrame,
    clocks: pd.DataFrame,
    gaps: pd.DataFrame,
    masks: pd.DataFrame,
    channel_statistics: pd.DataFrame,
    quality_findings: pd.DataFrame,
    gravity_repairs: pd.DataFrame,
    accepted: pd.DataFrame,
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
    columns before.

    Parameters
    ----------
    repairs : apply or refuse, whether what is wrong for certain is set right
    """
    plan, clock = manoeuvres_of(manoeuvres), clocks_of(clocks)
    logs = stated.logs(channel_statistics)
    ends = records_of(clocks)

    bins = Bins(_windows(samples, plan, ends), clock, Masks(masks))
    read_once(samples, [bins])
    made = set_right(
        list(bins.binned()),
        plan,
        repair.Stated(
            stated.earth_rate_up,
            stated.given,
            _counts(logs),
            list(ends),
            angle_tolerance,
            repairs == "refuse",
            set(accepted["repair"]),
        ),
    )
    _refuse_unknown(accepted, [*gravity_repairs["id"], *(row["id"] for row in made.rows)])
    plan, level, explained = list(made.plan), made.level, made.explained
    read_as = Repairs(CHANNEL_REPAIRS.frame(made.channels))
    masked = Masks(masks, read_as)
    by_name = {name: log_as_read(log, read_as) for name, log in logs.items()}
    parts, performed, turns = _parts(explained, plan, level, margin)

    in_samples = stated.means_of_known_noise
    block_sums = reduction.Blocks(
        parts,
        gaps,
        masked,
        clock,
        in_samples,
        rest_block,
        turn_block,
    )
    segment_times, traces = reduction.Segments(parts), reduction.Traces(ends)
    rests, index = ExaminationOfRests(OF_RESTS, parts, by_name, masked), RecordIndex()
    read_once(samples, [block_sums, segment_times, traces, rests, index], read_as)
    blocks, segments = block_sums.table(), segment_times.table()
    turned = plan_by_encoder(plan, blocks, stated.angle_sigma, angle_tolerance)
    plan = [turned[m.name].manoeuvre if m.name in turned else m for m in plan]
    done, turned = _turned(turns, turned, blocks, block_sums, gaps, level, angle_tolerance)
    performed |= done
    for m in plan:
        performed[m.name] = completeness.with_clipped(performed[m.name], block_sums.clipped(m.name))
    for located in explained.located:
        performed |= {
            done.manoeuvre: done for done in completeness.with_ways(performed, located, level)
        }
    recorded = recorded_of(
        plan,
        explained,
        made.undone,
        performed,
        segments,
        blocks,
        _counts(by_name)["gyro"],
        stated.given,
        angle_tolerance,
    )
    of_plan = compare("segment", OF_PLAN, recorded)
    detections = [*(each for each, _by in of_plan), *rests.detections("segment")]
    return {
        "manoeuvres": plan_as_taken(manoeuvres, plan),
        "repairs": list(_with_findings(made.rows, of_plan, quality_findings)),
        "channel_repairs": list(made.channels),
        "segments": segments,
        "performed": pd.DataFrame([asdict(performed[m.name]) for m in plan]),
        "blocks": reduction.with_temperatures(without_unused(blocks, turned), plan),
        "traces": traces.table(),
        "findings": table_of([each.finding for each in detections]),
        "close_ups": close_ups(samples, index, detections),
    }


def _windows(samples: Stream, plan: Sequence[Manoeuvre], ends: Mapping[str, int]) -> list[Window]:
    """The parts of logs in which manoeuvres are sought."""
    selection = Selection(plan)
    if selection.manoeuvres:
        read_once(samples, [selection])
    return windows(plan, ends, selection)


def _parts(
    explained: Explained, plan: Sequence[Manoeuvre], level: Array, margin: float
) -> tuple[list[Part], dict[str, Performed], list[tuple[Located, int, Manoeuvre]]]:
    """The phases of all manoeuvres; what was performed of those that do not turn; the turns."""
    parts: list[Part] = []
    turns: list[tuple[Located, int, Manoeuvre]] = []
    performed: dict[str, Performed] = dict(completeness.left_out(explained, plan))
    for located in explained.located:
        binned, stretches, matched = located.binned, located.stretches, located.matched
        first = len(parts)
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
                parts += turn_parts(binned, stretches, m, matched, level, margin)
                turns.append((located, place, m))
        if any(m.do == "positions" for m in located.plan):
            parts += between_parts([p for p in parts[first:] if p.phase in STATIC_PHASES])
    return parts, performed, turns


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
        m = told.manoeuvre
        clipped = sums.clipped(m.name).get("", np.zeros(6, bool))[3:]
        done = completeness.turn(
            located.binned,
            located.stretches,
            place,
            m,
            in_motion.get(m.name, blocks.iloc[:0]),
            gaps,
            level,
            tolerance,
            clipped,
        )
        if located.axes.gyro != AS_NAMED:
            done, told = completeness.by_other_axes(done), replace(told, used=False)
        told_of[m.name] = told
        performed[m.name] = replace(done, sentence=f"{done.sentence} {told.remark}".rstrip())
    return performed, told_of


def _refuse_unknown(accepted: pd.DataFrame, known: Sequence[str]) -> None:
    """A repair that the campaign file confirms is one that is found."""
    for row in rows_of(accepted):
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
            name: float(np.nanmedian(log.count[channels])) * log.step
            for name, log in logs.items()
            if log.increments and np.isfinite(log.count[channels]).any()
        }
        for sensor, channels in SENSORS.items()
    }


STAGE = Stage(segment, DECLARED, gathers={"stated": stated_by})
