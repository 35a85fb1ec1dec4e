"""Differences between two values of a parameter, in units of their sigmas."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

from inertial import tables
from inertial.campaign.records import Row, with_mount
from inertial.estimation.consistency import holm_rejections, normal_p_value
from inertial.sensors import SINGULAR
from inertial.text.messages import _
from inertial.text.numbers import fixed, p_is, plus_minus
from inertial.text.parameters import PARTS, SENSOR_OF
from inertial.text.units import quantity

INPUTS = {"accel": _("force"), "gyro": _("rate")}
FORMS = {
    "cubic": _("what all gyros read beyond a straight line, with the cube of the rate"),
    "asymmetry": _("what all gyros read beyond a straight line, with the size of the rate"),
    "scale": _("scale factors of the gyros"),
}
MAX_AGREEING_SIGMAS = 2.0  # sigmas within which values simply agree


@dataclass(frozen=True)
class Difference:
    """Two values of a parameter, and the sigma of `first` less `second`; SI.

    Values and sigma are None where there is none; `remark` then says why.
    """

    kind: str
    stage: str  # of the parameter, such as gyroscope
    quantity: str  # such as bias_x
    unit: str
    first: str
    second: str
    first_value: float | None
    second_value: float | None
    sigma: float | None
    between: tuple[str, str]  # what is compared, as the sentence names it
    remark: str = ""
    place: str = ""  # which of several, such as the turns that are compared
    degrees: float = np.inf  # of freedom, from which sigma is estimated
    mount: str = ""

    @property
    def parameter(self) -> str:
        """Stage and quantity, such as gyroscope/bias_x."""
        return f"{self.stage}/{self.quantity}"

    @property
    def id(self) -> str:
        """The stable identifier."""
        kind = with_mount(self.kind, self.mount)
        parts = ["comparison", kind, self.parameter, self.place]
        return "/".join(part for part in parts if part)

    @property
    def value(self) -> float | None:
        """First less second."""
        if self.first_value is None or self.second_value is None:
            return None
        return self.first_value - self.second_value

    @property
    def in_sigmas(self) -> float | None:
        """The difference in units of its sigma."""
        return None if self.value is None or not self.sigma else self.value / self.sigma

    @property
    def p_value(self) -> float | None:
        """Chance of a difference so large, either way, if the two are the same."""
        return None if self.in_sigmas is None else normal_p_value(self.in_sigmas, self.degrees)

    def sentence(self, beyond: bool, among: int) -> str:
        """The difference in the laboratory's unit, and whether it is more than chance."""
        subject = named(self.stage, self.quantity)
        first, second = self.between
        if self.value is None or self.in_sigmas is None or self.p_value is None:
            return f"{subject}: {self.remark}."
        unit = quantity(self.quantity, self.unit).laboratory
        sigma = unit.of(self.sigma)
        size = plus_minus(unit.of(self.value), sigma)
        far = _(
            "{size} {name}, {fixed} sigma",
            size=size,
            name=unit.name,
            fixed=fixed(abs(self.in_sigmas), 1),
        )
        chance = f"({p_is(self.p_value)})"
        remark = f" {self.remark}." if self.remark else ""
        if beyond:
            verdict = _(
                "{value} and {other} differ by {far}: more than chance {chance}.",
                value=first,
                other=second,
                far=far,
                chance=chance,
            )
        elif abs(self.in_sigmas) <= MAX_AGREEING_SIGMAS:
            verdict = _(
                "{value} and {other} agree within their sigmas: they differ by {far} {chance}.",
                value=first,
                other=second,
                far=far,
                chance=chance,
            )
        else:
            verdict = _(
                "{value} and {other} differ by {far}: no more than chance among {among} "
                "comparisons {chance}.",
                value=first,
                other=second,
                far=far,
                among=among,
                chance=chance,
            )
        return f"{subject}: {verdict}{remark}"


def named(stage: str, name: str) -> str:
    """A parameter in words: bias_y of the gyroscope is the bias of the y gyro."""
    if name in FORMS:
        return FORMS[name]
    kind, axes = PARTS[name]
    sensor = SENSOR_OF[stage]
    if kind == "cross":
        return _(
            "response of the {axes} {sensor} to {input} along {axes_2}",
            axes=axes[0],
            sensor=SINGULAR[sensor],
            input=INPUTS[sensor],
            axes_2=axes[1],
        )
    what = {"bias": _("bias"), "scale": _("scale factor")}[kind]
    return _("{what} of the {axes} {sensor}", what=what, axes=axes, sensor=SINGULAR[sensor])


def table_of(differences: Sequence[Difference], level: float) -> pd.DataFrame:
    """The table of differences; `level` is the chance of one false alarm in all of it."""
    chances = [1.0 if d.p_value is None else d.p_value for d in differences]
    compared = np.array([d.p_value is not None for d in differences], dtype=np.bool_)
    among = int(compared.sum())
    beyond = np.zeros(len(differences), dtype=np.bool_)
    beyond[compared] = holm_rejections(np.array(chances)[compared].tolist(), level)
    rows = [_row(d, bool(beyond[i]), among) for i, d in enumerate(differences)]
    return tables.DIFFERENCES.frame(rows)


def _row(d: Difference, beyond: bool, among: int) -> Row:
    return {
        "id": d.id,
        "mount": d.mount,
        "sensor": SENSOR_OF[d.stage],
        "quantity": d.quantity,
        "kind": d.kind,
        "unit": d.unit,
        "first": d.first,
        "second": d.second,
        "first_value": d.first_value,
        "second_value": d.second_value,
        "difference": d.value,
        "sigma": d.sigma,
        "in_sigmas": d.in_sigmas,
        "p_value": d.p_value,
        "significant": None if d.p_value is None else beyond,
        "sentence": d.sentence(beyond, among),
    }
