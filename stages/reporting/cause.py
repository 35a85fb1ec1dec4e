"""One thing that the model lacks: what, how sure, what else it may be, what it does, what to do."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

from inertial.campaign.final_result import STAGES
from inertial.text import numbers
from inertial.text.cause_names import in_words
from stages.reporting import cause_shown, gained, oscillation
from stages.reporting.certainty import grade, how_sure, kind_of, name_of, others_of
from stages.reporting.criticised import Criticised
from stages.reporting.mounts import mount_of
from stages.reporting.outline import Answers, Cause, Figure, Link, Table, Tone
from stages.reporting.rows import Record
from stages.reporting.sought import capital

LONGEST = 1500  # letters of a sentence
POSITION = "table_position_error"
TELLS = 3.3  # sigmas at which the likelier member is right in 95 of 100 campaigns
SURE = frozenset({"found", "class"})


def causes(
    rows: Sequence[Record], links: Mapping[str, Sequence[Link]], model: Criticised
) -> Iterator[Cause]:
    """A block for each finding; what several would show alike is shown by the first of them."""
    first: dict[tuple[str | None, str], Record] = {}
    for number, row in enumerate(rows, 1):
        key, place = f"lacks-{number}", (row["sensor"], mount_of(row["id"]))
        parts: list[Figure | Table] = [*cause_shown.parameters(row, model)]
        see = list(links.get(row["id"], ()))
        if shown := cause_shown.residuals(row, key, model):
            if place in first and not list(gained.gained(row["cause"], place[1], model.gain)):
                see.insert(
                    0, Link(f"{_title(first[place])}: picture", f"lacks/{first[place]['id']}")
                )
            else:
                parts.append(shown)
                first.setdefault(place, row)
        parts += cause_shown.own(row, key, model)
        yield _cause(row, parts, see, model)


def _cause(
    row: Record, parts: Sequence[Figure | Table], links: Sequence[Link], model: Criticised
) -> Cause:
    tone: Tone = "" if kind_of(row) == "walk" else "fair"
    return Cause(
        anchor=f"lacks/{row['id']}",
        title=_title(row),
        grade=grade(row),
        sentence=numbers.shortened(row["sentence"], LONGEST),
        answers=tuple(_answers(row, model)),
        parts=tuple(parts),
        links=tuple(links),
        tone=tone,
    )


def _title(row: Record) -> str:
    name = capital(name_of(row))
    return f"{name} · {numbers.shortened(row['manoeuvre'], 60)}" if row["manoeuvre"] else name


def _answers(row: Record, model: Criticised) -> Answers:
    mount = mount_of(row["id"])
    found = [("How sure", how_sure(row))]
    if kind_of(row) in ("consistent", "walk") and (what := _meaning(row["cause"], mount, model)):
        found.append(("Cause", f"{capital(what)}."))
    if others := others_of(row):
        each = (f"{in_words(name)}{_brackets(_meaning(name, mount, model))}" for name in others)
        label = "It may be" if kind_of(row) == "structure" else "Or instead"
        found.append((label, f"{capital('; '.join(each))}."))
    if also := " ".join(_positions(row, mount, model)):
        found.append(("Not instead", also))
    if row["split_manoeuvre"] and (split := _split(row)):
        found.append(("To tell apart", split))
    if brings := " ".join(_brings(row, mount, model)):
        found.append(("Gain", brings))
    found.append(("What it does", numbers.shortened(row["consequence"] or "", 900)))
    if row["cause"] == "oscillation" and model.effect(row):
        harm = oscillation.harm(model.lines, model.manoeuvres, row["cause"], model.gyro)
        found.append(("In numbers", " ".join(harm)))
    if valued := _worth(row, mount, model):
        found.append(("Worth to a user", valued))
    found.append(("What to do", numbers.shortened(row["action"] or "", 600)))
    return tuple((name, text) for name, text in found if text)


def _meaning(effect: str, mount: str, model: Criticised) -> str:
    one = model.sought.get((effect, mount)) or model.sought.get((effect, ""))
    return numbers.shortened(one.score["cause"], 300) if one else ""


def _brackets(text: str) -> str:
    return f" ({text})" if text else ""


def _positions(row: Record, mount: str, model: Criticised) -> Iterator[str]:
    """That no set position is off beside it, where the joint fit has taken it for one."""
    one = model.sought.get((POSITION, mount))
    if row["sensor"] != "accel" or kind_of(row) not in SURE or one is None or one.score["named"]:
        return
    if POSITION in (row["cause"], *others_of(row)):
        return
    for off in model.positions:
        if mount_of(off["id"]) == mount:
            yield (
                f"The joint fit has taken it for a position that is off "
                f"({numbers.shortened(off['manoeuvre'] or '', 60)}); beside it none is needed "
                f"({numbers.p_is(one.score['p_value'])})."
            )


def _split(row: Record) -> str:
    """The manoeuvre that would split the class, unless the action has said it with its sigmas."""
    manoeuvre = numbers.shortened(row["split_manoeuvre"], 400)
    said = row["split_manoeuvre"] in (row["action"] or "")
    if row["split_snr"] is None:
        return "" if said else f"{capital(manoeuvre)}."
    if said and "sigma" in row["action"]:
        return ""
    clear = f"{numbers.significant(row['split_snr'], 2)} σ"
    if row["split_snr"] < TELLS:
        return f"No manoeuvre that was thought of would; the best, {manoeuvre}, by {clear}."
    return f"{capital(manoeuvre)}: that would do it by {clear}."


def _brings(row: Record, mount: str, model: Criticised) -> Iterator[str]:
    """The gain, and how far the parameters of the sensor move."""
    if kind_of(row) not in SURE:
        return
    yield from gained.gained(row["cause"], mount, model.gain)
    for sensor in _sensors(row["cause"], mount, model):
        method = STAGES[sensor] + (f"@{mount}" if mount else "")
        yield gained.moved([one for one in model.shifts if one.method == method])


def _sensors(effect: str, mount: str, model: Criticised) -> list[str]:
    """The sensors in whose extended model an effect is."""
    return [
        row["sensor"]
        for row in model.decision
        if (row["mount"] or "") == mount and effect in gained.effects_of(row)
    ]


def _worth(row: Record, mount: str, model: Criticised) -> str:
    if not _sensors(row["cause"], mount, model):
        return ""
    own = [each for each in model.worth if (each["mount"] or "") == mount]
    together = dict.fromkeys(
        name
        for each in model.decision
        if (each["mount"] or "") == mount
        for name in gained.effects_of(each)
    )
    return gained.worth(list(together), own)
