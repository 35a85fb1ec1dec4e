"""Effects as tables: their parameters, the extended result, detection limits, structure tests."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from inertial.campaign.records import grouped
from inertial.sensors import SINGULAR
from inertial.text import numbers
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.typography import capital
from stages.report import outline
from stages.report.results import (
    KIND,
    Shift,
    in_units,
    kind_of,
    quantity_of,
    shifts,
    symbol,
    written,
)
from stages.report.sections.effect_sentences import (
    LARGEST_SHARE,
    TOO_LARGE,
    Tested,
    largest,
    possible,
)
from stages.report.sections.effect_terms import is_scanned, meanings_of
from stages.report.tables import Record, Tables
from stages.report.words import THERE_OR_NOT, count_in_words, with_mount

MIN_SIGMAS = 3.0  # from which a parameter is listed and a shift is marked
VISIBLE = "visible"
Effect = tuple[str, str]  # its name in the catalogue, and the mount
NOTICED, NOT_NOTICED = _("would be noticed"), _("would not be noticed")
NOT_DETECTABLE = _("not detectable here")
MIN_CLOCK_SHARE = 1e-6  # of a frequency: no clock of a log is known to less
LEAST_MOVE = 0.1  # sigma; how much less does not matter
TESTS = {
    "time": _("time"),
    "angle": _("the angle of the table"),
    "rate": _("the rate of the turns"),
    "attitude": _("the attitude"),
    "temperature": _("the temperature"),
    "change": _("a change in time"),
}

# ---- parameters of an effect


def parameters(caption: str, rows: Sequence[Record]) -> outline.Table:
    """Those beyond 3 σ; how many others there are."""
    clear = [row for row in rows if _clear(row)]
    known = [_by_clock(row) for row in clear]
    others = sum(row["value"] is not None and bool(row["sigma"]) for row in rows) - len(clear)
    gaps = sum(row["value"] is None for row in rows)
    notes = [
        _("{others} within 3 σ of zero not listed", others=numbers.counted(others, "parameter"))
    ] * bool(others)
    notes += [_("{gaps} not determined", gaps=numbers.counted(gaps, "parameter"))] * bool(gaps)
    return outline.Table(
        caption,
        (
            outline.Column(_("symbol"), "symbol"),
            *outline.value_and_sigma(unit=True),
            outline.Column(_("in σ"), "number"),
            outline.Column(_("Meaning"), "note"),
        ),
        [_parameter(*both) for both in zip(known, written(known), strict=True)],
        _("None individually: the parameters are significant only together."),
        capital("; ".join(notes) + ".") if notes else "",
    )


def _clear(row: Record) -> bool:
    value, sigma = row["value"], row["sigma"]
    return value is not None and bool(sigma) and bool(abs(value) > MIN_SIGMAS * sigma)


def _by_clock(row: Record) -> Record:
    """A frequency with a sigma no smaller than a clock's; any other parameter as it is."""
    if row["unit"] != "Hz":
        return row
    return row | {"sigma": max(row["sigma"], MIN_CLOCK_SHARE * abs(row["value"]))}


def _parameter(row: Record, cells: Sequence[str]) -> outline.Row:
    return outline.table_row(
        symbol(row["parameter"]),
        *(*cells, quantity_of(row).shown.name),
        _in_sigmas(row),
        numbers.shortened(row["meaning"] or "", 160),
        anchor=row["id"],
    )


def _in_sigmas(row: Record) -> str:
    """How far it is from zero; of a time or a frequency that says nothing."""
    if row["unit"] == "Hz" or is_scanned(row["effect"], row["parameter"]):
        return ""
    return numbers.significant(row["value"] / row["sigma"], 3)


# ---- the extended result


def extended(tables: Tables) -> Iterator[outline.Part]:
    """The joint fit beside the extended one, a table for each sensor that shows an effect."""
    by_sensor = shifts(tables)
    if by_sensor:
        yield outline.Heading(_("Parameters with the effects in the model"))
    for own in by_sensor.values():
        yield outline.Table(
            _(
                "{sensor}: the joint fit, and the fit with the effects in the model; the shift is "
                "in σ of the latter.",
                sensor=own[0].sensor,
            ),
            (
                outline.Column(_("symbol"), "symbol"),
                *outline.value_and_sigma(_("Joint fit")),
                *outline.value_and_sigma(_("Extended")),
                outline.Column(_("unit"), "unit"),
                outline.Column(_("shift, in σ"), "number"),
                outline.Column(_("Meaning"), "note"),
            ),
            list(_shifts(own)),
            note=_(
                "The joint fit allows for a scatter between manoeuvres where it needs one, and "
                "weighs them otherwise; by how much an effect that is left out shifts a parameter "
                "with all weights unchanged is stated in “What is wrong, and what was done”."
            ),
        )


def _shifts(each: Sequence[Shift]) -> Iterator[outline.Row]:
    cells: list[tuple[str, str]] = []
    kinds = grouped(each, lambda shift: kind_of(shift.extended["parameter"]))
    for own in kinds.values():
        gap = {"value": None, "sigma": None}
        both = [r for shift in own for r in (shift.extended, shift.joint or shift.extended | gap)]
        units = [quantity_of(shift.extended).shown for shift in own for _ in range(2)]
        cells += in_units(both, units)
    extended, joint = cells[::2], cells[1::2]
    sides = [column for side in (joint, extended) for column in zip(*side, strict=True)]
    lines = iter(zip(*sides, strict=True))
    for kind, own in kinds.items():
        yield outline.head(KIND.get(kind, kind))
        for shift, line in zip(own, lines, strict=False):
            far = shift.sigmas is not None and abs(shift.sigmas) > MIN_SIGMAS
            yield outline.table_row(
                symbol(shift.extended["parameter"]),
                *line,
                quantity_of(shift.extended).shown.name,
                numbers.fixed(shift.sigmas, 1),
                numbers.shortened(shift.extended["meaning"], 160),
                anchor=shift.extended["id"],
                tone="fair" if far else "",
            )


# ---- detection limits


def detection_limits(rows: Sequence[Record], tested: Sequence[Tested]) -> Iterator[outline.Table]:
    """What would have been detected, an effect a row; and what not, by the reason.

    `tested`: the effects that no finding names.
    """
    by_name = {(effect.effect, effect.mount): effect for effect in tested}
    own = [row for row in rows if _effect(row) in by_name]
    seen = visible_limits(rows, tested)
    hidden = [
        row
        if row["reason"] != VISIBLE or row["limit"] is None
        else row | {"explanation": TOO_LARGE}
        for row in own
        if row not in seen
    ]
    # An effect that is not sought in equations and turns: its score says how.
    hidden += [
        {
            "effect": effect.effect,
            "mount": effect.mount,
            "parameter": "",
            "explanation": effect.score["sentence"],
        }
        for name, effect in by_name.items()
        if name not in {_effect(row) for row in own}
    ]
    yield outline.Table(
        _(
            "Of each effect that was tested and not detected, the size that would stand out by "
            "5 σ, along the least and the most sensitive axis. Of effects as large as that about "
            "two in three are detected, of those at 8 σ nearly all."
        ),
        (
            outline.Column(_("Effect")),
            outline.Column(_("worst axis"), "number", _("Limit (5 σ)")),
            outline.Column(_("best axis"), "number", _("Limit (5 σ)")),
            outline.Column(_("unit"), "unit", _("Limit (5 σ)")),
            outline.Column(_("symbol"), "symbol", _("Parameter of the worst axis")),
            outline.Column(_("meaning"), "note", _("Parameter of the worst axis")),
            outline.Column(_("in σ"), "number", _("Shift if undetected")),
            outline.Column(_("of"), "symbol", _("Shift if undetected")),
            outline.Column("p", "number"),
        ),
        [
            _limit(by_name[name], list(group), own)
            for (name, _), group in groupby(seen, lambda row: (_effect(row), row["unit"]))
        ],
        _("None: every effect that this campaign makes observable was detected."),
        " ".join(
            [
                _(
                    "p: the probability that noise alone makes the largest of all tested effects "
                    "this significant (corrected for the number of tests, so it is often 1)."
                ),
                _(
                    "Shift if undetected: the parameter that an effect as large as its "
                    "detection limit moves most, by how many of its sigmas, which hold no effect "
                    "that is not named (external reliability, Baarda 1968); b: bias, s: scale "
                    "error, m_ij: cross-axis term of sensor i to an input along axis j."
                ),
                *_remarks(seen, by_name),
            ]
        ),
    )
    if hidden:
        yield outline.Table(
            _(
                "Effects that this campaign does not make observable, or that are "
                "reported elsewhere. Parameters in brackets: of these alone it is said; of the "
                "others of the same effect the table above states the limit."
            ),
            outline.columns("text", _("Reason"), _("Effects")),
            list(_hidden(hidden, [*seen, *hidden])),
        )


def visible_limits(rows: Sequence[Record], tested: Sequence[Tested]) -> list[Record]:
    """The detection limits of those effects that the campaign makes observable."""
    names = {(effect.effect, effect.mount) for effect in tested}
    return [
        row
        for row in rows
        if _effect(row) in names
        and row["reason"] == VISIBLE
        and row["limit"] is not None
        and possible(row)
    ]


def shifts_beyond(
    rows: Sequence[Record], tested: Sequence[Tested], sigmas: float
) -> tuple[int, int]:
    """How many effects, as large as their limit, shift a parameter by more than `sigmas` of it.

    The second number: of how many it is known.
    """
    by_effect = grouped(visible_limits(rows, tested), _effect)
    most = [limit["moves"] for own in by_effect.values() if (limit := moves_most(own))]
    return sum(moves > sigmas for moves in most), len(most)


def _remarks(rows: Sequence[Record], by_name: Mapping[Effect, Tested]) -> Iterator[str]:
    """What is said of single effects, each with its name."""
    for effect in dict.fromkeys(map(_effect, rows)):
        remarks = dict.fromkeys(row["remark"] or "" for row in rows if _effect(row) == effect)
        if text := numbers.shortened(" ".join(remarks).strip(), 300):
            yield f"{capital(by_name[effect].name)}: {text}"


def _effect(row: Record) -> Effect:
    return row["effect"], row["mount"]


def _limit(tested: Tested, rows: Sequence[Record], every: Sequence[Record]) -> outline.Row:
    """Of one effect, with its parameters where it is not observable by all of them."""
    name = _named(_effect(rows[0]), [row["parameter"] for row in rows], every)
    rows = sorted(rows, key=lambda row: -(row["largest"] or row["limit"]))
    first = rows[0]
    noticed = NOTICED if first["limit"] <= LARGEST_SHARE else NOT_NOTICED
    sizes = (noticed, "", "") if tested.effect in THERE_OR_NOT else _sizes(rows)
    return outline.table_row(
        capital(name),
        *sizes,
        *(_parameter_of(tested, first["parameter"]) if sizes[-1] else ("", "")),
        *_moves(rows),
        numbers.probability(tested.score["p_value"]),
        anchor="/".join(("limit", *filter(None, _effect(first)), first["parameter"])),
    )


def moves_most(rows: Sequence[Record]) -> Record | None:
    """The limit of these rows of one effect at which it moves a parameter most, where known."""
    if rows[0]["effect"] in THERE_OR_NOT:
        return None
    known = [row for row in rows if row["moves"] is not None and row["limit"] <= largest(row)]
    return max(known, key=lambda row: float(row["moves"]), default=None)


def _parameter_of(tested: Tested, name: str) -> tuple[str, str]:
    """The symbol of a parameter of an effect, and what it is."""
    own = {each["parameter"]: each["meaning"] for each in tested.parameters}
    meanings = {**meanings_of(tested.effect), **own}
    return symbol(name), numbers.shortened(meanings.get(name, ""), 160)


def _moves(rows: Sequence[Record]) -> tuple[str, str]:
    """By how many sigma undetected effects of these rows move a parameter, and which."""
    most = moves_most(rows)
    if most is None:
        return "", ""
    slight = most["moves"] < LEAST_MOVE
    moves = f"< {LEAST_MOVE}" if slight else numbers.significant(most["moves"], 2)
    return moves, f"{symbol(most['moved_parameter'])} ({SINGULAR[most['moved_sensor']]})"


def _sizes(rows: Sequence[Record]) -> tuple[str, str, str]:
    """The limit of the worst axis, which is first, that of the best, the unit."""
    first, unit = rows[0], quantity_of(rows[0]).shown
    best = min(min(row["limit"], row["smallest"] or row["limit"]) for row in rows)
    if best > largest(first):
        return NOT_DETECTABLE, "", ""
    worst = max(first["limit"], first["largest"] or 0.0)
    least, most = (numbers.significant(unit.of(size), 2) for size in (best, worst))
    if worst > largest(first):
        most = NOT_DETECTABLE
    return most, least if least != most else "", unit.name


def _hidden(rows: Sequence[Record], every: Sequence[Record]) -> Iterator[outline.Row]:
    """Effects that are not seen for the same reason in one row; `every`: all limits."""
    by_reason = grouped(rows, lambda row: numbers.shortened(row["explanation"] or "", 300))
    for reason, own in by_reason.items():
        names = [
            _named(effect, [row["parameter"] for row in concerned], every)
            for effect, concerned in grouped(own, _effect).items()
        ]
        yield outline.table_row(capital(reason), f"{capital('; '.join(names))}.")


def _named(effect: Effect, own: Sequence[str], every: Sequence[Record]) -> str:
    """The effect, and its parameters where not all of them are concerned."""
    name, mount = effect
    words = with_mount(in_words(name), mount)
    if len(own) == sum(_effect(row) == effect for row in every):
        return words
    return f"{words} ({', '.join(numbers.shortened(each, 30) for each in own)})"


# ---- tests for structure


def structure_tests(rows: Sequence[Record]) -> Iterator[outline.Part]:
    """The six tests of each mount: in a line where none is significant, else as a table."""
    for mount in dict.fromkeys(row["mount"] for row in rows):
        own = [row for row in rows if row["mount"] == mount]
        where = with_mount("", mount)
        if any(row["detected"] for row in own):
            yield _tests(own, where)
        elif any(row["degrees"] for row in own):
            yield outline.Paragraph(_insignificant(own, where), "good")
        else:
            yield outline.Paragraph(
                _("No test for structure in the residuals was possible{where}.", where=where)
            )


def _insignificant(rows: Sequence[Record], where: str) -> str:
    made = [row for row in rows if row["degrees"]]
    least = min(made, key=lambda row: float(row["p_value"]))
    sentence = _(
        "The residuals of the model with the identified effects{where} were tested for structure "
        "against {listed}: none is significant, smallest {p_value} after correction for the "
        "search ({least}, {least_2}).",
        where=where,
        listed=listed([test_name(row) for row in made]),
        p_value=numbers.p_is(least["p_value"]),
        least=test_name(least),
        least_2=channel(least),
    )
    if idle := [test_name(row) for row in rows if not row["degrees"]]:
        sentence += _(
            " Not tested against {idle}, which the recording does not contain.", idle=listed(idle)
        )
    return sentence


def _tests(rows: Sequence[Record], where: str) -> outline.Table:
    """The tests, the significant ones first."""
    return outline.Table(
        _(
            "{count_} tests for structure in the residuals of the model with the identified "
            "effects{where}. By chance one of them is significant in one campaign of a hundred.",
            count_=capital(count_in_words(len(rows))),
            where=where,
        ),
        (
            *outline.columns("text", _("Against"), _("Most significant in"), _("Place")),
            *outline.columns("number", _("Reduction of χ²"), "p"),
            outline.Column(_("Outcome")),
        ),
        [
            outline.table_row(
                test_name(row).capitalize(),
                channel(row),
                place(row),
                *_outcome(row),
                tone="fair" if row["detected"] else "",
            )
            for row in sorted(rows, key=_significant_first)
        ],
    )


def _significant_first(row: Record) -> tuple[bool, float]:
    return not row["detected"], 1.0 if row["p_value"] is None else row["p_value"]


def _outcome(row: Record) -> tuple[str, str, str]:
    if not row["degrees"]:
        return "—", "—", _("not recorded")
    outcome = _("significant") if row["detected"] else _("not significant")
    return numbers.significant(row["statistic"]), numbers.probability(row["p_value"]), outcome


def test_name(row: Record) -> str:
    """What the residuals are tested against."""
    return TESTS.get(row["kind"]) or numbers.shortened(row["kind"], 30)


def channel(row: Record) -> str:
    """Sensor and axis in words: x gyro."""
    if not row["axis"]:
        return "—"
    return _("{axis} {sensor}", axis=row["axis"], sensor=SINGULAR.get(row["sensor"], row["sensor"]))


SMOOTH = _("smooth")  # a structure along the whole of time or angle


def place(row: Record) -> str:
    """Where along time or angle the structure is."""
    at = row["scan_value"]
    if at is None or not row["degrees"]:
        return "—"
    if row["kind"] == "change":
        return _("at {fixed} min", fixed=numbers.fixed(at / 60, 1))
    if row["kind"] == "angle":
        return _("{at} times in a turn", at=numbers.significant(at, 3)) if at > 0 else SMOOTH
    if row["kind"] == "time":
        return (
            _("every {significant} s", significant=numbers.significant(1 / at, 3))
            if at > 0
            else SMOOTH
        )
    return "—"
