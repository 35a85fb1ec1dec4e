"""The samples with the errors of the result taken out, and the check against what is known."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array
from inertial.campaign import findings as findings
from inertial.campaign.campaign_data import MOUNTS, CampaignData
from inertial.campaign.equations import PRIOR_SIZE, Campaign
from inertial.campaign.findings import Finding
from inertial.campaign.masked_samples import MaskedSamples
from inertial.campaign.measurement import NOTHING, Measurement, SensorResult, measurements_of
from inertial.campaign.observations import campaign_of
from inertial.campaign.passages import with_attitudes
from inertial.campaign.records import Row, rows_of
from inertial.campaign.static_positions import StaticPosition
from inertial.estimation.random_walk import measured_covariance
from inertial.estimation.triad import linear_names
from inertial.estimation.uncertainty_budget import Model, budget
from inertial.tables.errors import Refusal
from inertial.tables.parquet import Stream
from inertial.tables.stage import Pieces, Stage
from inertial.text.messages import _
from inertial.text.parameters import FREE
from stages.compensation.characteristics import ByCounts, characteristics, least_changes
from stages.compensation.checks import checks, not_compensated
from stages.compensation.correction import CompensatedStream, envelope, mounted
from stages.compensation.declared import DECLARED
from stages.compensation.residuals import BLOCKS, residuals

ALREADY = Finding(
    id="compensation/already_compensated/campaign",
    cause="already_compensated",
    sentence=_(
        "The campaign says that its logs are compensated already, so they are not "
        "compensated again."
    ),
    consequence=_(
        "The parameters are what the first compensation has left over, not those of the IMU."
    ),
    action=_(
        "No sample is compensated. Give the raw logs, or remove compensated from campaign.yaml."
    ),
    severity=3,
)


def compensation(
    mounts: Sequence[CampaignData],
    masked_samples: MaskedSamples,
    simulated: Stream,
    traces: pd.DataFrame,
    segments: pd.DataFrame,
    measurements: Mapping[str, Measurement],
    fits: Sequence[Row],
    by_counts: ByCounts,
    *,
    compensated_before: bool,
) -> Pieces:
    """The table compensated, and what is known of the result, in pieces.

    By the result that counts: M and bias, and those effects that a reading, its time and its
    temperature tell. A sensor that is not usable has no compensated reading.

    measurements : of the result, by mount
    compensated_before : whether the logs are compensated already
    """
    if compensated_before:
        yield "findings", findings.table_of([ALREADY])
        return
    rows: list[Row] = []
    figures: list[Row] = []
    shares: list[Row] = []
    attitudes = [_by_hand(data, measurements.get(data.mount, NOTHING)) for data in mounts]
    for data, by_hand in zip(mounts, attitudes, strict=True):
        measurement = measurements.get(data.mount, NOTHING)
        if by_hand.by_hand:
            scatter = _scatters(fits, data.mount)
        else:
            scatter = _deviations(data, measurement, fits)
        rows += [check.row(data.mount) for check in checks(by_hand, measurement, scatter)]
        figures += characteristics(data, measurement, by_counts)
        shares += budget_rows(data, measurement, fits)
        for sensor in (measurement.accelerometer, measurement.gyro):
            rows += not_compensated(sensor, data.mount)
    yield "checks", rows
    yield "characteristics", tables.CHARACTERISTICS.frame(figures)
    yield "uncertainty_budget", tables.UNCERTAINTY_BUDGET.frame(shares)
    for left in residuals(attitudes, measurements, simulated):
        yield "residuals", left
    parts = mounted(mounts, measurements, segments)
    compensated = CompensatedStream(
        masked_samples.samples.path, parts, masked_samples.masked, masked_samples.repairs
    )
    for batch in compensated.columns([column.name for column in tables.COMPENSATED.columns]):
        yield "compensated", batch
    yield "compensated_traces", envelope(compensated, traces)


def measurements_along(
    mounts: Sequence[CampaignData], result: pd.DataFrame
) -> dict[str, Measurement]:
    """By mount the measurement equation of the result, in the course of the campaign."""
    measurements = measurements_of(result)
    for data in mounts:
        if data.mount in measurements:
            measurements[data.mount] = measurements[data.mount].along(*data.course)
    return measurements


def compensated_before(
    samples: Stream, campaign: pd.DataFrame, provenance: Mapping[str, Mapping[str, Any]]
) -> bool:
    """Whether the campaign says so of its logs.

    Raises
    ------
    Refusal
        where the samples are themselves the output of a compensation
    """
    maker = provenance["samples"]["stage"]
    if maker != "decode":
        raise Refusal(
            str(samples.path),
            "",
            _("samples made by {maker}", maker=maker),
            _("samples as decode makes them from the logs, not compensated"),
            _("give the samples of decode: a second compensation would take out the errors twice"),
        )
    (facts,) = rows_of(campaign)
    return bool(facts["compensated"])


def _by_hand(data: CampaignData, measurement: Measurement) -> CampaignData:
    """Positions of unknown attitude with the attitude by the result, where none is known."""
    triad = measurement.accelerometer.triad
    if triad is None or data.accelerometer_positions[0]:
        return data
    return with_attitudes(data, triad)


def _deviations(
    data: CampaignData, measurement: Measurement, fits: Sequence[Row]
) -> tuple[Array, Array]:
    """What biases are off by, of accelerometers and gyros, where the result has one of each.

    By a scatter of the manoeuvres, by a random walk between them, which at any time of T is
    K √(T/6) from its mean, and by what is known of the drift before a fit: from one switch-on to
    the next, and what the noise at rest shows, from the mean of the static positions.
    """
    time, _warm = data.course
    seconds = float(np.ptp(time[np.isfinite(time)])) if np.isfinite(time).any() else 0.0

    def of(result: SensorResult, positions: Sequence[StaticPosition]) -> Array:
        fit = (result.triad is not None and _fit(fits, data.mount, result)) or {}
        scatter, walk = (fit.get(name) or 0.0 for name in ("scatter", "random_walk"))
        variance = np.full(3, scatter**2 + walk**2 * seconds / 6)
        if positions:
            stretches = [position.stretch for position in positions]
            known = measured_covariance(stretches, data.drift(result.sensor))
            variance += np.trace(known, axis1=1, axis2=2) / len(stretches) - known.mean(axis=(1, 2))
        return np.asarray(np.sqrt(variance))

    accel = of(measurement.accelerometer, data.accelerometer_positions[0])
    return accel, of(measurement.gyro, data.gyro_positions[0])


def _scatters(fits: Sequence[Row], mount: str) -> tuple[Array, Array]:
    """What positions by hand differ by beyond noise, of accelerometers and gyros."""
    own = [r for r in fits if (r["mount"], r["method"]) == (mount, FREE)]
    accel, gyro = (
        np.full(3, max((r["scatter"] or 0.0 for r in own if r["sensor"] == sensor), default=0.0))
        for sensor in ("accel", "gyro")
    )
    return accel, gyro


def fits_of(
    accelerometer_fit: pd.DataFrame, gyroscope_fit: pd.DataFrame, extended_fit: pd.DataFrame
) -> Sequence[Row]:
    """The fits of both sensors as rows, those with effects too."""
    return [*rows_of(accelerometer_fit), *rows_of(gyroscope_fit), *rows_of(extended_fit)]


# ---- What the uncertainty of each parameter of the result comes from

MAX_SIGMA_RATIO = 1.1  # of the result's sigma and that of these equations, which are not the same
HELD = 1e-9  # of its prior, by which a parameter that the result does without is held at zero


def budget_rows(data: CampaignData, measurement: Measurement, fits: Sequence[Row]) -> Iterator[Row]:
    """A row for each parameter and source; none of positions by hand, nor of a mean over models."""
    if data.by_hand is not None or data.solution is None:
        return
    campaign = campaign_of(data)
    for result in (measurement.accelerometer, measurement.gyro):
        if result.triad is not None:
            fit = _fit(fits, data.mount, result)
            yield from _of_sensor(campaign, result, fit, data.mount) if fit else ()


def _fit(fits: Sequence[Row], mount: str, result: SensorResult) -> Row | None:
    """The fit that the result was taken from."""
    method = next(iter(result.rows.values()))["method"]
    key = (mount, result.sensor, method)
    return next((row for row in fits if (row["mount"], row["sensor"], row["method"]) == key), None)


def _of_sensor(campaign: Campaign, result: SensorResult, fit: Row, mount: str) -> Iterator[Row]:
    effects = [one.effect for one in result.effects if one.effect.sought_in == BLOCKS]
    scatter, walk = (fit[name] or 0.0 for name in ("scatter", "random_walk"))
    equations = campaign.equations(result.sensor, effects, PRIOR_SIZE, walking=bool(walk))
    if equations is None:
        return
    # A polynomial has all its terms in the equations, and in the result those that it needs.
    estimated = {row["parameter"] for one in result.effects for row in one.parameters.values()}
    absent = [kind == "effect" and name not in estimated for kind, name in equations.names]
    held = np.where(absent, HELD, 1.0) * equations.prior_sigma
    equations = replace(equations, prior_sigma=held)
    variances, parts = budget(Model(equations, scatter, walk))
    for i, name in enumerate(linear_names()):
        row, sigma = result.rows[name], np.sqrt(variances[i])
        if not 1 / MAX_SIGMA_RATIO < row["sigma"] / sigma < MAX_SIGMA_RATIO:
            continue
        for source, part in parts.items():
            variance = max(float(part[i]), 0.0)
            yield {
                "mount": mount,
                "sensor": result.sensor,
                "quantity": name,
                "source": source,
                "sigma": float(np.sqrt(variance)),
                "unit": row["unit"],
                "share": variance / float(variances[i]),
            }


STAGE = Stage(
    compensation,
    DECLARED,
    gathers={
        **MOUNTS,
        "masked_samples": MaskedSamples,
        "measurements": measurements_along,
        "fits": fits_of,
        "by_counts": least_changes,
        "compensated_before": compensated_before,
    },
)
