"""The parameters by every method, which results are final, and how a parameter is written."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from inertial.campaign.final_result import extended_sensors, of_sensors
from inertial.campaign.records import Part, parts_of
from inertial.tables import AXES
from inertial.text import numbers, units
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.parameters import EXTENDED, JOINT, PARTS, SENSOR_OF, STAGES
from stages.report.linked import DECISION_TABLES, decisions
from stages.report.outline import Tone
from stages.report.tables import Record, Tables, once
from stages.report.words import SENSOR_OF_STAGE, capital, sensor_of_stage, with_mount

ESTIMATE_TABLES = (
    "accelerometer_parameters",
    "accelerometer_fit",
    "accelerometer_fit_manoeuvres",
    "gyroscope_parameters",
    "gyroscope_fit",
    "gyroscope_fit_manoeuvres",
)
EXTENDED_TABLES = ("extended_parameters", "extended_fit", "extended_fit_manoeuvres")
RESULT_TABLES = (*ESTIMATE_TABLES, *EXTENDED_TABLES, *DECISION_TABLES)
FREE = "free_positions"
METHOD = {
    JOINT: _("joint fit of all manoeuvres"),
    "six_position": _("six positions, S0"),
    FREE: _("static positions of unknown attitude, by |f| = g"),
    "up_and_down": _("two positions with tilt, S1"),
    "pooled_positions": _("static positions at one attitude pooled, S3"),
    "static": _("static positions up and down, S0"),
    "turns": _("turns forward and backward, S0"),
    "turn_and_stop": _("turn and stop, S3: M, and the bias by turns"),
    "stops": _("turn and stop, S3: the bias by static positions"),
    "rate_table": _("rate table, S4"),
}
KIND = {
    "bias": "Bias",
    "scale": _("Scale error"),
    "cross": _("Cross-axis terms"),
    "mounting": _("Mounting rotation of the sensor triad against the case"),
    "symmetric": _("Non-orthogonality: the symmetric part P of M = P R"),
}
SYMBOL = {"bias": "b", "scale": "s", "cross": "m", "mounting": "ρ", "symmetric": "p"}
CALIBRATION = frozenset(
    [f"{kind}_{axis}" for kind in ("bias", "scale") for axis in AXES]
    + [f"cross_{row}{column}" for row in AXES for column in AXES if row != column]
)
MIN_P = 0.01  # of a fit that describes its data
MISFIT = _("the model does not describe the data within the noise; the σ include noise only")


@dataclass(frozen=True)
class Estimate:
    """The parameters that one method estimated on a mount, with its fit and its manoeuvres.

    `stage`: the one that estimates its sensor, also of an extended result.
    """

    stage: str
    method: str
    mount: str = ""
    parameters: tuple[Record, ...] = ()
    fit: Record | None = None
    manoeuvres: tuple[Part, ...] = ()

    @property
    def place(self) -> tuple[str, str]:
        """The stage of its sensor, and its mount."""
        return self.stage, self.mount

    @property
    def sensor(self) -> str:
        """The sensor in words, with the mount where there are several."""
        return with_mount(sensor_of_stage(self.stage), self.mount)

    @property
    def name(self) -> str:
        """Sensor and method in words."""
        return f"{self.sensor}, {METHOD.get(self.method, self.method)}"

    @property
    def determined(self) -> list[Record]:
        """The parameters that have a value."""
        return [row for row in self.parameters if row["value"] is not None]

    @property
    def calibration(self) -> dict[str, Record]:
        """Those of the twelve parameters of a sensor that have a value, by name."""
        own = {row["parameter"]: row for row in self.determined}
        return {name: row for name, row in own.items() if name in CALIBRATION}

    @property
    def misfit(self) -> bool:
        """Whether the residuals are larger than the noise allows."""
        p_value = self.fit["p_value"] if self.fit else None
        return p_value is not None and bool(p_value < MIN_P)

    def fit_in_words(self) -> tuple[str, Tone]:
        """Whether the model describes the data, plainly; nothing where no fit was made."""
        fit = self.fit
        if fit is None:
            return "", ""
        p_is = numbers.p_is(fit["p_value"])
        if not self.misfit:
            if not fit["degrees"]:
                return _("no degree of freedom is left to test the model"), "fair"
            return _("the model describes the data within the noise ({p_is})", p_is=p_is), "good"
        if not (fit["scatter"] or fit["random_walk"]):
            return f"{MISFIT} ({p_is})", "poor"
        if not fit["scatter"]:
            return (
                _(
                    "noise alone does not describe the data ({p_is}), noise and a random walk of "
                    "the bias do",
                    p_is=p_is,
                )
            ), "fair"
        unit = units.quantity("bias", fit["unit"]).laboratory
        scatter = f"{numbers.significant(unit.of(fit['scatter']), 2)} {unit.name}"
        return (
            _(
                "the model does not describe the data within the noise ({p_is}); manoeuvres "
                "scatter by {scatter} beyond it, which the σ include",
                p_is=p_is,
                scatter=scatter,
            )
        ), "poor"


@once
def estimates(tables: Tables) -> list[Estimate]:
    """Every method of both sensors, in the order of the tables; a fit without parameters too."""
    return [estimate for stage in SENSOR_OF_STAGE for estimate in _estimates(tables, stage)]


def _estimates(tables: Tables, of: str) -> Iterator[Estimate]:
    """The estimates in the tables of one stage; effects in the model left out."""
    names = (f"{of}_parameters", f"{of}_fit", f"{of}_fit_manoeuvres")
    rows, fits, parts = (_grouped(tables.rows(name)) for name in names)
    for key in dict.fromkeys([*rows, *fits]):
        sensor, mount, method = key
        own = by_kind(row for row in rows.get(key, ()) if row["effect"] is None)
        fit = next(iter(fits.get(key, ())), None)
        used = parts_of(parts.get(key, ()))
        yield Estimate(STAGES[sensor], method, mount, tuple(own), fit, tuple(used))


def _grouped(rows: Iterable[Record]) -> dict[tuple[str, str, str], list[Record]]:
    """The rows by sensor, mount and method."""
    groups: dict[tuple[str, str, str], list[Record]] = {}
    for row in rows:
        groups.setdefault((row["sensor"], row["mount"], row["method"]), []).append(row)
    return groups


@once
def extended_estimates(tables: Tables) -> list[Estimate]:
    """The results with the likeliest effects, one for each sensor and mount; these left out."""
    return [
        estimate
        for estimate in _estimates(tables, EXTENDED)
        if estimate.parameters and estimate.method == EXTENDED
    ]


@once
def replaced_sensors(tables: Tables) -> set[tuple[str, str]]:
    """The sensors and mounts whose extended result is the final one."""
    return extended_sensors(tables.rows("verdict"))


def is_replaced(tables: Tables, estimate: Estimate) -> bool:
    """Whether the extended result is final in place of this joint one."""
    place = SENSOR_OF[estimate.stage], estimate.mount
    return estimate.method == JOINT and place in replaced_sensors(tables)


@once
def final_results(tables: Tables) -> list[Estimate]:
    """The final results of both sensors, one per mount; an empty one where there is none.

    They are of the joint fits, or of those with effects in the model. Where no attitude is known,
    the fit to static positions of unknown attitude takes its place.
    """
    extended = {result.place: result for result in extended_estimates(tables)}
    each = estimates(tables)
    free = {result.place: result for result in each if result.method == FREE}
    final = [
        extended.get(result.place, result) if is_replaced(tables, result) else result
        for result in each
        if result.method in (JOINT, EXTENDED)
    ]
    final = [result if result.determined else free.get(result.place, result) for result in final]
    missing = [stage for stage in SENSOR_OF_STAGE if all(result.stage != stage for result in final)]
    final += [Estimate(stage, JOINT) for stage in missing]
    return sorted(final, key=lambda result: list(SENSOR_OF_STAGE).index(result.stage))


def effects_in(tables: Tables, estimate: Estimate) -> list[str]:
    """The effects in the model of an estimate, in words; none of a joint fit."""
    if estimate.method != EXTENDED:
        return []
    own = of_sensors(decisions(tables), [(SENSOR_OF[estimate.stage], estimate.mount)])
    return [in_words(name) for row in own for name in row["effects"]]


@dataclass(frozen=True)
class Shift:
    """A parameter by the extended and by the joint fit."""

    extended: Record
    joint: Record | None

    @property
    def sigmas(self) -> float | None:
        """How far apart they are, in sigmas of the joint fit; none where one has no value."""
        new, old = self.extended, self.joint
        if old is None or new["value"] is None or not old["sigma"]:
            return None
        return float((new["value"] - old["value"]) / old["sigma"])

    @property
    def name(self) -> str:
        """The parameter in words, a sentence beginning with it."""
        kind, axes = PARTS[self.extended["parameter"]]
        return capital(
            _(
                "{lower} {axes} of the {lower_2}",
                lower=KIND.get(kind, kind).lower(),
                axes=axes,
                lower_2=self.sensor.lower(),
            )
        )

    @property
    def sensor(self) -> str:
        """The sensor in words, with the mount where there are several."""
        stage = STAGES[self.extended["sensor"]]
        return with_mount(sensor_of_stage(stage), self.extended["mount"])


@once
def shifts(tables: Tables) -> dict[tuple[str, str], list[Shift]]:
    """Each parameter of the extended model with its like in the joint fit, by sensor and mount."""
    joint = {
        (*estimate.place, row["parameter"]): row
        for estimate in estimates(tables)
        if estimate.method == JOINT
        for row in estimate.determined
    }
    return {
        (SENSOR_OF[estimate.stage], estimate.mount): [
            Shift(row, joint.get((*estimate.place, row["parameter"])))
            for row in estimate.parameters
        ]
        for estimate in extended_estimates(tables)
    }


# ---- how a parameter is written


def kind_of(parameter: str) -> str:
    """What a parameter is one of: bias, scale, cross, mounting, symmetric."""
    return PARTS[parameter].kind if parameter in PARTS else parameter


def by_kind(rows: Iterable[Record]) -> list[Record]:
    """Bias first, then scale, cross-axis terms and the rest; within, as they come."""
    order = {kind: place for place, kind in enumerate(KIND)}
    return sorted(rows, key=lambda row: order.get(kind_of(row["parameter"]), len(order)))


def symbol(parameter: str) -> str:
    """The parameter's sign with its axes: b_x, s_x, m_xy; its name where it has none."""
    if parameter not in PARTS:
        return parameter
    kind, axes = PARTS[parameter]
    return f"{SYMBOL[kind]}_{axes}"


def quantity_of(row: Record) -> units.Quantity:
    """The units that a parameter is written in."""
    return units.quantity(row["parameter"], row["unit"])


def written(group: Sequence[Record]) -> list[tuple[str, ...]]:
    """Value and sigma of parameters of one kind, in the laboratory's unit and in the SI's."""
    quantities = [quantity_of(row) for row in group]
    laboratory = in_units(group, [quantity.laboratory for quantity in quantities])
    si = in_units(group, [quantity.si for quantity in quantities])
    return [(*pair, *si_pair) for pair, si_pair in zip(laboratory, si, strict=True)]


def in_units(group: Sequence[Record], each: Sequence[units.Unit]) -> list[tuple[str, str]]:
    """Values and sigmas, with common decimals where the unit is the same."""
    sigmas = [unit.of(row["sigma"]) for row, unit in zip(group, each, strict=True)]
    by_unit: dict[str, list[float | None]] = {}
    for sigma, unit in zip(sigmas, each, strict=True):
        by_unit.setdefault(unit.name, []).append(sigma)
    decimals = {name: numbers.common_decimals(those) for name, those in by_unit.items()}
    return [
        numbers.with_sigma(unit.of(row["value"]), sigma, decimals[unit.name])
        for row, sigma, unit in zip(group, sigmas, each, strict=True)
    ]
