"""Effects of the catalogue as terms: their equations, their constants, what a parameter is."""

import re
from collections.abc import Iterator, Mapping, Sequence

from inertial.effects import KNOWN
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.parameters import sign_of
from stages.report.tables import Record


def meanings_of(effect: str) -> Mapping[str, str]:
    """What each parameter of an effect is, by its name; empty for a law of a campaign."""
    return {one.name: one.meaning for one in KNOWN[effect].parameters} if effect in KNOWN else {}


def is_scanned(effect: str, parameter: str) -> bool:
    """Whether it is a place or a time that was searched, which is not small where nothing is."""
    scan = KNOWN[effect].scan if effect in KNOWN else None
    return scan is not None and scan.name == parameter


# ---- constants, such as a time constant, beside the parameters

SET = _("—: a constant of the effect, set and not estimated.")
OF_THE_PLAN = _("—: it is a place in the plan, found by a search; it has no σ.")
OF_A_LAW = _("—: the shape of a law, found by a search; it has no σ of its own.")
OF_ANOTHER_MODEL = _(
    "—: found by a search, whose σ is not known: it was made with other effects in the model, or "
    "another member of the class in the place of this one."
)

REASONS = (SET, OF_A_LAW, OF_THE_PLAN, OF_ANOTHER_MODEL)
SHAPE = "shape_"  # how the names of the constants of a law begin


def with_scanned_sigmas(rows: Sequence[Record], detected: Sequence[Record]) -> list[Record]:
    """The parameters of effects, a scanned constant with the sigma of its search where it has one.

    `detected`: the parameters as criticism has them, which made the search. That of another value
    is not its sigma.
    """
    known = {(row["mount"], f"{row['effect']}.{row['parameter']}"): row for row in detected}

    def sigma(row: Record) -> float | None:
        own = known.get((row["mount"], row["parameter"]))
        of_search = own["sigma"] if own and own["value"] == row["value"] else None
        return row["sigma"] or of_search

    return [row | {"sigma": sigma(row)} for row in rows]


def without_sigma(rows: Sequence[Record]) -> Iterator[str]:
    """Why constants of effects have no sigma, a sentence for each reason."""
    reasons = set()
    for row in rows:
        if row["value"] is not None and not row["sigma"]:
            name = row["parameter"].rpartition(".")[2]
            if not is_scanned(row["effect"], name):
                reasons.add(OF_A_LAW if name.startswith(SHAPE) else SET)
            elif (scan := KNOWN[row["effect"]].scan) is not None:
                reasons.add(OF_ANOTHER_MODEL if scan.between else OF_THE_PLAN)
    yield from (reason for reason in REASONS if reason in reasons)


# ---- what an effect adds to the readings

SYMBOLS = {  # of the factors of effects, each in the unit that its coefficient has it in
    r"f_\w": _("f: specific force"),
    r"ω_\w": _("ω: angular rate"),
    r"t": _("t: time from the first sample"),
    r"T": _("T: temperature of the IMU"),
    r"[tT] >": _("(… > …): 1 where that is true, else 0"),
}


def equation(effect: str, rows: Sequence[Record]) -> str:
    """What it adds to the readings, with what the symbols are, behind its name."""
    text = added_to_readings(effect, rows)
    used = [says for sign, says in SYMBOLS.items() if re.search(rf"\b{sign}", text)]
    return f": {text} ({'; '.join(used)})" if text else ""


SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


def added_to_readings(effect: str, rows: Sequence[Record]) -> str:
    """What an effect of a result adds to the readings; empty for one of the table, or of the site.

    That is nothing which is to be taken off.
    """
    names = {row["parameter"].rpartition(".")[2] for row in rows if row["value"] is not None}
    sums: dict[str, list[str]] = {}
    for each in KNOWN[effect].terms if effect in KNOWN else ():
        if each.parameter in names:
            sensor, _unused, axis = each.channel.partition("_")
            factor = re.sub(r"\bs_", "w_" if sensor == "gyro" else "f_", each.factor)  # of its axis
            sums.setdefault(axis, []).append(_term(each.parameter, factor))
    by_axis = {axis: _over_axes(terms) for axis, terms in sums.items()}
    alike = {re.sub(rf"_{axis}(?=\b|j)", "_i", text) for axis, text in by_axis.items()}
    if len(by_axis) > 1 and len(alike) == 1:
        return f"+ {alike.pop()}"
    return "; ".join(f"{axis}: + {text}" for axis, text in by_axis.items())


def _over_axes(terms: Sequence[str]) -> str:
    """The sum of terms; Σ_j of those that differ by the axes x, y and z alone."""
    alike = {re.sub(rf"{axis}\b", "j", text) for axis, text in zip(AXES, terms, strict=False)}
    if len(terms) == len(AXES) and len(alike) == 1:
        return f"Σ_j {alike.pop()}"
    return " + ".join(terms)


def _term(parameter: str, factor: str) -> str:
    """A parameter times its factor as it is written, k_x · f_x² for k_x * f_x * f_x."""
    factors: dict[str, int] = {}
    for each in factor.split(" * "):
        factors[each] = factors.get(each, 0) + 1
    written = [
        f + ("" if count == 1 else str(count).translate(SUPERSCRIPTS))
        for f, count in factors.items()
    ]
    factor = re.sub(r"abs\((\w+)\)", r"|\1|", " · ".join(written)).replace("-", "−")
    factor = re.sub(r"\w+", lambda name: sign_of(re.sub("^w_", "ω_", name[0])), factor)
    sign = sign_of(parameter)
    return f"({sign}) · {factor}" if " " in sign else f"{sign} · {factor}"
