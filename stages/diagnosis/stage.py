"""Causes, the one result that counts, and the verdict per sensor; it fits nothing."""

from collections.abc import Iterator, Sequence

import numpy as np
import pandas as pd

from inertial.campaign.competition import compete
from inertial.campaign.hypotheses import CLEAR_SIGMAS, Findings, hypotheses
from inertial.campaign.noise_levels import only_noise
from inertial.campaign.records import Row, known_of, performed_of, rows_of
from inertial.tables import AXES
from inertial.tables.stage import Stage, Tables
from stages.diagnosis import jump_in_one_manoeuvre
from stages.diagnosis.causes import Cause, Evidence
from stages.diagnosis.conformity import conformity_rows
from stages.diagnosis.declared import DECLARED
from stages.diagnosis.gravity_by_latitude import referred
from stages.diagnosis.one_event import mountings_of, rotations, with_consequences
from stages.diagnosis.result import covariance_by_ids, curve_rows
from stages.diagnosis.sensor_results import Estimated, SensorResult
from stages.diagnosis.sizes_of_causes import by_result, sentences, sizes
from stages.diagnosis.verdict import NOT_USABLE, Verdict, not_recorded, verdict


def diagnosis(
    findings: Findings,
    estimated: Estimated,
    effects: pd.DataFrame,
    random_walks: pd.DataFrame,
    performed: pd.DataFrame,
    known: pd.DataFrame,
    swept: pd.DataFrame,
    noise_alone: bool,
    tolerances: pd.DataFrame,
    channel_statistics: pd.DataFrame,
    manoeuvres: pd.DataFrame,
) -> Tables:
    """Causes, consequences, members of classes, the result with its covariance, the verdict.

    And whether the result conforms to the tolerances.

    Parameters
    ----------
    estimated : the candidates for the result of each sensor and mount
    effects : of criticism: sizes of the effects
    known : of the plan: latitude and gravity
    swept : of criticism: changes with temperature of what one attitude shows
    noise_alone : whether the campaign is a recording of the noise
    channel_statistics : of the logs, by which it is known what is recorded
    manoeuvres : of the plan, to tell which are before a shift of the mounting
    """
    explained = list(compete(list(hypotheses(findings))))
    results, gravity = referred(list(estimated.results(explained)), explained, known_of(known))
    curves = {(row["sensor"], row["mount"]) for row in rows_of(swept)}
    evidence = Evidence(
        {(result.sensor, result.mount): result for result in results},
        frozenset(random_walks["finding"]),
        performed_of(performed),
        frozenset(curves),
        gravity,
    )
    causes = [jump_in_one_manoeuvre.named(cause) for cause in evidence.causes(explained)]
    recorded = _recorded(channel_statistics)
    results.sort(key=lambda result: result.sensor not in recorded)
    verdicts = [
        verdict(result, causes, _range(swept, result.sensor, result.mount), only_noise=noise_alone)
        if result.sensor in recorded
        else not_recorded(result.sensor)
        for result in results
    ]
    by_criticism = rows_of(effects)
    modelled = by_result(by_criticism, results)
    own_sizes = sizes(modelled)
    own_sentences = dict(sentences(explained, findings, by_criticism, modelled))
    mountings = mountings_of(results, manoeuvres, findings.segments, findings.clocks)
    turned = rotations(by_criticism, CLEAR_SIGMAS)
    written = _result_rows(results, verdicts)
    unusable = {
        (result.sensor, result.mount)
        for result, given in zip(results, verdicts, strict=True)
        if given.verdict == NOT_USABLE
    }
    covariance = covariance_by_ids(*(result.chosen.covariance_rows() for result in results))
    return {
        "causes": [
            mountings.described(
                with_consequences(cause.row(own_sizes, own_sentences), cause, own_sentences),
                cause,
                turned.get(cause.main.id, np.zeros(len(AXES))),
            )
            for cause in causes
        ],
        "members": [row for cause in causes for row in _members(cause, findings)],
        "consequences": [row for cause in causes for row in _consequences(cause)],
        "result": written,
        **_written(results, verdicts, rows_of(swept)),
        "conformity": [*conformity_rows(written, rows_of(tolerances), unusable, covariance)],
        "verdict": [
            {
                "mount": result.mount,
                "sensor": result.sensor,
                "recorded": result.sensor in recorded,
                "verdict": given.verdict,
                "sentence": given.sentence,
                "method": result.chosen.method,
                "condition": given.condition,
                "reason": result.decision.reason,
            }
            for result, given in zip(results, verdicts, strict=True)
        ],
    }


def _recorded(channel_statistics: pd.DataFrame) -> set[str]:
    """The sensors of which a log has readings; all of them where none has."""
    there = channel_statistics["smallest"].notna()
    return set(channel_statistics["sensor"][there]) or set(channel_statistics["sensor"])


def _members(cause: Cause, findings: Findings) -> Iterator[Row]:
    """The members of its class: effects, or repairs of which each would undo it."""
    own = [row for row in rows_of(findings.members) if row["finding"] == cause.main.id]
    members = [(row["effect"], row["probability"], None) for row in sorted(own, key=_rank)]
    members += [(row["repair"], None, row["condition"]) for row in cause.main.rivals]
    for rank, (member, probability, condition) in enumerate(members, 1):
        yield {
            "id": f"{cause.id}/{rank}",
            "cause": cause.id,
            "mount": cause.main.mount,
            "rank": rank,
            "member": member,
            "probability": probability,
            "condition": condition,
        }


def _rank(member: Row) -> int:
    return int(member["rank"])


def _consequences(cause: Cause) -> Iterator[Row]:
    """Every finding that the cause explains, its own among them."""
    for member in cause.members:
        for each in member.consequences:
            yield {"finding": each.id, "stage": each.stage, "cause": cause.id}


def _range(swept: pd.DataFrame, sensor: str, mount: str) -> tuple[float, float] | None:
    """The temperatures between which changes of a sensor are known, K; None: no curve is."""
    own = swept[(swept["sensor"] == sensor) & (swept["mount"] == mount)]["temperature"]
    return None if own.empty else (float(own.min()), float(own.max()))


def _result_rows(results: Sequence[SensorResult], verdicts: Sequence[Verdict]) -> list[Row]:
    """The parameters of the result, null where it is spoilt."""
    rows: list[Row] = []
    for result, given in zip(results, verdicts, strict=True):
        spoilt = {"value": None, "sigma": None, "reason": given.sentence} if given.spoilt else {}
        rows += [{**row, **spoilt} for row in result.chosen.rows]
    return rows


def _written(
    results: Sequence[SensorResult], verdicts: Sequence[Verdict], swept: Sequence[Row]
) -> Tables:
    """The covariance of the parameters with a value, and the curves of temperature."""
    usable = [result for result, given in zip(results, verdicts, strict=True) if not given.spoilt]
    covariances = [result.chosen.covariance_rows() for result in usable]
    return {
        "covariance": pd.concat(covariances) if covariances else [],
        "temperature_curves": [
            *(row for result in usable for row in curve_rows(result.chosen)),
            *swept,
        ],
    }


STAGE = Stage(
    diagnosis,
    DECLARED,
    gathers={"findings": Findings, "estimated": Estimated, "noise_alone": only_noise},
)
