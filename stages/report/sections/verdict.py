"""The verdict of each sensor in a sentence, and one card for each cause."""

from collections import Counter
from collections.abc import Iterator
from math import degrees

from inertial.campaign.hypotheses import JUMP_NOT_TESTABLE
from inertial.text.cause_names import in_words
from inertial.text.messages import _, listed
from inertial.text.numbers import (
    fixed,
    p_is,
    shortened,
    significant,
    whole,
)
from inertial.text.typography import capital, columns_of, typeset, wrapped
from stages.report import outline
from stages.report.sections.findings import (
    FINDING_TABLES,
    MODEL,
    causes,
    findings_of,
    harmless,
    in_recording,
    members,
    spoils,
    title_of,
)
from stages.report.tables import Record, Tables, once
from stages.report.words import how_large, term

SIMULATED = _(
    "SIMULATED: recorded by the simulated laboratory. No instrument of this serial was calibrated."
)
# The verdicts from the worst to the best, with words, tone and meaning.
LEVELS: dict[str, tuple[str, outline.Tone, str]] = {
    "not_usable": (
        _("not usable"),
        "poor",
        _(
            "A cause that is not removed moves a parameter by more than its sigma, or parameters "
            "are not determined."
        ),
    ),
    "on_condition": (
        _("usable on condition"),
        "fair",
        _(
            "Something was set right that nobody has confirmed, or the plan cannot show whether "
            "something happened. The result is valid if the condition below holds; “accept” in the "
            "campaign file confirms what was set right."
        ),
    ),
    "usable_within_limits": (
        _("usable, with departures from the ideal"),
        "fair",
        _(
            "Departures from the ideal were found, or a parameter is known coarsely. The sentence "
            "of each sensor says what, and what became of it."
        ),
    ),
    "usable": (
        _("usable"),
        "good",
        _("All parameters are determined, and no fault was detected."),
    ),
}
ONLY_LACKING = _("Parameters are not determined. The sentence of each sensor says which.")
GUESSES = _(
    "Guessed in the campaign file and not confirmed: {guesses}. The values are as good as these "
    "guesses. Correct them there, and delete from `guessed` what is confirmed."
)
NOT_TESTABLE = _("not testable with this plan: whether it happened is not known")
SURE = {
    "found": _("identified: no other cause explains these data as well"),
    "one_of_class": _("one of a class whose members these data do not distinguish"),
    "law": _("a law that no effect of the catalogue has; its physical cause is not known"),
    "unknown_structure": _("certain to be there; its nature is not known"),
}
CURED = {
    "repaired": _("set right"),
    "modelled": _("in the model"),
    "curve": _("as a curve of the temperature"),
    "masked": _("masked"),
    "interpolated": _("interpolated"),
    "left_out": _("left out"),
    "none": _("not removed"),
}
HARMLESS = _("harmless")
MIN_MOVE, MAX_MOVE = 0.01, 1000.0  # sigma: between these the number says something
# Of a member of a class, between which its probability says something: beyond, it rests on the
# number of its parameters
MIN_PROBABILITY, MAX_PROBABILITY = 0.001, 0.999
MOST_CONSEQUENCES = 8


@once
def worst(tables: Tables) -> str:
    """The verdict of the campaign: the worst of its sensors that are recorded."""
    given = {row["verdict"] for row in tables.rows("verdict") if row["recorded"]}
    return next((level for level in LEVELS if level in given), "not_usable")


@once
def verdict_in_words(tables: Tables) -> tuple[str, outline.Tone, str]:
    """The verdict of the campaign in words, with its tone and what it means."""
    word, tone, meaning = LEVELS[worst(tables)]
    if worst(tables) == "not_usable" and not any(spoils(tables, row) for row in causes(tables)):
        meaning = ONLY_LACKING
    return word, tone, meaning


def guesses(tables: Tables) -> str:
    """What of the campaign file is guessed, as a sentence; empty where nothing is."""
    guessed = [term(row["part"]) for row in tables.rows("guesses")]
    return GUESSES.format(guesses=listed(guessed)) if guessed else ""


def verdict_sentences(tables: Tables) -> Iterator[str]:
    """A sentence for each sensor, the cause first."""
    if not tables.rows("verdict"):
        yield _("Nothing was estimated of any sensor.")
    for row in tables.rows("verdict"):
        mount = _("Mount {mount}. ", mount=row["mount"]) if row["mount"] else ""
        yield mount + row["sentence"]


# ---- The card of a cause.


def _card(tables: Tables, row: Record) -> outline.Finding:
    return outline.Finding(
        anchor=f"cause/{row['id']}",
        title=title_of(tables, row),
        grade=_grade(row),
        sentence=shortened(_below_title(row), 900),
        answers=tuple(_answers(tables, row)),
        facts=((_("identifier"), row["id"]),),
        links=tuple(_links(tables, row)),
        tone="poor" if spoils(tables, row) else "" if harmless(row) else "fair",
    )


def _below_title(row: Record) -> str:
    """Its sentence, without the name that the title above it states."""
    detected = _("Detected: {effect}{place}: {cause}. {numbers}.")  # as criticism writes it
    start, _cause, rest = detected.partition("{cause}")
    named = start.format(effect=in_words(row["cause"]), place="")
    own = str(row["sentence"])
    return capital(own.removeprefix(named)) if rest and own.startswith(named) else own


def _grade(row: Record) -> str:
    """What became of it, in two words."""
    return HARMLESS if harmless(row) else CURED[row["cure"]]


def _answers(tables: Tables, row: Record) -> outline.Pairs:
    texts = {
        _("How sure"): _sure(tables, row),
        _("How large"): how_large(row),
        _("What it does"): _effect_on_result(row),
        _("What was done"): row["done"],
        _("Gain"): row["gain"],
        _("Valid if"): _sentence(row["condition"] or ""),
        _("Therefore"): _sentence(_therefore(tables, row)),
        _("What to do"): row["action"],
    }
    return tuple((name, shortened(text, 600)) for name, text in texts.items() if text)


def _sentence(text: str) -> str:
    """With a capital letter and a full stop; nothing of nothing."""
    return capital(text if not text or text.endswith((".", "…")) else f"{text}.")


def _sure(tables: Tables, row: Record) -> str:
    """The degree of certainty, the members of a class, and the significance."""
    words = NOT_TESTABLE if row["cause"] == JUMP_NOT_TESTABLE else SURE[row["verdict"]]
    if own := members(tables, row):
        shares = [one["probability"] for one in own]
        each = [one["condition"] or in_words(one["member"]) for one in own]
        if None not in shares:
            if max(shares) > MAX_PROBABILITY:
                words = _("by far the likeliest of a class of which each can show much the same")
            each = [
                _("{member} with probability {percent} %", member=member, percent=_percent(share))
                for member, share in zip(each, shares, strict=True)
            ]
        words += ": " + ", ".join(each)
    numbers = []
    if row["snr"] is not None:
        numbers.append(f"SNR {significant(row['snr'], 3)}")
    if row["p_value"] is not None:
        numbers.append(p_is(row["p_value"]))
    return _sentence(words + (f" ({', '.join(numbers)})" if numbers else ""))


def _percent(share: float) -> str:
    if share < MIN_PROBABILITY:
        return f"< {significant(100 * MIN_PROBABILITY, 1)}"
    if share > MAX_PROBABILITY:
        return f"> {significant(100 * MAX_PROBABILITY, 3)}"
    return significant(100 * share, 2)


def _effect_on_result(row: Record) -> str:
    """By how much it moves or would move the parameters, and what else it does."""
    moves = row["moves"]
    if moves is None:
        return str(row["consequence"])
    return f"{_moves(row['cure'], moves)} {row['consequence']}".rstrip()


def _moves(cure: str, moves: float) -> str:
    if moves < MIN_MOVE:
        return _("It shifts no parameter by more than 0.01 σ.")
    size = _("up to {size} σ", size=significant(moves, 2))
    if moves > MAX_MOVE:
        size = _("more than {most} σ", most=whole(MAX_MOVE))
    if cure == "none":
        return _("It shifts a parameter by {size} (σ of that parameter).", size=size)
    if cure == "repaired":
        return _("Not set right, it would shift a parameter by {size}.", size=size)
    return _(
        "Left out of the model, all weights unchanged, it would shift a parameter by {size} (σ of "
        "the result).",
        size=size,
    )


def _therefore(tables: Tables, row: Record) -> str:
    """The findings that this cause explains, by name, with how many."""
    names = Counter(
        in_words(each["cause"])
        for each in findings_of(tables, row)
        if each["cause"] != row["cause"]
    )
    return ", ".join(f"{name} ({count})" for name, count in names.most_common(MOST_CONSEQUENCES))


def _links(tables: Tables, row: Record) -> Iterator[outline.Link]:
    for own in findings_of(tables, row)[:1]:
        if own["stage"] == MODEL and own["cause"] == row["cause"]:
            yield outline.Link(_("What shows it in the model"), f"effect/{own['id']}")
    if in_recording(tables, row):
        yield outline.Link(_("What shows it in the recording"), f"evidence/{row['id']}")


# ---- The section, and the text.


def facts(tables: Tables) -> outline.Pairs:
    """What stands below the text: instrument, serial, dates, site, table."""
    campaign = tables.row("campaign")
    dates = sorted({row["recorded_on"] for row in tables.rows("clocks") if row["recorded_on"]})
    known = {row["quantity"]: row["value"] for row in tables.rows("known")}
    latitude = campaign["latitude"]
    latitude = _with_unit(None if latitude is None else degrees(latitude), 4, "°")
    height, gravity = (
        _with_unit(campaign["height"], 0, " m"),
        _with_unit(known.get("gravity"), 7, " m/s²"),
    )
    recorded = _("not known: the logs have no absolute clock")
    if dates:
        recorded = " … ".join(dict.fromkeys((dates[0], dates[-1])))
        recorded += _(" (UTC, by the clock of the logs)")
    pairs = {
        _("Campaign"): campaign["campaign"],
        _("Instrument"): campaign["instrument"],
        _("Serial"): campaign["serial"],
        _("Date stated"): campaign["date"],
        _("Date recorded"): recorded,
        _("Site"): _(
            "latitude {latitude}, height {height}, gravity {gravity}",
            latitude=latitude,
            height=height,
            gravity=gravity,
        ),
        _("Table"): campaign["table"],
        _("Laboratory"): campaign["laboratory"],
        _("Operator"): campaign["operator"],
        _("Remarks"): campaign["notes"],
    }
    return tuple(
        (name, shortened(str(text), 900)) for name, text in pairs.items() if text is not None
    )


def _with_unit(value: float | None, decimals: int, unit: str) -> str:
    return _("unknown") if value is None else f"{fixed(value, decimals)}{unit}"


def parts(tables: Tables) -> Iterator[outline.Part]:
    """A card per cause."""
    if not causes(tables):
        yield outline.Paragraph(_("No fault was detected."), "good")
    for row in causes(tables):
        yield _card(tables, row)


SECTION = outline.Section(
    "verdict",
    _("What is wrong, and what was done"),
    _("Each cause once, with its consequences: how sure and how large it is, and its cure."),
    "",
    (*FINDING_TABLES, "campaign", "guesses", "known", "clocks", "blocks"),
    parts,
)


def as_text(tables: Tables) -> str:
    """The verdict as plain text, 80 letters wide."""
    word, _tone, meaning = verdict_in_words(tables)
    lines = []
    if tables.row("campaign")["simulated"]:
        lines += [*wrapped(SIMULATED, 80), ""]
    lines += [_("Verdict: {word}", word=word), *wrapped(meaning, 80), ""]
    for sentence in verdict_sentences(tables):
        lines += wrapped(typeset(sentence), 80, "- ", "  ")
    lines += ["", *wrapped(typeset(guessed), 80)] if (guessed := guesses(tables)) else []
    for row in causes(tables):
        title = f"{title_of(tables, row)} ({_grade(row)})"
        lines += ["", *wrapped(typeset(title), 80)]
        lines += _indented(_below_title(row))
        for name, text in _answers(tables, row):
            lines += _indented(f"{name}: {text}")
    lines.append("")
    for name, text in facts(tables):
        head = typeset(f"{name}:")
        padded = head + " " * (15 - columns_of(head))
        lines += wrapped(padded + typeset(text), 80, "", " " * 15)
    return "\n".join(lines) + "\n"


def _indented(text: str) -> list[str]:
    return wrapped(typeset(shortened(text, 900)), 80, "  ", "  ")
