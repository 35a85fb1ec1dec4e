"""What leaves the report without a result, though nothing need be wrong with the recording."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from inertial import tables
from inertial.campaign.noise_levels import only_noise
from inertial.estimation.triad import linear_names
from inertial.text.messages import _
from inertial.text.numbers import counted
from inertial.text.parameters import SENSOR_OF, sign_of

TWELVE = linear_names()
MIN_NEW_POSITION_DEG = 5.0  # degrees: less than this from the rest before is no new position
MAX_SPLIT = 0.5  # share of rests that are no new position
MAX_REASONS = 4
SEE_REPORT = _("the report shows the residuals: make report")


@dataclass(frozen=True)
class NoResult:
    """What gets no result, or none to rely on, why, and the cure; `sensor`: gyro or accel."""

    subject: str
    sentence: str
    action: str
    sensor: str = ""


def no_results(derived: Path) -> Iterator[NoResult]:
    """Of the tables of a campaign.

    Raises
    ------
    Refusal
        where one of them is missing, damaged, or of another version
    """
    blocks = tables.BLOCKS.read(derived / "segment/blocks.parquet")
    recorded = {
        s: bool(_readings(blocks, channel).notna().any(axis=None))
        for s, channel in SENSOR_OF.items()
    }
    plan = tables.MANOEUVRES.read(derived / "plan/manoeuvres.parquet")
    if only_noise(plan, tables.NOISE_TERMS.read(derived / "noise/terms.parquet")):
        return
    verdicts = _not_usable(derived / "diagnosis/verdict.parquet")
    curves = _with_curves(derived / "diagnosis/temperature_curves.parquet")
    for stage in SENSOR_OF:
        if recorded[stage] or not any(recorded.values()):
            subject = _("gyros") if stage == "gyroscope" else _("accelerometers")
            parameters = tables.PARAMETERS.read(derived / f"{stage}/parameters.parquet")
            nothing = parameters["value"].isna().all()
            found = list(_undetermined(subject, parameters))
            if nothing and SENSOR_OF[stage] in curves and SENSOR_OF[stage] not in verdicts:
                continue  # of use for what changes with the temperature, and that is all it is for
            if not found and (sentence := verdicts.get(SENSOR_OF[stage])) is not None:
                found = [NoResult(subject, sentence, SEE_REPORT)]
            yield from (replace(each, sensor=SENSOR_OF[stage]) for each in found)
    yield from _split_rests(plan, blocks)


def _not_usable(verdicts: Path) -> dict[str, str]:
    """By sensor, `gyro` or `accel`, why the report has no result of it, where it is diagnosed."""
    if not verdicts.exists():
        return {}
    rows = tables.VERDICTS.read(verdicts)
    rows = rows[rows["verdict"] == "not_usable"]
    return dict(zip(rows["sensor"], rows["sentence"], strict=True))


def _with_curves(curves: Path) -> set[str]:
    """The sensors, `gyro` or `accel`, with curves of the temperature, where it is diagnosed."""
    return set(tables.TEMPERATURE_CURVES.read(curves)["sensor"]) if curves.exists() else set()


def _undetermined(sensors: str, parameters: pd.DataFrame) -> Iterator[NoResult]:
    """The sensors where not all twelve parameters are determined by one method on one mount."""
    linear = parameters[parameters["effect"].isna() & parameters["parameter"].isin(TWELVE)]
    methods = [
        rows for _name, rows in linear.groupby(["mount", "method"]) if len(rows) == len(TWELVE)
    ]
    lacking = min((rows[rows["value"].isna()] for rows in methods), key=len, default=linear)
    if methods and lacking.empty:
        return
    sentence = (
        _("No parameter is determined.")
        if len(lacking) in (0, len(TWELVE))
        else _(
            "{count} of 12 parameters are not determined: {names}.",
            count=len(lacking),
            names=", ".join(map(sign_of, lacking["parameter"])),
        )
    )
    reasons = lacking["reason"].value_counts(sort=False).index[:MAX_REASONS]
    yield NoResult(sensors, sentence, "; ".join(reasons) + ".")


def _split_rests(plan: pd.DataFrame, blocks: pd.DataFrame) -> Iterator[NoResult]:
    """Rests of unknown attitude most of which stand as the one before: the log is cut to pieces."""
    free = blocks[(blocks["phase"] == "rest") & ~blocks["manoeuvre"].isin(plan["manoeuvre"])]
    means = _readings(free, "accel").groupby(free["manoeuvre"], sort=False).mean().dropna()
    up = means.to_numpy() / np.linalg.norm(means, axis=1)[:, None]
    cosines = np.clip((up[1:] * up[:-1]).sum(axis=1), -1.0, 1.0)
    split = int((np.degrees(np.arccos(cosines)) < MIN_NEW_POSITION_DEG).sum())
    if split > MAX_SPLIT * len(up):
        yield NoResult(
            _("positions"),
            _(
                "{rests} were found, and {split} stand as the one before, within "
                "{degrees:g}°: the log is cut to pieces that are no positions.",
                rests=counted(len(up), "rest"),
                split=split,
                degrees=MIN_NEW_POSITION_DEG,
            ),
            _(
                "state the time of the log and its true rate (time: column, unit, rate_hz in the "
                "format), or more seconds in the manoeuvre."
            ),
        )


def _readings(blocks: pd.DataFrame, channel: str) -> pd.DataFrame:
    return blocks[[f"{channel}_{axis}" for axis in tables.AXES]]
