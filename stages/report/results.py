"""The result that counts, the parameters by every method, and where each number comes from."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from inertial.campaign.log_lines import LogLines, RecordRange, UsedPhase, lines_of, used_phases
from inertial.campaign.records import Part, grouped, omissions, parts_of
from inertial.text import numbers, units
from inertial.text.messages import _
from inertial.text.parameters import (
    EXTENDED,
    JOINT,
    MIXTURE,
    PARTS,
    SENSOR_OF,
    STAGES,
    WITHOUT_ONE,
    sign_of,
)
from stages.report.outline import Tone
from stages.report.tables import DECISION_TABLES, Record, Tables, once
from stages.report.words import SENSOR_OF_STAGE, sensor_of_stage, term, with_mount

OF_ESTIMATES = ("parameters", "fit", "fit_manoeuvres")
ESTIMATE_TABLES = tuple(f"{stage}_{name}" for stage in SENSOR_OF_STAGE for name in OF_ESTIMATES)
EXTENDED_TABLES = tuple(f"{EXTENDED}_{name}" for name in OF_ESTIMATES)
RESULT_TABLES = (*ESTIMATE_TABLES, *EXTENDED_TABLES, *DECISION_TABLES, "result")
WITH_EFFECTS = _("fit with effects in the model")  # also by the other members of a class
METHOD = {
    JOINT: _("joint fit of all manoeuvres"),
    EXTENDED: WITH_EFFECTS,
    WITHOUT_ONE: _("joint fit without the manoeuvre that alone is disturbed"),
    MIXTURE: _("mean over the models that these data do not distinguish, by their probability"),
    "six_position": _("six positions, closed formula"),
    "free_positions": _("static positions of unknown attitude, by |f| = g"),
    "up_and_down": _("two positions with tilt"),
    "pooled_positions": _("static positions at one attitude pooled, Han & Fu 2019"),
    "static": _("static positions up and down, closed formula"),
    "turns": _("turns forward and backward, closed formula"),
    "turn_and_stop": _("turn and stop, Han & Fu 2019: M, and the bias by turns"),
    "stops": _("turn and stop, Han & Fu 2019: the bias by static positions"),
    "rate_table": _("rate table, Beihang University 2013"),
}
KIND = {
    "bias": _("Bias"),
    "scale": _("Scale error"),
    "cross": _("Cross-axis terms"),
    "mounting": _("Mounting rotation of the sensor triad against the case"),
    "symmetric": _("Non-orthogonality: the symmetric part P of M = P R"),
}
KIND_IN_A_SENTENCE = {"bias": _("bias"), "scale": _("scale error"), "cross": _("cross-axis terms")}
CALIBRATION = frozenset(
    name for name, parts in PARTS.items() if parts.kind in ("bias", "scale", "cross")
)
STATIC_SCALE = _(
    "At rest a gyro senses the earth's rate alone, 15 °/h at most along its axis: an error of 0.1 "
    "°/h of a mean, by noise, by a tilt or by a bias that depends on the attitude, is one of about "
    "a per cent of the scale factor. The scale factors by static positions therefore have a σ of "
    "per cents, and those by turns one of ppm."
)
Key = tuple[str, str, str]  # sensor, mount and method
MIN_P = 0.01  # of a fit that describes its data
MISFIT = _("the model does not describe the data within the noise; the σ include noise only")


@dataclass(frozen=True)
class Estimate:
    """The parameters that one method estimated on a mount, with its fit and its manoeuvres.

    `stage`: the one that estimates its sensor, also of an extended result; `effects`: parameters of
    the effects in the model of the result that counts.
    """

    stage: str
    method: str
    mount: str = ""
    parameters: tuple[Record, ...] = ()
    fit: Record | None = None
    manoeuvres: tuple[Part, ...] = ()
    effects: tuple[Record, ...] = ()

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
        other = WITH_EFFECTS if self.method.startswith("member_") else self.method
        return f"{self.sensor}, {METHOD.get(self.method, other)}"

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
                    "the bias, which this χ² allows for, do",
                    p_is=p_is,
                )
            ), "fair"
        unit = units.quantity("bias", fit["unit"]).shown
        scatter = f"{numbers.significant(unit.of(fit['scatter']), 2)} {unit.name}"
        if fit["scatter_seconds"]:
            scatter = _(
                "{scatter} in a rest of {seconds} s and less in a longer one",
                scatter=scatter,
                seconds=numbers.significant(fit["scatter_seconds"], 2),
            )
        return (
            _(
                "with a scatter of the manoeuvres by {scatter}, which this χ² and the σ allow for; "
                "noise alone does not describe the data ({p_is})",
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
    rows = _grouped(tables.rows(f"{of}_parameters"))
    fits, parts = _fits(tables, of), _fit_manoeuvres(tables, of)
    for key in dict.fromkeys([*rows, *fits]):
        sensor, mount, method = key
        own = by_kind(row for row in rows.get(key, ()) if row["effect"] is None)
        used = parts_of(parts.get(key, ()))
        yield Estimate(STAGES[sensor], method, mount, tuple(own), fits.get(key), tuple(used))


def _fits(tables: Tables, *stages: str) -> dict[Key, Record]:
    """The rows of the fits of some stages by sensor, mount and method."""
    rows = [row for of in stages for row in tables.rows(f"{of}_fit")]
    return {key: own[0] for key, own in _grouped(rows).items()}


def _fit_manoeuvres(tables: Tables, *stages: str) -> dict[Key, list[Record]]:
    """The rows of the manoeuvres of these fits."""
    return _grouped(row for of in stages for row in tables.rows(f"{of}_fit_manoeuvres"))


def _grouped(rows: Iterable[Record]) -> dict[Key, list[Record]]:
    """The rows by sensor, mount and method."""
    return grouped(rows, lambda row: (row["sensor"], row["mount"], row["method"]))


@once
def extended_estimates(tables: Tables) -> list[Estimate]:
    """The results with the likeliest effects, one for each sensor and mount; these left out."""
    return [
        estimate
        for estimate in _estimates(tables, EXTENDED)
        if estimate.parameters and estimate.method == EXTENDED
    ]


@once
def final_results(tables: Tables) -> list[Estimate]:
    """The result that counts of each sensor and mount, as the diagnosis chose it.

    Its fit is that of the method it was taken from; a mixture has none. A sensor without a result
    has an empty one.
    """
    rows = _grouped(tables.rows("result"))
    fits = _fits(tables, *SENSOR_OF_STAGE, EXTENDED)
    parts = _fit_manoeuvres(tables, *SENSOR_OF_STAGE, EXTENDED)
    final = [
        Estimate(
            STAGES[sensor],
            method,
            mount,
            tuple(by_kind(row for row in own if row["effect"] is None)),
            fits.get((sensor, mount, method)),
            tuple(parts_of(parts.get((sensor, mount, method), ()))),
            tuple(row for row in own if row["effect"] is not None),
        )
        for (sensor, mount, method), own in rows.items()
    ]
    missing = [stage for stage in SENSOR_OF_STAGE if all(result.stage != stage for result in final)]
    final += [Estimate(stage, JOINT) for stage in missing]
    return sorted(final, key=lambda result: list(SENSOR_OF_STAGE).index(result.stage))


@once
def withheld(tables: Tables) -> frozenset[tuple[str, str]]:
    """The sensors, by stage and mount, whose result a cause spoils, so that it has no values.

    The reason of each of its parameters is the verdict then.
    """
    verdicts = {(row["sensor"], row["mount"]): row["sentence"] for row in tables.rows("verdict")}
    spoilt = {
        (row["sensor"], row["mount"])
        for row in tables.rows("result")
        if row["value"] is None and row["reason"] == verdicts.get((row["sensor"], row["mount"]))
    }
    return frozenset((STAGES[sensor], mount) for sensor, mount in spoilt)


@dataclass(frozen=True)
class Shift:
    """A parameter by the extended and by the joint fit."""

    extended: Record
    joint: Record | None

    @property
    def sigmas(self) -> float | None:
        """How far apart they are, in sigmas of the extended fit; none where one has no value."""
        sigma, value = self.extended["sigma"], self.extended["value"]
        if self.joint is None or self.joint["value"] is None or value is None or not sigma:
            return None
        return float((value - self.joint["value"]) / sigma)

    @property
    def name(self) -> str:
        """The parameter in words, within a sentence."""
        kind, axes = PARTS[self.extended["parameter"]]
        return _(
            "{lower} {axes} of the {lower_2}",
            lower=KIND.get(kind, kind).lower(),
            axes=axes,
            lower_2=self.sensor.lower(),
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
    return term(sign_of(_without_effect(parameter)))


def quantity_of(row: Record) -> units.Quantity:
    """The units that a parameter is written in."""
    return units.quantity(_without_effect(row["parameter"]), row["unit"])


def _without_effect(parameter: str) -> str:
    """The own name of a parameter of an effect, which the result has behind that of the effect."""
    return parameter.rpartition(".")[2]


def written(group: Sequence[Record]) -> list[tuple[str, str]]:
    """Value and sigma of parameters of one kind, with common decimals."""
    return in_units(group, [quantity_of(row).shown for row in group])


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


# ---- Where a number comes from: the stage and method that estimated it, its settings, its data.

READS = (*RESULT_TABLES, "blocks", "manoeuvres", "masks", "samples")


def origins(tables: Tables) -> dict[str, list[str]]:
    """In sentences, by the identifiers of the numbers without their last word."""
    every = [*final_results(tables), *estimates(tables)]
    phases = {id(estimate): _used(tables, estimate) for estimate in every}
    ranges = {phase.records for used in phases.values() for phase in used}
    lines = lines_of(tables.stream("samples"), sorted(ranges, key=lambda own: own.first))
    return {
        row["id"].rpartition("/")[0]: list(
            _sentences(tables, estimate, phases[id(estimate)], lines)
        )
        for estimate in every
        for row in (*estimate.parameters, *estimate.effects)
    }


def _used(tables: Tables, estimate: Estimate) -> list[UsedPhase]:
    used = [part for part in estimate.manoeuvres if not part.reason]
    return used_phases(used, *(tables.frame(name) for name in ("blocks", "manoeuvres", "masks")))


def _sentences(
    tables: Tables,
    estimate: Estimate,
    used: list[UsedPhase],
    lines: dict[RecordRange, LogLines],
) -> Iterator[str]:
    yield estimate.name
    row = next(iter((*estimate.parameters, *estimate.effects)))
    of_result = row["stage"] == "diagnosis"
    estimated = "extended" if of_result and estimate.method != JOINT else estimate.stage
    maker = tables.maker(f"{estimated}_parameters")
    settings = ", ".join(f"{name} {value}" for name, value in maker["settings"].items())
    yield _(
        "Estimated by stage {stage}; settings: {settings}",
        stage=maker["stage"],
        settings=settings or "–",
    )
    if used:
        yield _("From: {places}", places="; ".join(_place(phase, lines) for phase in used))
    if left_out := omissions(estimate.manoeuvres):
        yield _("Left out: {left_out}", left_out=numbers.shortened(left_out, 600))
    yield _("In full, with every hash: make trace ID={id}", id=row["id"].rpartition("/")[0] + "/…")


def _place(phase: UsedPhase, lines: dict[RecordRange, LogLines]) -> str:
    where = lines.get(phase.records)
    if where is None:
        return phase.label
    return _(
        "{label}: {log}, {kind} {first}–{last}",
        label=phase.label,
        log=phase.records.log,
        kind=_("lines") if where.of_text else _("rows"),
        first=where.from_line,
        last=where.to_line,
    )
