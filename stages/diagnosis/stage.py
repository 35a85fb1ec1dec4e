"""Causes, the one result that counts, and the verdict per sensor; it fits nothing."""

from collections.abc import Iterator, Sequence

import pandas as pd

from inertial.campaign.explanations import compete
from inertial.campaign.hypotheses import Findings, findings_of, hypotheses
from inertial.campaign.records import Row, performed_of, rows_of
from inertial.effects import CATALOGUE
from inertial.tables.stage import Stage, Tables
from stages.diagnosis.causes import Cause, Evidence
from stages.diagnosis.declared import DECLARED
from stages.diagnosis.sensor_results import Estimated, SensorResult, estimated_of
from stages.diagnosis.verdict import Verdict, verdict

PLACES = ("frequency", "n", "phase")  # parameters of lines: where they are, not how large


def diagnosis(
    findings: Findings,
    estimated: Estimated,
    effects: pd.DataFrame,
    random_walks: pd.DataFrame,
    performed: pd.DataFrame,
) -> Tables:
    """Causes, consequences, members of classes, the result with its covariance, the verdict.

    Parameters
    ----------
    estimated : the candidates for the result of each sensor and mount
    effects : of criticism: sizes of the effects
    """
    explained = list(compete(list(hypotheses(findings))))
    results = list(estimated.results(explained))
    evidence = Evidence(
        {(result.sensor, result.mount): result for result in results},
        frozenset(random_walks["finding"]),
        performed_of(performed),
    )
    causes = evidence.causes(explained)
    verdicts = [verdict(result, causes) for result in results]
    sizes = _sizes(rows_of(effects))
    return {
        "causes": [cause.row(sizes) for cause in causes],
        "members": [row for cause in causes for row in _members(cause, findings)],
        "consequences": [row for cause in causes for row in _consequences(cause)],
        **_written(results, verdicts),
        "verdict": [
            {
                "mount": result.mount,
                "sensor": result.sensor,
                "verdict": given.verdict,
                "sentence": given.sentence,
                "method": result.chosen.method,
                "condition": given.condition,
                "reason": result.decision.reason,
            }
            for result, given in zip(results, verdicts, strict=True)
        ],
    }


def _sizes(effects: Sequence[Row]) -> dict[str, tuple[float | None, float | None, str]]:
    """By finding value, sigma and unit of the parameter that is clearest in its sigma.

    What is scanned, a time, a frequency or an order, is where an effect is, not how large.
    """
    clearest: dict[str, Row] = {}
    for row in effects:
        effect = CATALOGUE.get(row["effect"])
        scanned = effect is not None and effect.scan is not None and effect.scan.name
        if row["finding"] and row["sigma"] and row["parameter"] not in (scanned, *PLACES):
            best = clearest.get(row["finding"])
            if best is None or _sigmas(row) > _sigmas(best):
                clearest[row["finding"]] = row
    return {name: (row["value"], row["sigma"], row["unit"]) for name, row in clearest.items()}


def _sigmas(row: Row) -> float:
    return abs(float(row["value"]) / float(row["sigma"]))


def _members(cause: Cause, findings: Findings) -> Iterator[Row]:
    """The members of its class, by the finding that speaks for it."""
    for row in findings.members:
        if row["finding"] == cause.main.id:
            yield {
                "id": f"{cause.id}/{row['rank']}",
                "cause": cause.id,
                "mount": row["mount"],
                "rank": row["rank"],
                "member": row["effect"],
                "probability": row["probability"],
            }


def _consequences(cause: Cause) -> Iterator[Row]:
    """Every finding that the cause explains, its own among them."""
    for member in cause.members:
        for each in member.consequences:
            yield {"finding": each.id, "stage": each.stage, "cause": cause.id}


def _written(results: Sequence[SensorResult], verdicts: Sequence[Verdict]) -> Tables:
    """The rows of the result, null where it is spoilt, and the covariance of those with a value."""
    rows: list[Row] = []
    covariances = []
    for result, given in zip(results, verdicts, strict=True):
        if given.spoilt:
            nothing = {"value": None, "sigma": None, "reason": given.sentence}
            rows += [{**row, **nothing} for row in result.chosen.rows]
        else:
            rows += result.chosen.rows
            covariances.append(result.chosen.covariance_rows())
    return {"result": rows, "covariance": pd.concat(covariances) if covariances else []}


STAGE = Stage(diagnosis, DECLARED, gathers={"findings": findings_of, "estimated": estimated_of})
