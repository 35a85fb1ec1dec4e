"""The tables of a synthetic campaign as S0 ran it: six rests, six turns, one of them not whole."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Mapping
from copy import deepcopy
from functools import cache
from typing import Any
from unittest import mock

import numpy as np
import pandas as pd

from inertial import tables
from stages.report import stage as whole
from stages.report.outline import Section
from stages.report.tables import Tables
from stages.studies.declared import DECLARED
from tests.report import synthetic_alignment as alignment
from tests.report import synthetic_estimates as estimates
from tests.report import synthetic_model as model
from tests.report import synthetic_noise
from tests.report import synthetic_plan as plan
from tests.report import synthetic_recording as recording
from tests.report.synthetic_diagnosis import counted, diagnosed
from tests.report.synthetic_studies import studies
from tests.report.synthetic_values import Held, rows_as


def provenance_of(made: dict[str, Any]) -> Mapping[str, Mapping[str, Any]]:
    """What made each of its tables."""
    unknown = {"stage": "report", "settings": {}, "code": "c0de" * 16}
    return defaultdict(lambda: unknown, made.get("provenance", {}))


def tables_of(made: dict[str, Any]) -> Tables:
    """A campaign as the sections of the report get it."""
    return Tables(made, provenance_of(made))


def report_on(made: dict[str, Any]) -> dict[str, str]:
    """The report on a campaign."""
    return whole.report(**{**made, "provenance": provenance_of(made)})


def section_on(made: dict[str, Any], *sections: Section) -> str:
    """Some of its sections as HTML: the page of these alone, without fonts."""
    with (
        mock.patch.multiple(whole, EVIDENCE=sections, ANNEXES=()),
        mock.patch("stages.report.page._fonts", return_value=()),
    ):
        html = report_on(made)["html"]
    return html[html.index("<section id") : html.rindex("</section>")]


@cache
def documents() -> dict[str, str]:
    """The report on it, with the raw data of a rest and of the turn that is not whole."""
    return report_on(campaign(logs=("x-up.asc", "z-backward.asc")))


def brief(*logs: str) -> dict[str, Any]:
    """The same with few figures, for drawing takes its time: the raw data of `logs` alone."""
    made = campaign(logs)
    figures = (
        "noise",
        "allan",
        "spectra",
        "accelerometer_averaging",
        "gyroscope_averaging",
        "fidelity",
        "earlier",
        "temperature_curves",
    )
    less = {
        name: made[name].iloc[:0] for name in (*figures, *DECLARED.writes, "compensated_traces")
    }
    return made | less


def curve(parameter: str, **changed: Any) -> list[dict[str, Any]]:
    """A parabola of the temperature, from 1.4 to 65.5 °C."""
    nothing = {
        "order": 2,
        "knot": None,
        "probability": None,
        "relative_to": None,
        "not_separated": None,
    }
    return [
        {"mount": "", "sensor": "accel", "parameter": parameter, "temperature": t, "unit": "m/s²"}
        | {"value": 1e-6 * (t - 300) ** 2, "sigma": 1e-4}
        | nothing
        | changed
        for t in np.linspace(274.53, 338.65, 5)
    ]


def campaign(logs: Collection[str] | None = None) -> dict[str, Any]:
    """The tables of the report, by name; where `logs` are given, raw data of these alone."""
    return deepcopy(_campaign(None if logs is None else tuple(logs)))


@cache
def _campaign(logs: tuple[str, ...] | None) -> dict[str, Any]:
    generator = np.random.default_rng(20231018)
    manoeuvres = plan.manoeuvres()
    traces = [
        recording.trace(row, generator) for row in manoeuvres if logs is None or row["log"] in logs
    ]
    made: dict[str, Any] = {
        "campaign": rows_as(tables.CAMPAIGN, [plan.about()]),
        "known": rows_as(tables.KNOWN, plan.known()),
        "ideal_readings": rows_as(tables.IDEAL_READINGS, plan.ideal()),
        "certificate": rows_as(tables.CERTIFICATE, plan.certificate()),
        "standards": tables.STANDARDS.empty(),
        "guesses": tables.GUESSES.empty(),
        "conformity": tables.CONFORMITY.empty(),
        "uncertainty_budget": rows_as(tables.UNCERTAINTY_BUDGET, estimates.budget()),
        "covariance": tables.COVARIANCE.empty(),
        "blocks": tables.BLOCKS.empty(),
        "samples": Held(tables.SAMPLES.empty()),
        "sensors": rows_as(tables.SENSORS, plan.sensors()),
        "inputs": rows_as(tables.INPUTS, plan.inputs(manoeuvres)),
        "manoeuvres": rows_as(tables.MANOEUVRES, manoeuvres),
        "logs": rows_as(
            tables.LOGS,
            [
                {"log": log, "file": log, "layout": "{}"}
                for log in dict.fromkeys(row["log"] for row in manoeuvres)
            ],
        ),
        "accounts": rows_as(tables.ACCOUNTS, plan.accounts(manoeuvres)),
        "refused": rows_as(tables.REFUSED, plan.refused()),
        "clocks": rows_as(tables.CLOCKS, plan.clocks(manoeuvres)),
        "plan_repairs": tables.REPAIRS.empty(),
        "quality_findings": rows_as(tables.FINDINGS, recording.quality_findings()),
        "masks": tables.MASKS.empty(),
        "gaps": rows_as(tables.GAPS, [recording.gap()]),
        "quality_close_ups": pd.concat(
            [recording.gap_close_up(generator), recording.ringing(generator)]
        ),
        "segment_findings": rows_as(tables.FINDINGS, recording.segment_findings()),
        "segment_close_ups": tables.CLOSE_UPS.empty(),
        "segments": rows_as(tables.SEGMENTS, recording.segments(manoeuvres)),
        "performed": rows_as(tables.PERFORMED, recording.performed(manoeuvres)),
        "traces": pd.concat(traces, ignore_index=True) if traces else tables.TRACES.empty(),
        "noise": rows_as(tables.NOISE, recording.noise(manoeuvres, generator)),
        "levels": rows_as(tables.LEVELS, synthetic_noise.levels()),
        "allan": rows_as(tables.ALLAN, synthetic_noise.allan()),
        "spectra": rows_as(tables.SPECTRA, synthetic_noise.spectra()),
        "noise_terms": rows_as(tables.NOISE_TERMS, synthetic_noise.terms()),
        "drifts_at_rest": tables.DRIFTS_AT_REST.empty(),
        "temperature_curves": rows_as(tables.TEMPERATURE_CURVES, curve("bias_x")),
        "warm_up": tables.WARM_UP.empty(),
    }
    for stage, other in (("accelerometer", "six_position"), ("gyroscope", "turns")):
        parameters = estimates.parameters(stage, "joint") + estimates.parameters(stage, other)
        made[f"{stage}_parameters"] = rows_as(tables.PARAMETERS, parameters)
        made[f"{stage}_fit"] = rows_as(tables.FIT, estimates.fit(stage, other))
        made[f"{stage}_fit_manoeuvres"] = rows_as(
            tables.FIT_MANOEUVRES, estimates.fit_manoeuvres(stage, other)
        )
        made[f"{stage}_averaging"] = rows_as(
            tables.AVERAGING, estimates.averaging(parameters, generator)
        )
        made[f"{stage}_wanted"] = rows_as(tables.WANTED, estimates.wanted(stage, other))
    made |= model.of_the_model(manoeuvres, made["gyroscope_parameters"], generator)
    made |= model.criticised()
    for name, rows in studies(np.random.default_rng(1)).items():
        made[name] = rows_as(DECLARED.writes[name], rows)
    made["alignments"] = rows_as(tables.ALIGNMENTS, alignment.alignments())
    made["attitude_errors"] = rows_as(tables.ATTITUDE_ERRORS, alignment.attitude_errors())
    made["modulation_gains"] = rows_as(tables.MODULATION_GAINS, alignment.modulation_gains())
    made["checks"] = rows_as(tables.CHECKS, estimates.checks(manoeuvres))
    made["residuals"] = rows_as(tables.RESIDUALS, estimates.residuals(manoeuvres, generator))
    made["characteristics"] = rows_as(tables.CHARACTERISTICS, estimates.characteristics())
    for name, rows in (estimates.navigation() | estimates.repeated()).items():
        made[name] = rows_as(getattr(tables, name.upper()), rows)
    made["compensated_traces"] = estimates.compensated(made["traces"])
    made["differences"] = rows_as(tables.DIFFERENCES, estimates.differences())
    made["result"] = counted(made)
    made |= diagnosed(made)
    made["published_differences"] = rows_as(tables.DIFFERENCES, estimates.published())
    made["archived"] = rows_as(tables.ARCHIVED, [estimates.archived()])
    made["earlier"] = rows_as(tables.EARLIER, estimates.earlier(made, generator))
    maker: dict[str, Any] = {
        "settings": {"rest_block": 5.0},
        "code": "c0de" * 16,
        "inputs": {"demo/a": "0" * 64},
    }
    stages = {"quality_findings": "quality", "noise": "noise", "extended_parameters": "extension"}
    made["provenance"] = {
        name: {"stage": stages.get(name, name.partition("_")[0]), **maker} for name in made
    }
    return made


def poor() -> dict[str, Any]:
    """The same with every table empty but the campaign's own."""
    made = campaign()
    provenance = made.pop("provenance")
    streams = {name: Held(made.pop(name).frame.iloc[:0]) for name in ("simulated", "samples")}
    empty = {name: frame.iloc[:0] for name, frame in made.items()} | streams
    return {**empty, "campaign": made["campaign"], "provenance": provenance}
