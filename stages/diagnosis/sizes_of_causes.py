"""How large the effects are: by the result where its model has them, else by criticism."""

from collections.abc import Iterable, Iterator, Sequence

from inertial.campaign.competition import ExplainedFindings
from inertial.campaign.effect_sentences import Estimated, effect_sentence
from inertial.campaign.hypotheses import Findings
from inertial.campaign.records import Row, rows_of, sizes_of_result
from inertial.effects import KNOWN, TEMPERATURE_MODELS
from inertial.effects.restarts import Restarts
from inertial.text.parameters import AXES
from stages.diagnosis.causes import Size
from stages.diagnosis.sensor_results import SensorResult

PLACES = ("frequency", "n", "phase")  # parameters of lines: where they are, not how large
MIN_CLEAR_SIGMA = 4.0  # of a parameter: the effect is in its axis


def by_result(effects: Iterable[Row], results: Sequence[SensorResult]) -> list[Row]:
    """The rows of criticism's table of effects, with value and sigma of a result that has them."""
    of_result = sizes_of_result(row for result in results for row in result.chosen.rows)
    return [
        row | {key: own[key] for key in ("value", "sigma")}
        if (own := of_result.get((row["mount"], row["effect"], row["parameter"])))
        else row
        for row in effects
    ]


def sentences(
    explained: Sequence[ExplainedFindings],
    findings: Findings,
    before: Sequence[Row],
    now: Sequence[Row],
) -> Iterator[tuple[str, str]]:
    """By finding the sentence of an effect of the catalogue, with its sizes `now`.

    Of causes, and of effects that are consequences of these.

    before : the rows from which criticism made its sentence
    """
    positions = sorted(rows_of(findings.cause_positions), key=lambda row: int(row["rank"]))
    for cause in (one for each in explained for one in each.consequences):
        effect = KNOWN.get(cause.cause)
        if effect is None or not cause.named:
            continue
        at = [row["position"] for row in positions if row["finding"] == cause.id]
        old, new = (
            effect_sentence(
                effect.name,
                effect.cause,
                [_estimated(row) for row in rows if row["finding"] == cause.id],
                cause.verdict,
                cause.members,
                at,
            )
            for rows in (before, now)
        )
        # Criticism reports more of some effects, such as where a line is: that stays as it is.
        if cause.row["sentence"] == old:
            yield cause.id, new


def _estimated(row: Row) -> Estimated:
    return Estimated(row["parameter"], row["unit"], row["meaning"], row["value"], row["sigma"])


def sizes(effects: Iterable[Row]) -> dict[str, Size]:
    """By finding the parameter that is clearest in its sigma.

    What is scanned, a time, a frequency or an order, is where an effect is, not how large.
    """
    by_finding: dict[str, list[Row]] = {}
    for row in effects:
        effect = KNOWN.get(row["effect"])
        scanned = effect is not None and effect.scan is not None and effect.scan.name
        if isinstance(effect, Restarts):  # by how much runs differ, of which each is but one
            continue
        if row["finding"] and row["sigma"] and row["parameter"] not in (scanned, *PLACES):
            by_finding.setdefault(row["finding"], []).append(row)
    return {finding: _size(rows) for finding, rows in by_finding.items()}


def _size(rows: Sequence[Row]) -> Size:
    """Of an effect with a parameter for each axis the axis, where only one is clear."""
    best = max(rows, key=_sigmas)
    clear = [i for i, row in enumerate(rows) if _sigmas(row) > MIN_CLEAR_SIGMA]
    each_axis = len(rows) == len(AXES) and rows[0]["effect"] not in TEMPERATURE_MODELS
    axis = AXES[clear[0]] if each_axis and len(clear) == 1 else None
    return Size(best["value"], best["sigma"], best["unit"], axis)


def _sigmas(row: Row) -> float:
    return abs(float(row["value"]) / float(row["sigma"]))
