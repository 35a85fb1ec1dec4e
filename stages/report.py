"""The lab report: what was found, how sure it is, and where every number comes from.

    python -m stages.report --campaign … --known … \
        --output reports/demo.html --verdict reports/demo.txt

It writes a page and the verdict as text instead of tables, so it has a command
line of its own.
"""

import argparse
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import pandas as pd

from inertial import tables
from inertial.campaign.final_result import counting, extended_methods
from inertial.tables.code import code_of, hash_of
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Stream
from inertial.tables.parquet import provenance as made_by
from inertial.tables.table import Table
from inertial.tables.whole_files import write_whole
from inertial.text import numbers
from stages.reporting import (
    account,
    averaging,
    before_after,
    comparisons,
    compensation,
    evidence,
    expected,
    extended,
    findings,
    history,
    lacks,
    parameters,
    raw_data,
    recording,
    studies,
    undetermined,
    verdict,
)
from stages.reporting import (
    extended_parameters as extended_parameters_of,
)
from stages.reporting import (
    known as taken_as_known,
)
from stages.reporting import (
    noise as noise_of_channels,
)
from stages.reporting import (
    provenance as origin,
)
from stages.reporting import (
    simulated as over_simulated,
)
from stages.reporting.at_once import at_once
from stages.reporting.close_ups import close_ups
from stages.reporting.criticised import Criticised
from stages.reporting.logs import logs
from stages.reporting.outline import Report
from stages.reporting.page import page
from stages.reporting.rows import only, records
from stages.reporting.sought import sought as sought_of

READS: Mapping[str, Table] = {
    "campaign": tables.CAMPAIGN,
    "known": tables.KNOWN,
    "sensors": tables.SENSORS,
    "inputs": tables.INPUTS,
    "manoeuvres": tables.MANOEUVRES,
    "accounts": tables.ACCOUNTS,
    "refused": tables.REFUSED,
    "clocks": tables.CLOCKS,
    "quality_findings": tables.FINDINGS,
    "masks": tables.MASKS,
    "gaps": tables.GAPS,
    "quality_close_ups": tables.CLOSE_UPS,
    "segment_findings": tables.FINDINGS,
    "segment_close_ups": tables.CLOSE_UPS,
    "segments": tables.SEGMENTS,
    "performed": tables.PERFORMED,
    "traces": tables.TRACES,
    "noise": tables.NOISE,
    "accelerometer_parameters": tables.PARAMETERS,
    "accelerometer_fit": tables.FIT,
    "accelerometer_findings": tables.FINDINGS,
    "accelerometer_averaging": tables.AVERAGING,
    "accelerometer_wanted": tables.WANTED,
    "gyroscope_parameters": tables.PARAMETERS,
    "gyroscope_fit": tables.FIT,
    "gyroscope_averaging": tables.AVERAGING,
    "gyroscope_wanted": tables.WANTED,
    "epochs": tables.EPOCHS,
    "spreads": tables.SPREADS,
    "windows": tables.WINDOWS,
    "growing": tables.WINDOWS,
    "middles": tables.WINDOWS,
    "time_angle": tables.TIME_ANGLE,
    "motions": tables.MOTIONS,
    "not_studied": tables.NOT_STUDIED,
    "simulated": tables.SIMULATED,
    "fidelity": tables.FIDELITY,
    "scores": tables.SCORES,
    "effects": tables.EFFECTS,
    "lines": tables.LINES,
    "blind_spots": tables.BLIND_SPOTS,
    "structures": tables.STRUCTURES,
    "structure_points": tables.STRUCTURE_POINTS,
    "criticism_findings": tables.CAUSES,
    "extended_parameters": tables.PARAMETERS,
    "extended_fit": tables.FIT,
    "gain": tables.GAIN,
    "worth": tables.WORTH,
    "decision": tables.DECISION,
    "differences": tables.DIFFERENCES,
    "checks": tables.CHECKS,
    "compensated_traces": tables.TRACES,
    "compensation_findings": tables.FINDINGS,
    "archived": tables.ARCHIVED,
    "earlier": tables.EARLIER,
}
STREAMS = ("simulated",)  # too long for memory


class Documents(NamedTuple):
    """The report as a page, and its verdict as plain text."""

    html: str
    verdict: str


def report(
    *,
    campaign: pd.DataFrame,
    known: pd.DataFrame,
    sensors: pd.DataFrame,
    inputs: pd.DataFrame,
    manoeuvres: pd.DataFrame,
    accounts: pd.DataFrame,
    refused: pd.DataFrame,
    clocks: pd.DataFrame,
    quality_findings: pd.DataFrame,
    masks: pd.DataFrame,
    gaps: pd.DataFrame,
    quality_close_ups: pd.DataFrame,
    segment_findings: pd.DataFrame,
    segment_close_ups: pd.DataFrame,
    segments: pd.DataFrame,
    performed: pd.DataFrame,
    traces: pd.DataFrame,
    noise: pd.DataFrame,
    accelerometer_parameters: pd.DataFrame,
    accelerometer_fit: pd.DataFrame,
    accelerometer_findings: pd.DataFrame,
    accelerometer_averaging: pd.DataFrame,
    accelerometer_wanted: pd.DataFrame,
    gyroscope_parameters: pd.DataFrame,
    gyroscope_fit: pd.DataFrame,
    gyroscope_averaging: pd.DataFrame,
    gyroscope_wanted: pd.DataFrame,
    epochs: pd.DataFrame,
    spreads: pd.DataFrame,
    windows: pd.DataFrame,
    growing: pd.DataFrame,
    middles: pd.DataFrame,
    time_angle: pd.DataFrame,
    motions: pd.DataFrame,
    not_studied: pd.DataFrame,
    simulated: Stream,
    fidelity: pd.DataFrame,
    scores: pd.DataFrame,
    effects: pd.DataFrame,
    lines: pd.DataFrame,
    blind_spots: pd.DataFrame,
    structures: pd.DataFrame,
    structure_points: pd.DataFrame,
    criticism_findings: pd.DataFrame,
    extended_parameters: pd.DataFrame,
    extended_fit: pd.DataFrame,
    gain: pd.DataFrame,
    worth: pd.DataFrame,
    decision: pd.DataFrame,
    differences: pd.DataFrame,
    checks: pd.DataFrame,
    compensated_traces: pd.DataFrame,
    compensation_findings: pd.DataFrame,
    archived: pd.DataFrame,
    earlier: pd.DataFrame,
    provenance: Mapping[str, Mapping[str, Any]],
) -> Documents:
    """The lab report of one campaign, and its verdict as text."""
    about = only(campaign)
    found = parameters.estimates(
        accelerometer_parameters, accelerometer_fit, gyroscope_parameters, gyroscope_fit
    )
    worst_first = findings.ranked(
        (
            quality_findings,
            segment_findings,
            accelerometer_findings,
            criticism_findings,
            compensation_findings,
        )
    )
    decided = records(decision)
    extended_rows = records(extended_parameters)
    counts = extended.counting(
        found, extended.estimates(extended_rows, records(extended_fit)), decided
    )
    drawn = logs(traces, segments, clocks, gaps)
    sought = sought_of(scores, effects)
    model = Criticised(
        {(one.score["effect"], one.mount): one for one in sought},
        simulated,
        before_after.means(simulated, fidelity, manoeuvres),
        lines,
        manoeuvres,
        records(structures),
        records(structure_points),
        records(gain),
        records(worth),
        decided,
        [row for row in records(accelerometer_findings) if row["cause"] == "table_position_error"],
        extended_parameters_of.shifts(extended_rows, found),
        [
            row
            for one in verdict.joint_fits(counts)
            if one.stage == "gyroscope"
            for row in one.determined
        ],
    )
    given = verdict.verdict(counts, manoeuvres, performed, worst_first, decided)
    estimated = [*records(accelerometer_parameters), *records(gyroscope_parameters)]
    replaced = extended_methods(decided)
    better = [row for row in extended_rows if row["method"] in replaced]
    counted = counting(estimated, better)
    name = numbers.shortened(about["campaign"], 80)
    serial = numbers.shortened(about["serial"], 80)
    instrument = f"{numbers.shortened(about['instrument'], 80)} · serial {serial}"
    sections = at_once(
        [
            lambda: verdict.section(given, counts, about, known, clocks),
            lambda: parameters.section(found, decision),
            lambda: lacks.section(
                records(criticism_findings),
                sought,
                model,
                records(blind_spots),
                extended_rows,
                found,
                findings.of_model(worst_first, segments),
            ),
            lambda: findings.section(
                worst_first,
                evidence.evidence(
                    worst_first[: findings.MOST_IN_FULL],
                    evidence.Recording(
                        {log.name: log for log in drawn},
                        close_ups((quality_close_ups, segment_close_ups)),
                        gaps,
                        masks,
                        manoeuvres,
                        performed,
                        expected.stated(known, about["rate"]),
                    ),
                ),
                segments,
            ),
            lambda: undetermined.section(found),
            lambda: over_simulated.section(simulated, fidelity, manoeuvres, segments),
            lambda: comparisons.section(differences),
            lambda: compensation.section(
                checks, traces, compensated_traces, segments, manoeuvres, decision
            ),
            lambda: history.section(earlier, archived, counted, about["date"]),
            lambda: recording.section(manoeuvres, performed),
            lambda: raw_data.section(drawn),
            lambda: noise_of_channels.section(noise, sensors),
            lambda: averaging.section(
                accelerometer_averaging,
                gyroscope_averaging,
                [*records(accelerometer_wanted), *records(gyroscope_wanted)],
                estimated,
            ),
            lambda: studies.section(
                epochs, spreads, windows, growing, middles, time_angle, motions, not_studied
            ),
            lambda: taken_as_known.section(known),
            lambda: account.section(accounts, refused, inputs),
            lambda: origin.section(inputs, provenance),
        ]
    )
    outline = Report(
        title=f"Calibration report: {name} · {instrument}",
        campaign=name,
        instrument=instrument,
        running=f"{name} · {instrument}" + (" · simulated" if about["simulated"] else ""),
        simulated=bool(about["simulated"]),
        sections=tuple(sections),
    )
    return Documents(page(outline), verdict.as_text(given, campaign, known, clocks))


def main(arguments: Sequence[str] | None = None) -> None:
    """Read the tables, write the page and the verdict, both beside their place and then moved."""
    parser = argparse.ArgumentParser(description=report.__doc__)
    for name, table in READS.items():
        parser.add_argument(
            f"--{name}", type=Path, required=True, metavar="PATH", help=f"{table.name} table"
        )
    parser.add_argument("--output", type=Path, required=True, help="the page, .html")
    parser.add_argument("--verdict", type=Path, required=True, help="the verdict, .txt")
    given = parser.parse_args(arguments)
    paths: dict[str, Path] = {name: getattr(given, name) for name in READS}
    try:
        read: dict[str, Any] = {
            name: table.stream(paths[name]) if name in STREAMS else table.read(paths[name])
            for name, table in READS.items()
        }
        makers = {name: made_by(path) for name, path in paths.items()}
        makers["report"] = {"stage": "report", "settings": {}, "code": hash_of(code_of("report"))}
        documents = report(**read, provenance=makers)
        texts = {given.output: documents.html, given.verdict: documents.verdict}
        write_whole({path: text.encode() for path, text in texts.items()})
    except Refusal as refusal:
        sys.exit(f"report: {refusal}")


if __name__ == "__main__":
    main()
