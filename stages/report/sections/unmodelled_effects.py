"""Unmodelled effects: each with its certainty, what it does and what to do; detection limits."""

from collections.abc import Iterator, Sequence

from inertial.campaign.records import grouped, sizes_of_result
from inertial.text.cause_names import in_words
from inertial.text.messages import _
from inertial.text.numbers import p_is, shortened, significant
from inertial.text.parameters import JOINT
from inertial.text.typography import capital
from stages.report import outline
from stages.report.results import RESULT_TABLES, shifts
from stages.report.sections import effect_tables, periodic_figures, residual_figures
from stages.report.sections.effect_sentences import (
    GRADES,
    Tested,
    about_effect,
    alternatives,
    certainty,
    clearest_first,
    effect_of,
    grade_of,
    kind_of,
    largest_shift,
    limits_of,
    name_of,
    reductions,
    summary,
    tested_effect,
    tested_effects,
    worth,
)
from stages.report.sections.effect_sentences import observable as is_observable
from stages.report.sections.findings import FINDING_TABLES, cause_of_finding, title_of
from stages.report.tables import (
    CAUSE_TABLES,
    GAIN_TABLES,
    Record,
    Tables,
    decisions,
    effect_causes,
    gains,
    once,
)
from stages.report.words import count_in_words

POSITION = "table_position_error"  # what an effect of the accelerometers may look like
LINES = {"oscillation", "table_ripple", "table_eccentricity"}  # periodic in turns, all of them
MIN_SPLIT_SIGMA = 3.3  # at which the likelier member is right in 95 of 100 campaigns
MIN_WORTH_NAMING = 0.1  # sigma; below, which manoeuvre is the best says nothing
IDENTIFIED = frozenset({"found", "class", "law"})


@once
def effect_findings(tables: Tables) -> list[Record]:
    """The findings of criticism that are causes of their own, the clearest first."""
    causes = cause_of_finding(tables)
    own = [
        row
        for row in effect_causes(tables)
        if row["id"] in causes and causes[row["id"]]["cause"] == row["cause"]
    ]
    return clearest_first(own)


def parts(tables: Tables) -> Iterator[outline.Part]:
    """What was found, the tests for structure, and the detection limits."""
    yield _summary(tables)
    yield from _decisions(tables)
    yield from effect_tables.structure_tests(tables.rows("structures"))
    if missed := list(not_detected(tables)):
        yield outline.Heading(_("Detection limits"))
        yield from effect_tables.detection_limits(list(limits_of(tables)), missed)


def shifts_beyond(tables: Tables, sigmas: float) -> tuple[int, int]:
    """How many undetected effects, as large as their detection limit, shift a parameter more.

    The second number: of how many it is known.
    """
    return effect_tables.shifts_beyond(list(limits_of(tables)), list(not_detected(tables)), sigmas)


LIMIT_TABLES = (*FINDING_TABLES, "scores", "detection_limits", "sensors", *CAUSE_TABLES[1:])


SECTION = outline.Section(
    "unmodelled-effects",
    _("Unmodelled effects"),
    _(
        "Physical effects beyond bias, scale and cross-axis terms that the data reveal, and the "
        "detection limits of those not detected."
    ),
    "",
    (
        *RESULT_TABLES,
        *LIMIT_TABLES,
        *("structures", *GAIN_TABLES),
    ),
    parts,
)


def _summary(tables: Tables) -> outline.Paragraph:
    if sentences := list(summary(effect_findings(tables))):
        return outline.Paragraph(" ".join(sentences), "fair")
    tested = tested_effects(tables)
    if not tested:
        return outline.Paragraph(
            _("No effect was tested: the joint fits determine no model."), "fair"
        )
    every = len({effect.effect for effect in tested})
    limits = grouped(limits_of(tables), lambda row: (row["mount"], row["effect"]))
    observable = len(
        {
            effect.effect
            for effect in tested
            if effect.score["degrees"]
            and is_observable(limits.get((effect.mount, effect.effect), []), effect_tables.VISIBLE)
        }
    )
    if not observable:
        return outline.Paragraph(
            _(
                "This plan makes none of the {every} effects observable.",
                every=count_in_words(every),
            ),
            "fair",
        )
    sentence = _(
        "None detected: none of the {observable} effects is significant.",
        observable=count_in_words(observable),
    )
    if observable < every:
        sentence = _(
            "None detected: none of the {observable} effects that this plan makes "
            "observable is significant; {count_in_words} are not observable.",
            observable=count_in_words(observable),
            count_in_words=count_in_words(every - observable),
        )
    return outline.Paragraph(sentence, "good")


def _decisions(tables: Tables) -> Iterator[outline.Paragraph]:
    """Which result of a sensor that shows an effect is final, and why."""
    for row in decisions(tables):
        if row["effects"]:
            mount = _("Mount {mount}: ", mount=row["mount"]) if row["mount"] else ""
            tone: outline.Tone = "fair" if row["method"] == JOINT else "good"
            yield outline.Paragraph(shortened(mount + row["reason"], 900), tone)


def not_detected(tables: Tables) -> Iterator[Tested]:
    """The effects that no finding is about, nor may be instead."""
    named = {
        (name, row["mount"])
        for row in effect_findings(tables)
        for name in (row["cause"], *alternatives(row))
    }
    return (
        effect for effect in tested_effects(tables) if (effect.effect, effect.mount) not in named
    )


# ---- the block of a finding


def _blocks(tables: Tables) -> Iterator[outline.Finding]:
    """A block for each finding; what several would show alike is shown by the first of them."""
    first: dict[tuple[str | None, str], Record] = {}
    for number, row in enumerate(effect_findings(tables), 1):
        key, mount = f"effect-{number}", row["mount"]
        place = (row["sensor"], mount)
        shown: list[outline.Figure | outline.Table] = [*_parameters(tables, row)]
        links = [
            outline.Link(title_of(tables, cause), f"cause/{cause['id']}")
            for cause in [cause_of_finding(tables)[row["id"]]]
        ]
        residuals = None
        if row["cause"] not in LINES:
            residuals = residual_figures.by_manoeuvre(tables, row, mount, key)
        if residuals and place in first and not list(_reductions(tables, row)):
            like = first[place]
            links.insert(0, outline.Link(f"{_title(like)}: figure", f"effect/{like['id']}"))
        elif residuals:
            shown.append(residuals)
            first.setdefault(place, row)
        shown += _own_figures(tables, row, key)
        yield outline.Finding(
            f"effect/{row['id']}",
            _title(row),
            GRADES[grade_of(row)],
            certainty(row),
            answers=tuple(_answers(tables, row)),
            parts=shown,
            links=links,
            tone="" if kind_of(row) == "walk" else "fair",
            model=True,
        )


EFFECTS = outline.Section(
    "effects",
    _("What shows each effect"),
    _("The unmodelled effects one by one: how certain each is, what it does and what to do."),
    _(
        "The clearest comes first: identified, where no other effect of the catalogue has the same "
        "signature; one of a class, where others have it in these data; consistent, where the name "
        "is not certain. The reduction of χ² on held-out data is nothing where an effect only fits "
        "noise; the attainable one is that of exactly known effects. Sizes are least-squares "
        "estimates, corrected for selection (an effect is reported only if significant, so its "
        "estimate is too large on average); above 10 σ the correction is zero."
    ),
    (
        *RESULT_TABLES,
        *FINDING_TABLES,
        *("manoeuvres", "segments", "simulated", "fidelity", "scores", "lines", "worth"),
        *("structures", "structure_points", *CAUSE_TABLES[1:], *GAIN_TABLES),
    ),
    _blocks,
)


def _title(row: Record) -> str:
    name = capital(name_of(row))
    return f"{name} · {shortened(row['manoeuvre'], 60)}" if row["manoeuvre"] else name


def _parameters(tables: Tables, row: Record) -> Iterator[outline.Table]:
    """Its parameters, by the result where its model has the effect.

    Of a random walk none, for its only number is in the sentence.
    """
    tested = effect_of(tables, row)
    known: Sequence[Record] = tested.parameters if tested else ()
    if not any(each["value"] is not None for each in known):
        known = row["parameters"]
    if kind_of(row) == "walk" or not known:
        return
    title = capital(name_of(row))
    if by_result := _of_result(tables, row, known) if tested else []:
        caption = _("{title}: the parameters beyond 3 σ, by the result.", title=title)
    else:
        caption = _(
            "{title}: the parameters beyond 3 σ, as they were detected; the result does not "
            "contain them.",
            title=title,
        )
    yield effect_tables.parameters(caption, by_result or known)


def _of_result(tables: Tables, finding: Record, known: Sequence[Record]) -> list[Record]:
    """The same parameters of an effect with the values of the result; none: these are not in it.

    A constant of the effect, of which the result has no sigma, stays as it was detected.
    """
    of_result = sizes_of_result(tables.rows("result"))
    missing = {"value": None, "sigma": None}
    place = finding["mount"], finding["cause"]
    constants = {
        (row["mount"], row["effect"], row["parameter"].rpartition(".")[2])
        for row in tables.rows("result")
        if row["effect"] and row["value"] is not None and not row["sigma"]
    }
    keys = [(*place, row["parameter"]) for row in known]
    if not any(key in of_result for key in keys):
        return []
    values = [
        of_result.get(key, row if key in constants else missing)
        for key, row in zip(keys, known, strict=True)
    ]
    return [
        row | {key: own[key] for key in missing} for row, own in zip(known, values, strict=True)
    ]


def _own_figures(tables: Tables, row: Record, key: str) -> Iterator[outline.Figure]:
    """What shows this one alone: an oscillation over time or angle, or a structure."""
    tested = effect_of(tables, row) if row["cause"] in LINES else None
    figure = None
    if tested and row["cause"] == "oscillation":
        figure = periodic_figures.over_time(tables, row["cause"], key)
    elif tested:
        orders = [each["value"] for each in tested.parameters if each["parameter"] == "n"]
        order = next((value for value in orders if value is not None), 1.0)
        figure = periodic_figures.over_angle(tables, order, key)
    if figure:
        yield figure
    if kind_of(row) == "structure":
        yield from residual_figures.structures(tables, row, row["mount"], key)


def _answers(tables: Tables, row: Record) -> outline.Pairs:
    mount, kind = row["mount"], kind_of(row)
    answers: list[tuple[str, str]] = []
    if kind in ("consistent", "walk") and (what := _meaning(tables, row["cause"], mount)):
        answers.append((_("Cause"), f"{capital(what)}."))
    if others := alternatives(row):
        each = (
            in_words(name) + (f" ({what})" if (what := _meaning(tables, name, mount)) else "")
            for name in others
        )
        label = _("Candidates") if kind == "structure" else _("Alternatives")
        answers.append((label, f"{capital('; '.join(each))}."))
    answers += [
        (_("Ruled out"), " ".join(_positions(tables, row, mount))),
        (_("To distinguish"), _split(row) if row["split_manoeuvre"] else ""),
        (_("Improvement"), " ".join(_gain(tables, row, mount))),
    ]
    if row["cause"] == "oscillation" and effect_of(tables, row):
        answers.append((_("Magnitude"), " ".join(periodic_figures.angle(tables, row["cause"]))))
    answers.append((_("Navigation"), _worth(tables, row, mount)))
    return tuple((name, text) for name, text in answers if text)


def _meaning(tables: Tables, effect: str, mount: str) -> str:
    tested = tested_effect(tables, effect, mount) or tested_effect(tables, effect, "")
    return shortened(tested.score["cause"], 300) if tested else ""


def _positions(tables: Tables, row: Record, mount: str) -> Iterator[str]:
    """That no position error is significant beside it, where the joint fit has one for it."""
    tested = tested_effect(tables, POSITION, mount)
    if row["sensor"] != "accel" or kind_of(row) not in IDENTIFIED:
        return
    if tested is None or tested.score["named"] or POSITION in (row["cause"], *alternatives(row)):
        return
    for off in tables.rows("accelerometer_findings"):
        if off["cause"] == POSITION and off["mount"] == mount:
            yield _(
                "The joint fit attributes it to a position error in {shortened}; with the "
                "effect in the model no position error is significant ({p_value}).",
                shortened=shortened(off["manoeuvre"] or _("a manoeuvre"), 60),
                p_value=p_is(tested.score["p_value"]),
            )


def _split(row: Record) -> str:
    """The manoeuvre that would split the class, unless the action states it with its sigmas."""
    if row["split_stated"]:
        return ""
    manoeuvre = shortened(row["split_manoeuvre"], 400)
    if row["split_snr"] is None:
        return f"{capital(manoeuvre)}."
    if row["split_snr"] < MIN_WORTH_NAMING:
        return _("No manoeuvre considered would.")
    clear = f"{significant(row['split_snr'], 2)} σ"
    if row["split_snr"] < MIN_SPLIT_SIGMA:
        return _(
            "No manoeuvre considered would; the best, {manoeuvre}, reaches {clear}.",
            manoeuvre=manoeuvre,
            clear=clear,
        )
    return _(
        "{manoeuvre}: expected to distinguish them at {clear}.",
        manoeuvre=capital(manoeuvre),
        clear=clear,
    )


def _reductions(tables: Tables, row: Record) -> Iterator[str]:
    return reductions(row["cause"], row["mount"], gains(tables))


def _gain(tables: Tables, row: Record, mount: str) -> Iterator[str]:
    """The gain, and how far the parameters of the sensor move."""
    if kind_of(row) in IDENTIFIED:
        yield from _reductions(tables, row)
        for decision in about_effect(decisions(tables), row["cause"], mount):
            yield largest_shift(shifts(tables).get((decision["sensor"], decision["mount"]), ()))


def _worth(tables: Tables, row: Record, mount: str) -> str:
    """What the effects of a mount cost navigation, all together; once, with the first of them."""
    own = (each for each in effect_findings(tables) if each["mount"] == row["mount"])
    named = (each for each in own if about_effect(decisions(tables), each["cause"], mount))
    if (first := next(named, None)) is None or first["id"] != row["id"]:
        return ""
    of_mount = [each for each in decisions(tables) if (each["mount"] or "") == mount]
    together = dict.fromkeys(name for each in of_mount for name in each["effects"])
    costs = [each for each in tables.rows("worth") if (each["mount"] or "") == mount]
    return worth(list(together), costs)
