"""The parameters by rests, epoch by epoch: S0's six positions, and the gyros up and down."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial.arrays import Array
from inertial.campaign.campaign_data import CampaignData
from inertial.campaign.estimates import UNIT, described
from inertial.campaign.log_lines import RecordRange
from inertial.campaign.records import Manoeuvre, Performed, Row, rows_of, with_mount
from inertial.campaign.sample_stretches import Samples
from inertial.estimation.accelerometer_formulas import six_position_weights
from inertial.estimation.triad import errors_of, linear_names
from inertial.sensors import COLUMNS
from inertial.tables import AXES, CHANNELS
from inertial.text.messages import _
from inertial.text.parameters import SENSOR_OF

# ---- Variances of parameters that are solved from every epoch of the static positions.
#
#     parameter = Σ weight · reading + constant
#
# All static positions are cut into epochs of one length; the k-th epochs give the k-th value, the
# means of the first k epochs its running mean. S0 (tables 5-3, 5-4; figures 5-3 to 5-8) gives the
# variances of both, for epochs of one sample. That of single epochs decreases as 1/T for white
# noise alone. That of running means describes their excursion, not the sigma of the last one.


@dataclass(frozen=True)
class Formula:
    """p parameters as sums over the r readings of the rests: `weights` (p, r), `constant` (p,)."""

    weights: Array
    constant: Array

    def of(self, readings: Array) -> Array:
        """The parameters, (k, p), of readings (k, r)."""
        return np.asarray(readings @ self.weights.T + self.constant)

    def sigma(self, densities: Array, seconds: float) -> Array:
        """Sigmas by white noise of `densities` (r,), per √s, after so many seconds, (p,)."""
        return np.asarray(np.sqrt(self.weights**2 @ densities**2 / seconds))


@dataclass(frozen=True)
class Spread:
    """Variances of values that are solved epoch by epoch, (p,) each.

    `single`, `running`: variances of the values by single epochs and by running means.
    """

    samples: int  # of an epoch
    epochs: int
    single: Array
    running: Array


def in_epochs(readings: Array, length: int) -> tuple[Array, Array]:
    """Means over single epochs, and over all epochs up to each, (k, r) each.

    Parameters
    ----------
    readings : (n, r), samples of all rests side by side, NaN where masked
    length : samples of an epoch; an incomplete last epoch is not used
    """
    k = len(readings) // length
    cut = readings[: k * length].reshape(k, length, -1)
    sums, counts = np.nansum(cut, axis=1), np.isfinite(cut).sum(axis=1)
    with np.errstate(invalid="ignore"):
        return sums / counts, np.cumsum(sums, axis=0) / np.cumsum(counts, axis=0)


def spread(formula: Formula, readings: Array, lengths: Sequence[int]) -> list[Spread]:
    """The variances for epochs of several lengths in samples; at least two epochs of each."""
    result = []
    for length in lengths:
        single, running = (formula.of(part) for part in in_epochs(readings, length))
        if len(single) > 1:
            variances = [np.nanvar(values, axis=0, ddof=1) for values in (single, running)]
            result.append(Spread(length, len(single), *variances))
    return result


# ---- Rows of the study.

MAX_SAMPLES = 60_000  # of each rest: ten minutes at 100 Hz
MAX_EPOCHS = 200  # of the table, each a second or longer
MIN_SAMPLES = 64  # samples of a rest
MIN_LENGTH_SHARE = (
    0.25  # of the longest rest, which a rest must have, for all are cut to the shortest
)
MAX_INTERVAL_DIFFERENCE = 0.05  # relative, of sample intervals from log to log
MIN_EPOCHS = 8  # for a variance
NEEDED = {
    "accelerometer": _("four or more attitudes, of about the same length, that span all axes"),
    "gyroscope": _("an axis that points up and down, for about the same time"),
}


@dataclass(frozen=True)
class FormulaParameters:
    """Parameters of one stage by a formula over the rests; its readings rest by rest, x, y, z."""

    stage: str
    names: tuple[str, ...]
    formula: Formula


def rests_of(
    plan: Sequence[Manoeuvre], done: Mapping[str, Performed], segments: pd.DataFrame
) -> dict[str, tuple[Manoeuvre, RecordRange]]:
    """The planned rests of known attitude that were found, each cut to the shortest of them.

    One that is far shorter than the others is left out.
    """
    usable = [m for m in plan if m.do == "rest" and m.up is not None and done[m.name].found]
    spans = {
        row["manoeuvre"]: (row["from_record"], row["to_record"])
        for row in rows_of(segments[segments["phase"] == "rest"])
    }
    lengths = {m.name: spans[m.name][1] - spans[m.name][0] for m in usable if m.name in spans}
    longest = max(lengths.values(), default=0)
    lengths = {
        name: n
        for name, n in lengths.items()
        if n >= MIN_SAMPLES and n > MIN_LENGTH_SHARE * longest
    }
    length = min([*lengths.values(), MAX_SAMPLES])
    return {
        m.name: (m, RecordRange(m.log, spans[m.name][0], spans[m.name][0] + length))
        for m in usable
        if m.name in lengths
    }


def formulas(ups: Array, gravity: float) -> list[FormulaParameters]:
    """What the upward directions (n, 3) of the rests let the formulas solve."""
    found = []
    if (weights := six_position_weights(ups, gravity)) is not None:
        formula = Formula(weights.reshape(12, -1), errors_of(np.zeros(12)))
        found.append(FormulaParameters("accelerometer", linear_names(), formula))
    names, rows = [], []
    for i, axis in enumerate(AXES):
        up, down = (sign * ups[:, i] > 1 - 1e-9 for sign in (1, -1))
        if up.any() and down.any():
            row = np.zeros((len(ups), 3))
            row[:, i] = up / (2 * up.sum()) + down / (2 * down.sum())
            names.append(f"bias_{axis}")
            rows.append(row.ravel())
    if rows:
        found.append(
            FormulaParameters(
                "gyroscope", tuple(names), Formula(np.array(rows), np.zeros(len(rows)))
            )
        )
    return found


def studied(
    data: CampaignData,
    rests: Mapping[str, tuple[Manoeuvre, RecordRange]],
    samples: Mapping[str, Samples],
) -> dict[str, list[Row]]:
    """Epochs and spreads of the rests of one mount, and what is not studied."""
    rows: dict[str, list[Row]] = {"epochs": [], "spreads": [], "not_studied": []}
    there = {name: one for name, one in rests.items() if name in samples}
    length = min((len(samples[name].time) for name in there), default=0)
    step = np.array([data.clocks[m.log].step for m, _unused in there.values()])
    if length < MIN_SAMPLES or np.ptp(step) > MAX_INTERVAL_DIFFERENCE * step.min():
        short = _(
            "no rest of known attitude and {min_samples} samples or more was found",
            min_samples=MIN_SAMPLES,
        )
        reason = short if length < MIN_SAMPLES else _("the rests differ in their sample interval")
        rows["not_studied"].append(_not_studied(data.mount, data.named(_("rests")), reason))
        return rows
    ups = np.array([m.up for m, _unused in there.values()])
    found = formulas(ups, data.gravity.number)
    for stage in SENSOR_OF:
        if stage not in [named.stage for named in found]:
            needed = NEEDED[stage]
            rows["not_studied"].append(
                _not_studied(data.mount, data.named(stage), _("it needs {needed}", needed=needed))
            )
    for named in found:
        place = COLUMNS[SENSOR_OF[named.stage]].start
        channels = CHANNELS[place : place + 3]
        values = [samples[name].values[:length, place : place + 3] for name in there]
        density = np.concatenate([data.noise.of(name, "rest", channels) for name in there])
        _add(rows, named, np.hstack(values), density, float(step.mean()), data.mount)
    return rows


def _not_studied(mount: str, subject: str, reason: str) -> Row:
    return {"study": "rests", "mount": mount, "subject": subject, "reason": reason}


def _add(
    rows: dict[str, list[Row]],
    named: FormulaParameters,
    readings: Array,
    density: Array,
    step: float,
    mount: str,
) -> None:
    usable = np.isfinite(readings).any(axis=0) & np.isfinite(density)
    needed = (named.formula.weights != 0) @ ~usable == 0
    for name in np.array(named.names)[~needed]:
        what = f"{with_mount(named.stage, mount)}: {name}"
        reason = _("not all of its rests were recorded, with their noise")
        rows["not_studied"].append(_not_studied(mount, what, reason))
    names = [name for name, has in zip(named.names, needed, strict=True) if has]
    if not names:
        return
    formula = Formula(named.formula.weights[needed], named.formula.constant[needed])
    readings, density = np.where(usable, readings, 0.0), np.where(usable, density, 0.0)
    sensor = SENSOR_OF[named.stage]
    keys = [
        {"mount": mount, "sensor": sensor, "method": "rests", "quantity": name} for name in names
    ]
    unit = [described(named.stage, name)[0] for name in names]
    assert set(unit) <= {"1", *UNIT.values()}

    length = max(round(1 / step), -(-len(readings) // MAX_EPOCHS), 1)
    length = min(length, len(readings) // MIN_EPOCHS)
    single, running = (formula.of(part) for part in in_epochs(readings, length))
    for k in range(len(single)):
        seconds = (k + 1) * length * step
        sigma = formula.sigma(density, length * step)
        for i, key in enumerate(keys):
            rows["epochs"].append(
                key
                | {
                    "unit": unit[i],
                    "seconds": seconds,
                    "single": single[k, i],
                    "single_sigma": sigma[i],
                    "running_mean": running[k, i],
                    "running_mean_sigma": sigma[i] / np.sqrt(k + 1),
                }
            )
    most = len(readings) // MIN_EPOCHS
    lengths = [2**octave for octave in range(most.bit_length())]
    for one in spread(formula, readings, lengths):
        white = formula.sigma(density, one.samples * step) ** 2
        for i, key in enumerate(keys):
            rows["spreads"].append(
                key
                | {
                    "unit": unit[i],
                    "seconds": one.samples * step,
                    "epochs": one.epochs,
                    "single_variance": one.single[i],
                    "running_variance": one.running[i],
                    "white_variance": white[i],
                }
            )
