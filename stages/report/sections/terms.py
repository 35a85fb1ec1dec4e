"""The terms that a report uses, at its end: in the words of docs/glossary.md, shortened."""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass

from inertial.text.messages import ENGLISH, _, language
from stages.report.outline import Chapter, Facts, Section

TERMS: tuple[tuple[str, str], ...] = (  # each with what it means
    (
        _("block"),
        _(
            "Mean of the samples of one phase of a manoeuvre, over seconds at rest and tenths of a "
            "second while turning; the unit of data that the estimates use."
        ),
    ),
    (
        _("cause"),
        _("Fault or effect whose correction, or inclusion in the model, removes findings."),
    ),
    (
        _("class"),
        _(
            "Effects that these data cannot distinguish: the most probable ones, with 95 % of the "
            "probability together, and those whose signature is nearly that of the first."
        ),
    ),
    (
        _("detection limit"),
        _(
            "Size of an effect that stands out by five σ in this campaign: about two in three as "
            "large as that are detected."
        ),
    ),
    (
        _("effect"),
        _(
            "Physical cause of an error that bias, scale errors and cross-axis terms do not "
            "contain, such as the sensitivity of a gyro to specific force."
        ),
    ),
    (
        _("extended"),
        _("Of a fit or a result: with the detected effects in the model, all estimated at once."),
    ),
    (
        _("finding"),
        _("One thing that was found in the recording or in the model: what, where, how large."),
    ),
    (
        _("held-out"),
        _(
            "Of manoeuvres: predicted from a fit to the others, to measure what a model gains on "
            "data that it was not fitted to."
        ),
    ),
    (
        _("joint fit"),
        _("Weighted least squares on all static positions and turns of the campaign at once."),
    ),
    (
        _("manoeuvre"),
        _("One item of the plan: a rest, or a turn about one axis."),
    ),
    (
        "p",
        _("Probability of a statistic at least as extreme as this one if nothing is there."),
    ),
    (
        _("residual"),
        _("Reading less its prediction by the fitted model."),
    ),
    (
        _("scatter"),
        _(
            "Standard deviation by which the means of manoeuvres differ beyond their noise; the "
            "fit estimates it, and it enlarges every σ."
        ),
    ),
    (
        "SNR",
        _(
            "Signal-to-noise ratio of an effect with all its axes together, √(value′ covariance⁻¹ "
            "value), as it was detected in the readings; the size shown is that of its largest "
            "axis in the final result."
        ),
    ),
    (
        "U",
        _("Expanded uncertainty, 2 σ: the value lies within ± U with a probability of about 95 %."),
    ),
    (
        "σ",
        _(
            "Standard uncertainty: one standard deviation, with all known contributions unless the "
            "text says otherwise."
        ),
    ),
    (
        "χ²",
        _(
            "Sum of the squares of residuals over their σ; about as large as its degrees of "
            "freedom where the model is right."
        ),
    ),
)
DRAWN = "drawn"  # the field of a figure that is no text


def used(chapters: Sequence[Chapter]) -> Iterator[Facts]:
    """The terms that these chapters use, each with its meaning; nothing where none is used."""
    text = "\n".join(_texts(chapters))
    if pairs := tuple((name, means) for name, means in TERMS if _is_in(text, name)):
        yield Facts(pairs)


def _is_in(text: str, name: str) -> bool:
    if language() != ENGLISH:  # no blanks between words
        return name in text
    return re.search(rf"\b{re.escape(name)}(?:e?s)?\b", text, re.IGNORECASE) is not None


def _texts(part: object) -> Iterator[str]:
    """All that a part of the outline says."""
    if isinstance(part, str):
        yield part
    elif isinstance(part, Mapping):
        yield from _texts(list(part.values()))
    elif isinstance(part, Iterable):
        for each in part:
            yield from _texts(each)
    elif is_dataclass(part):
        for each in fields(part):
            if each.name != DRAWN:
                yield from _texts(getattr(part, each.name))


SECTION = Section(
    "terms",
    _("Terms"),
    _("What words mean in this report."),
    "",
    (),
    lambda _tables: (),
)
