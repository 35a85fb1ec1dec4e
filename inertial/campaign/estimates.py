"""Rows of the tables that every method of estimation writes: parameters, covariance, fit."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from inertial import tables
from inertial.arrays import Array, Booleans, finite_or_none
from inertial.campaign.records import Manoeuvre, Part, Row, with_mount
from inertial.estimation import triad
from inertial.estimation.gyroscope_observations import EARTH_UP
from inertial.estimation.least_squares import Estimate
from inertial.estimation.scatter_and_random_walk import ScatterFit, SwitchOns
from inertial.tables import AXES, BODY, OF_TRIAD
from inertial.tables.declared import ESTIMATION
from inertial.text.messages import _
from inertial.text.parameters import (
    CROSS,
    FREE,
    JOINT,
    MOUNTING,
    PARTS,
    SCALE,
    SENSOR_OF,
    SYMMETRIC,
)


@dataclass(frozen=True)
class Wanted:
    """The sigma of a bias by static positions of so many seconds each, and its floor; SI.

    S0 (5-1), (5-2) require T ≥ (3 N/b)² with a bias b that is not known yet. A laboratory requires
    a sigma instead: of the means from which a formula has the bias,

        σ² = a / T + floor²,   T = a / (σ² − floor²),

    with a from white noise, and the floor from what does not average out: tilts of the positions,
    gravity, the azimuth.
    """

    sigma: float
    floor: float
    seconds: float

    def row(self, wanted: float) -> dict[str, Any]:
        """The time for a `wanted` sigma; null where the floor is too high for any."""
        noise = (self.sigma**2 - self.floor**2) * self.seconds
        above = wanted**2 - self.floor**2
        return {
            "seconds": self.seconds,
            "sigma": self.sigma,
            "floor": self.floor,
            "random_walk": float(np.sqrt(max(noise, 0.0))),
            "wanted": wanted,
            "wanted_seconds": noise / above if above > 0 else None,
        }


NAMES = triad.linear_names()
SENSED = {"accelerometer": _("specific force"), "gyroscope": _("angular rate")}
# The estimated parameters of a position, by the names of unknowns: quantity, component, unit.
OF_POSITIONS = {
    f"{kind} {component}": ((quantity, component, unit),)
    for kind, quantity, unit in (("tilt", "tilt", "rad"), ("level", "horizontal", "rad/s"))
    for component in (0, 1)
}
OF_SWITCH_ONS = {f"switch-on {i}": axis for i, axis in enumerate(AXES)}
UNIT = {"accelerometer": "m/s²", "gyroscope": "rad/s"}
TABLES = {
    name: table
    for name, table in ESTIMATION.writes.items()
    if name not in ("covariance", "findings")  # which are of the joint result alone
}


class Estimates:
    """The results of the methods of one stage for one mount, as rows of the common tables."""

    def __init__(self, stage: str, mount: str = "") -> None:
        self.stage, self.mount = stage, mount
        self.rows: dict[str, list[dict[str, Any]]] = {name: [] for name in TABLES}
        self.covariances: list[pd.DataFrame] = []

    def on(self, mount: str) -> "Estimates":
        """The same collection, for the rows of another mount."""
        other = Estimates(self.stage, mount)
        other.rows, other.covariances = self.rows, self.covariances
        return other

    def add(
        self,
        method: str,
        names: tuple[str, ...],
        values: Array,
        covariance: Array,
        reasons: dict[str, str],
    ) -> None:
        """The result of one method; a name in `reasons` is not determined, for that reason."""
        ids = [f"{self.stage}/{with_mount(method, self.mount)}/{name}" for name in names]
        sigma = np.sqrt(np.diag(covariance))
        for i, name in enumerate(names):
            unit, frame, meaning = described(self.stage, name, by_hand=method == FREE)
            missing = name in reasons
            self.rows["parameters"].append(
                {
                    "id": ids[i],
                    "stage": self.stage,
                    **self._key(method),
                    "effect": None,
                    "parameter": name,
                    "value": None if missing else float(values[i]),
                    "sigma": None if missing else float(sigma[i]),
                    "unit": unit,
                    "frame": frame,
                    "meaning": meaning,
                    "reason": reasons.get(name, ""),
                }
            )
        determined = [i for i, name in enumerate(names) if name not in reasons]
        self.covariances.append(covariance_rows(ids, covariance, determined))

    def _key(self, method: str, quantity: str = "") -> dict[str, Any]:
        """The columns that say whose estimate a row holds."""
        key = {"mount": self.mount, "sensor": SENSOR_OF[self.stage], "method": method}
        return key | ({"quantity": quantity} if quantity else {})

    def add_triad(self, method: str, estimate: Estimate, reasons: dict[str, str]) -> None:
        """The twelve unknowns of three sensors, and the polar decomposition of M."""
        unknowns, covariance = estimate.values[:12], estimate.covariance[:12, :12]
        matrix = unknowns[:9].reshape(3, 3)
        jacobian = np.zeros((21, 12))
        jacobian[:12] = np.eye(12)
        derived = MOUNTING + SYMMETRIC
        values = np.append(triad.errors_of(unknowns), np.zeros(len(derived)))
        if np.linalg.det(matrix) > 0:
            jacobian[12:, :9] = triad.jacobian_of_mounting(matrix)
            values[12:] = triad.mounting_and_symmetric(matrix)
        else:  # two axes are exchanged, or a sign is wrong: a finding reports it
            reasons = reasons | {name: _("M is left-handed: it is no mounting") for name in derived}
        if any(name in SCALE + CROSS for name in reasons):
            reasons = reasons | {name: _("it needs all nine elements of M") for name in derived}
        self.add(method, NAMES + derived, values, jacobian @ covariance @ jacobian.T, reasons)

    def add_nothing(self, method: str, reason: str) -> None:
        """None of the twelve parameters is determined, for one reason."""
        reason = reason or _("there is no rest whose upward direction is known, and no turn")
        nothing = (np.zeros(len(NAMES)), np.zeros((len(NAMES), len(NAMES))))
        self.add(method, NAMES, *nothing, dict.fromkeys(NAMES, reason))

    def add_fit(
        self,
        method: str,
        fitted: ScatterFit,
        used: Sequence[Part],
        left_out: Sequence[Part],
    ) -> None:
        """Goodness of fit, the manoeuvres used, what was estimated of positions and switch-ons."""
        estimate = fitted.estimate
        found = list(
            zip(estimate.names, estimate.values.tolist(), estimate.sigma.tolist(), strict=True)
        )
        for (kind, name), value, sigma in found:
            row = self._key(method) | {"value": value, "sigma": sigma}
            for quantity, component, unit in OF_POSITIONS.get(kind, ()):
                of = {"position": name, "quantity": quantity, "component": component}
                self.rows["positions"].append(row | of | {"unit": unit})
            if kind in OF_SWITCH_ONS:
                of = {"switch_on": int(name), "axis": OF_SWITCH_ONS[kind]}
                self.rows["switch_ons"].append(row | of | {"unit": UNIT[self.stage]})
        self.rows["fit_manoeuvres"] += [
            self._key(method)
            | {"manoeuvre": part.manoeuvre, "phase": part.phase}
            | {"used": not part.reason, "reason": part.reason or None}
            for part in (*used, *left_out)
        ]
        self.rows["fit"].append(
            self._key(method)
            | {
                "chi_squared": fitted.estimate.chi_squared,
                "degrees": fitted.estimate.degrees,
                "p_value": fitted.p_value,
                "scatter": fitted.scatter,
                "scatter_seconds": fitted.scatter_seconds,
                "unit": UNIT[self.stage],
                "random_walk": fitted.random_walk,
                "random_walk_sigma": fitted.random_walk_sigma,
                "earth_rate_up": next((v for name, v, _s in found if name == EARTH_UP), None),
            }
            | switch_on_columns(fitted.switch_ons)
        )

    def add_averaging(self, seconds: float, estimate: Estimate) -> None:
        """The joint fit from the first seconds of each static position."""
        values = triad.errors_of(estimate.values[:12])
        self.rows["averaging"] += [
            self._key(JOINT, name)
            | {
                "seconds": seconds,
                "value": float(values[i]),
                "sigma": float(estimate.sigma[i]),
            }
            for i, name in enumerate(NAMES)
            if estimate.determined[i]
        ]

    def add_wanted(self, method: str, axis: str, required: Wanted, wanted: float) -> None:
        """The length of static positions for a bias with the sigma `wanted`."""
        self.rows["wanted"].append(self._key(method, f"bias_{axis}") | required.row(wanted))

    def tables(self) -> dict[str, pd.DataFrame]:
        """The tables, with their columns even where there are no rows."""
        frames = {name: TABLES[name].frame(rows) for name, rows in self.rows.items()}
        empty = tables.COVARIANCE.empty()
        return frames | {"covariance": pd.concat(self.covariances) if self.covariances else empty}


def covariance_rows(ids: Sequence[str], covariance: Array, which: Sequence[int]) -> pd.DataFrame:
    """The table of the covariance, (n, n), of those of n parameters that are determined."""
    kept = [ids[i] for i in which]
    return pd.DataFrame(
        {
            "first": np.repeat(kept, len(kept)),
            "second": np.tile(kept, len(kept)),
            "covariance": covariance[np.ix_(which, which)].ravel(),
        }
    )


def stops_between_turns(plan: Sequence[Manoeuvre]) -> bool:
    """Whether several manoeuvres share a set position, as in S3's turns and stops."""
    return len({m.position for m in plan}) < len(plan)


def reasons(
    determined: Booleans, recorded: Booleans, sensor: str, cures: Mapping[str, str]
) -> dict[str, str]:
    """Why a parameter is not determined, and the manoeuvre that would determine it.

    Parameters
    ----------
    determined : (12,); recorded : (3,), which sensors are in the logs
    cures : the remedies for `bias` and for `matrix`, or for `matrix x` and so on, where {axis} is
        the axis of the input
    """
    result = {}
    for i, name in enumerate(NAMES):
        parts = PARTS[name]
        row = parts.sensor_axis
        if not recorded["xyz".index(row)]:
            result[name] = _(
                "the {row} {sensor} is not recorded, or masked", row=row, sensor=sensor
            )
        elif not determined[i]:
            kind = "bias" if parts.kind == "bias" else "matrix"
            cure = cures.get(f"{kind} {parts.input_axis}", cures[kind])
            result[name] = cure.format(axis=parts.input_axis)
    return result


def described(stage: str, name: str, *, by_hand: bool = False) -> tuple[str, str, str]:
    """Unit, frame and meaning of a parameter."""
    body = OF_TRIAD if by_hand else BODY
    kind, axes = PARTS[name]
    sensed, unit = SENSED[stage], UNIT[stage]
    sensor = "accelerometer" if stage == "accelerometer" else "gyro"
    if kind == "bias":
        return (
            unit,
            body,
            _("reading of the {axes} {sensor} without input", axes=axes, sensor=sensor),
        )
    if kind == "scale":
        return (
            "1",
            body,
            _(
                "scale factor error of the {axes} {sensor}: M_{axes}{axes} − 1",
                axes=axes,
                sensor=sensor,
            ),
        )
    if kind == "cross":
        return (
            "1",
            body,
            _(
                "the {axes} {sensor}'s response to {sensed} along {axes_2}",
                axes=axes[0],
                sensor=sensor,
                sensed=sensed,
                axes_2=axes[1],
            ),
        )
    if kind == "mounting":
        return (
            "rad",
            body,
            _(
                "rotation of the {sensor} triad against the case, about {axes}",
                sensor=sensor,
                axes=axes,
            ),
        )
    return (
        "1",
        "sensor triad",
        _("symmetric part of M without the mounting rotation, P_{axes} − I", axes=axes),
    )


def switch_on_columns(found: SwitchOns | None) -> Row:
    """What biases differ by between switch-ons, as columns of the table of fits."""
    row: Row = {"switch_ons": 1 if found is None else found.count}
    for i, axis in enumerate(AXES):
        for of in ("", "_sigma", "_upper"):
            value = np.nan if found is None else getattr(found, of[1:] or "value")[i]
            row[f"switch_on_{axis}{of}"] = finite_or_none(value)
    return row
