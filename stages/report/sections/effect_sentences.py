"""Effects in sentences: how certain the name is, what an effect in the model improves."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from math import inf, pi
from typing import Literal

from inertial.campaign.records import grouped
from inertial.sensors import PLURAL, SENSORS
from inertial.text import numbers
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import fixed, plus_minus, shortened, significant, whole
from inertial.text.units import DEGREES_PER_SECOND, PER_CENT, STANDARD_GRAVITY, Unit
from stages.report.results import Shift, quantity_of
from stages.report.tables import Record, Tables, once
from stages.report.words import with_mount

Kind = Literal["found", "class", "law", "structure", "consistent", "walk", "unexplained"]
# The clearest first, each with its words in a line.
GRADES: dict[Kind, str] = {
    "found": _("identified"),
    "class": _("one of a class"),
    "law": _("a law that no effect of the catalogue has"),
    "structure": _("not identified"),
    "consistent": _("consistent, not identified"),
    "walk": _("consistent, not identified"),
    "unexplained": _("not explained"),
}
MOST_MEMBERS = 8
RANDOM_WALKS = ("gyro_random_walk", "accel_random_walk")


@dataclass(frozen=True)
class Tested:
    """An effect of the catalogue that was tested: its score, and its parameters."""

    score: Record
    parameters: tuple[Record, ...]
    mount: str  # of which mount, where there are several

    @property
    def effect(self) -> str:
        """Its name in the catalogue."""
        return str(self.score["effect"])

    @property
    def name(self) -> str:
        """The effect in words."""
        return with_mount(in_words(self.effect), self.mount)

    @property
    def finding(self) -> str:
        """The identifier of the finding that names it; empty where none does."""
        return str(self.score["finding"] or "")


@once
def tested_effects(tables: Tables) -> list[Tested]:
    """Every effect with its parameters; of several mounts each by itself, as they come."""
    groups = grouped(tables.rows("effects"), lambda row: (row["mount"], row["effect"]))
    effects = []
    for score in tables.rows("scores"):
        mount, rows = score["mount"], groups.get((score["mount"], score["effect"]), [])
        first = [row for row in rows if row["finding"] == score["finding"]]
        effects.append(Tested(score, tuple(first or rows), mount))
    return effects


def tested_effect(tables: Tables, effect: str, mount: str) -> Tested | None:
    """An effect by its name in the catalogue and its mount."""
    by_name = {(effect.effect, effect.mount): effect for effect in tested_effects(tables)}
    return by_name.get((effect, mount))


def effect_of(tables: Tables, finding: Record) -> Tested | None:
    """The effect that a finding names; none of a second one of its kind."""
    effect = tested_effect(tables, finding["cause"], finding["mount"])
    return effect if effect is not None and effect.finding == finding["id"] else None


def kind_of(row: Record) -> Kind:
    """Of what kind a finding of criticism is."""
    if row["cause"] == "unexplained":
        return "unexplained"
    if row["cause"] in RANDOM_WALKS:
        return "walk"
    if row["cause"] == "unknown_structure":
        return "structure"
    verdicts: dict[str, Kind] = {"found": "found", "one_of_class": "class", "law": "law"}
    return verdicts.get(row.get("verdict") or "", "consistent")


def grade_of(row: Record) -> Kind:
    """The same; a random walk that may be an effect as well is one of a class."""
    kind = kind_of(row)
    return "class" if kind == "walk" and alternatives(row) else kind


def clearest_first(rows: Sequence[Record]) -> list[Record]:
    """Findings of criticism: what is identified, then what is less sure; within, by SNR."""
    order = list(GRADES)
    return sorted(
        rows, key=lambda row: (order.index(kind_of(row)), -(row.get("snr") or 0.0), row["id"])
    )


def name_of(row: Record) -> str:
    """What was found, in words, with its mount where there are several."""
    kind, sensors = kind_of(row), PLURAL.get(row["sensor"] or "", "")
    name = in_words(row["cause"])
    if sensors and kind == "structure":
        name = _("unidentified structure in the residuals of the {sensors}", sensors=sensors)
    if sensors and kind == "unexplained":
        name = _("unexplained residuals of the {sensors}", sensors=sensors)
    return with_mount(name, row["mount"])


def alternatives(row: Record) -> list[str]:
    """The effects that it may be instead, by name in the catalogue."""
    return [name for name in row.get("members") or () if name != row["cause"]][:MOST_MEMBERS]


def certainty(row: Record) -> str:
    """The degree of certainty in a sentence, and the significance."""
    names = [in_words(name) for name in (row["cause"], *alternatives(row))]
    sentence = {
        "found": _(
            "Identified: no other effect of the catalogue has the same signature in these data."
        ),
        "class": _(
            "One of a class: this campaign cannot distinguish {names}.", names=listed(names)
        ),
        "law": _(
            "The form is known, its physical cause is not: no effect of the catalogue has it. "
            "Laws that these data do not distinguish: {names}.",
            names=listed(names),
        ),
        "structure": _("Not identified: no effect of the catalogue explains this structure."),
        "consistent": _("Consistent with the data, but not identified: the name is not certain."),
        "walk": _(
            "Consistent with the data, but not identified: other slow changes have much the "
            "same signature."
        ),
        "unexplained": _("Not explained by any effect of the catalogue."),
    }[grade_of(row)]
    if row.get("snr"):
        sentence += _(" Signal-to-noise ratio: {snr}.", snr=numbers.significant(row["snr"], 3))
    if row["p_value"] is not None:
        sentence += _(
            " Probability under noise alone: {p_value}.", p_value=numbers.p_is(row["p_value"])
        )
    return sentence


def summary(rows: Sequence[Record]) -> Iterator[str]:
    """The unmodelled effects, a sentence for each degree of certainty; none where none are."""
    groups = {kind: [row for row in rows if kind_of(row) == kind] for kind in GRADES}
    if own := groups["found"]:
        yield _("Detected: {names}.", names=_distinct(map(name_of, own)))
    for row in groups["class"]:
        either = _or(name_of(row), row)
        yield _("Detected: {either}, which this campaign cannot distinguish.", either=either)
    for row in groups["law"]:
        yield str(row["sentence"])
    if own := groups["structure"]:
        yield _(
            "The residuals of the {own} have a structure that is not identified.", own=_sensors(own)
        )
    if own := groups["consistent"]:
        each = _distinct(_or(name_of(row), row) for row in own)
        yield _("Consistent with the data, but not identified: {each}.", each=each)
    for row in groups["walk"]:
        sentence = _("The biases of the {sensors} follow a random walk", sensors=_sensors([row]))
        if alternatives(row):
            sentence = _(
                "{sentence}, which this campaign cannot distinguish", sentence=_or(sentence, row)
            )
        yield f"{sentence}."
    if own := groups["unexplained"]:
        sensors = _sensors(own)
        yield _(
            "The residuals of the {sensors} exceed the noise, which no known effect explains.",
            sensors=sensors,
        )


def _distinct(names: Iterable[str]) -> str:
    return listed(list(dict.fromkeys(names)))


def _or(name: str, row: Record) -> str:
    return _(" or ").join([name, *map(in_words, alternatives(row))])


def _sensors(rows: Sequence[Record]) -> str:
    return _distinct(PLURAL.get(row["sensor"] or "", _("readings")) for row in rows)


# ---- what an effect in the model improves

MIN_SNR_SQUARED = 9.0  # below which held-out data do not test an effect: three sigma
FITTED, HELD_OUT = "fitted", "held-out"
MOTIONS = {"rest": _("at rest"), "turn": _("while it turns")}
ERRORS = (("attitude", "mrad"), ("velocity", "mm/s"))
PER_THOUSAND = 1e-3  # rad and m/s in mrad and mm/s


def about_effect(rows: Sequence[Record], effect: str, mount: str) -> list[Record]:
    """The rows of gain or decision that are about an effect, of one mount."""
    return [row for row in rows if (row["mount"] or "") == mount and effect in row["effects"]]


def reductions(effect: str, mount: str, gain: Sequence[Record]) -> Iterator[str]:
    """The reduction of χ² and of the residuals with an effect in the model."""
    own = about_effect(gain, effect, mount)
    for sensor in SENSORS:
        by_scope = {row["scope"]: row for row in own if row["sensor"] == sensor and not row["axis"]}
        if HELD_OUT in by_scope:
            yield _on_held_out(by_scope[HELD_OUT])
        if FITTED in by_scope:
            yield _("In the fit, χ² {by_scope}.", by_scope=_change(by_scope[FITTED]))
    for row in own:
        if row["unit"] != "sigma" and row["scope"] == HELD_OUT:
            gyro = _("{axis} gyro", axis=row["axis"]) if row["axis"] else PLURAL["gyro"]
            unit = DEGREES_PER_SECOND if row["unit"] == "rad/s" else Unit(row["unit"], 1.0)
            before, after = (
                significant(unit.of(row[f"rms_{at}"]), 3) for at in ("before", "after")
            )
            yield _(
                "The residuals of the {gyro} fall from {before} {unit} to {after} {unit} rms "
                "in held-out turns.",
                gyro=gyro,
                before=before,
                unit=shortened(unit.name, 20),
                after=after,
            )


def _on_held_out(row: Record) -> str:
    effects = row["effects"]
    if not row["counted"] and row["folds"]:
        return _(
            "No manoeuvre can be predicted from the others, so the improvement on held-out "
            "data is not known."
        )
    together = _(
        ", with {listed} in the model", listed=listed([in_words(name) for name in effects])
    )
    sentence = _(
        "On held-out data{value}, χ² of the {sensors} {row}",
        value=together if len(effects) > 1 else "",
        sensors=PLURAL[row["sensor"]],
        row=_change(row),
    )
    attainable = row["snr_squared"]
    if attainable is not None and attainable >= MIN_SNR_SQUARED:
        share = fixed(100 * row["drop"] / attainable, 1)
        sentence += _(", which captures {share} % of the attainable reduction", share=share)
    elif attainable is not None:
        sentence += _("; the attainable reduction is too small to judge it by")
    if row["not_counted"]:
        names = shortened(", ".join(row["not_counted"]), 200)
        sentence += _(
            "; not predicted, since the others hardly observe the effect: {names}", names=names
        )
    return f"{sentence}."


def _change(row: Record) -> str:
    size = abs(row["drop"])
    way = _("falls") if row["drop"] >= 0 else _("grows")
    return _(
        "{way} by {value} of {before}",
        way=way,
        value=whole(size) if size >= 100 else fixed(size, 1),
        before=whole(row["before"]),
    )


def worth(effects: Sequence[str], rows: Sequence[Record]) -> str:
    """What a user of the joint result loses by the effects, at rest and turning; or nothing."""
    joint: list[str] = []
    remaining: list[str] = []
    for motion, where in MOTIONS.items():
        own = [row for row in rows if row["motion"] == motion]
        shown = [pair for pair in ERRORS if any(row[f"{pair[0]}_joint"] for row in own)]
        if shown:
            pairs = [_largest(own, *pair) for pair in shown]
            errors = _(" and ").join(before for before, _unused in pairs)
            joint.append(_("{errors} {where}", errors=errors, where=where))
            errors = _(" and ").join(after for _unused, after in pairs)
            remaining.append(_("{errors} {where}", errors=errors, where=where))
    if not joint:
        return ""
    names = listed([in_words(name) for name in effects])
    due = _(", due to {names}", names=names) if len(effects) > 1 else ""
    return _(
        "After {seconds} s of free inertial navigation from a known attitude, the error "
        "with the joint result is up to {joint}{due}. With the extended result, all its terms "
        "taken off the readings, an uncertainty of at most {remaining} remains.",
        seconds=whole(rows[0]["seconds"]),
        joint=", ".join(joint),
        due=due,
        remaining=", ".join(remaining),
    )


def _largest(rows: Sequence[Record], what: str, unit: str) -> tuple[str, str]:
    """The largest error with the joint result, and what the extended one leaves there at most."""
    entry = max(rows, key=lambda row: float(row[f"{what}_joint"]))
    value, sigma = (entry[f"{what}_joint{more}"] / PER_THOUSAND for more in ("", "_sigma"))
    text = plus_minus(value, sigma, 1)
    remaining = max(row[f"{what}_extended"] for row in rows) / PER_THOUSAND
    return f"{text} {unit}", f"{significant(remaining, 2)} {unit}"


def largest_shift(shifts: Sequence[Shift]) -> str:
    """Which parameter of a sensor moves most with the effects in the model; or nothing."""
    moved = [(abs(shift.sigmas), shift) for shift in shifts if shift.sigmas is not None]
    if not moved:
        return ""
    _sigmas, most = max(moved, key=lambda pair: pair[0])
    assert most.joint is not None  # for it has moved
    unit = quantity_of(most.joint).shown
    before, after = (
        plus_minus(unit.of(row["value"]), sigma)
        for row in (most.joint, most.extended)
        for sigma in [unit.of(row["sigma"])]
    )
    return _(
        "Of all parameters, {name} changes most: from {before} to {after} {name_2}.",
        name=most.name,
        before=before,
        after=after,
        name_2=unit.name,
    )


# ---- How large an effect can be at most: what exceeds that is not undetected, but not observable.

LARGEST_ANGLE, LARGEST_SHARE = pi, 1.0  # rad; no error is larger
# Of gravity, or of the range of a gyro: no sensor that is worth a calibration reads that wrong.
LARGEST_ERROR = 0.5
POWERS = {  # by unit of an effect, of gravity in the reading of an axis that points up
    "m/s²": 0,
    "(m/s²)/(m/s²)²": 2,
    "(m/s²)/(m/s²)³": 3,
    "rad/s": 0,
    "(rad/s)/(m/s²)": 1,
    "(rad/s)/(m/s²)²": 2,
}
FULL_SCALE = "full_scale"  # of the gyros, rad/s, beside the columns of a detection limit
TOO_LARGE = _(
    "It would be seen here only if it changed a reading by more than half of gravity, or of the "
    "sensor's range"
)


def limits_of(tables: Tables) -> Iterator[Record]:
    """The detection limits, each with the range of the gyros where the campaign states one."""
    stated = [row[FULL_SCALE] for row in tables.rows("sensors") if row["sensor"] == "gyro"]
    full_scale = min(filter(None, stated), default=None)
    return (row | {FULL_SCALE: full_scale} for row in tables.rows("detection_limits"))


def largest(row: Record) -> float:
    """The largest size that is possible of an effect, in the unit of the row."""
    if quantity_of(row).shown == PER_CENT:
        return LARGEST_SHARE
    unit = row["unit"]
    if unit == "rad":
        return LARGEST_ANGLE
    if unit not in POWERS:
        return inf
    most = STANDARD_GRAVITY if unit.startswith(("m/s²", "(m/s²)")) else row.get(FULL_SCALE) or inf
    return float(LARGEST_ERROR * most / STANDARD_GRAVITY ** POWERS[unit])


def possible(row: Record) -> bool:
    """Whether an effect of the size of a limit can be: at the place where it shows best at least.

    A share or an angle that cannot be is said in the row of its effect.
    """
    if row["unit"] not in POWERS:
        return True
    return bool(min(filter(None, (row["limit"], row["smallest"]))) <= largest(row))


def observable(rows: Sequence[Record], visible: str) -> bool:
    """Whether an effect can be seen, by its detection limits; one without any is sought elsewhere.

    visible : the reason of a limit that the data have
    """
    seen = [row for row in rows if row["reason"] == visible and row["limit"] is not None]
    return not seen or any(map(possible, seen))
