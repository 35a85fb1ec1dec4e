"""Unsigned counts that were not said to be unsigned: refused, with their zero or their bits."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from inertial.signal.signed_counts import bits_without_sign
from inertial.tables.errors import Refusal
from inertial.text.messages import _
from inertial.text.units import CHANNEL_UNITS, STANDARD_GRAVITY
from stages.decode.decoded import Reals

ZEROS = {1 << (bits - 1): bits for bits in (16, 12, 24)}  # middle of the counts of converters


def refuse_unsigned(file: str, sensor: str, triad: Mapping[str, Any], values: Reals) -> None:
    """Refuse the first readings of a triad, (n, 3), where their zero is that of unsigned counts.

    All three channels then lie in the middle half of a converter's counts: no gyro turns so about
    all its axes at once. Accelerometers could, so their |f| must be nearer to gravity with that
    zero than without. A stated `zero_counts`, 0 included, or `signed_bits` is believed.

    Raises
    ------
    Refusal
        where they are such counts
    """
    values = values[np.isfinite(values).all(axis=1)]
    if "zero_counts" in triad or "signed_bits" in triad or not len(values):
        return
    if "counts_per_unit" in triad and (size := bits_without_sign([values])) is not None:
        raise Refusal(
            file,
            sensor,
            _(
                "counts that leap between 0 and {most:g}: they are written without their sign",
                most=2**size - 1,
            ),
            _("counts with their sign, or signed_bits"),
            _("add signed_bits: {size} to {sensor} in its format", size=size, sensor=sensor),
        )
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
