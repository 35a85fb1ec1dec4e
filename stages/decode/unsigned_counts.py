"""Unsigned counts that were not said to be unsigned: refused, with the zero that they have."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from inertial.tables.errors import Refusal
from inertial.text.campaign_units import CHANNEL_UNITS
from inertial.text.messages import _
from inertial.text.units import STANDARD_GRAVITY
from stages.decode.decoded import Reals

ZEROS = {1 << (bits - 1): bits for bits in (16, 12, 24)}  # middle of the counts of converters


def refuse_unsigned(file: str, sensor: str, triad: Mapping[str, Any], values: Reals) -> None:
    """Refuse the first readings of a triad, (n, 3), where their zero is that of unsigned counts.

    All three channels then lie in the middle half of a converter's counts: no gyro turns so about
    all its axes at once. Accelerometers could, so their |f| must be nearer to gravity with that
    zero than without. A stated `zero_counts`, 0 included, is believed.

    Raises
    ------
    Refusal
        where they are such counts
    """
    values = values[np.isfinite(values).all(axis=1)]
    if "zero_counts" in triad or not len(values):
        return
    for zero, bits in ZEROS.items():
        usual = np.median(values, axis=0)
        inside = values.min() >= 0 and values.max() < 2 * zero
        if inside and (abs(usual - zero) < zero / 2).all() and _fits(sensor, triad, usual, zero):
            raise Refusal(
                file,
                sensor,
                _(
                    "counts from {least:g} to {most:g}, as unsigned ones of {bits} bits, whose "
                    "zero is {zero}",
                    least=values.min(),
                    most=values.max(),
                    bits=bits,
                    zero=zero,
                ),
                _("zero_counts, the count that stands for zero"),
                _(
                    "add zero_counts: {zero} to {sensor} in its format; zero_counts: 0 if they "
                    "are right as they are",
                    zero=zero,
                    sensor=sensor,
                ),
            )


def _fits(sensor: str, triad: Mapping[str, Any], usual: Reals, zero: int) -> bool:
    """Whether the usual readings, (3,), make more sense from this zero than from 0."""
    if sensor != "accelerometer" or "counts_per_unit" not in triad:
        return True
    size = CHANNEL_UNITS[triad["unit"]] / np.array(triad["counts_per_unit"]) / STANDARD_GRAVITY
    with_zero, without = (np.linalg.norm((usual - z) * size) for z in (zero, 0))
    return bool(abs(np.log(with_zero)) < abs(np.log(without))) if with_zero > 0 else False
