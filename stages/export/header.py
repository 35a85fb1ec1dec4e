"""The head of a parameter file: origin, mount, effects, as comment lines in ASCII.

Autopilots, their ground stations and Kalibr read these files with the character set of the
machine they run on, so nothing but ASCII is written.
"""

import textwrap
from collections.abc import Iterable, Iterator, Sequence

from inertial.text.cause_names import in_words
from inertial.text.messages import _
from stages.export.calibration import Calibration, Triad
from stages.export.equation import added_by

LINE_WIDTH = 96
MAX_NAME_LENGTH = 80  # characters of a name from outside
ASCII_SPELLING = str.maketrans(
    {
        "°": " deg", "²": "^2", "√": "sqrt ", "−": "-", "±": "+-", "×": "*", "·": "*", "µ": "u",
        "σ": "sigma", "…": "...", "′": "'", "″": '"', "–": "-", "÷": "/", "⁻": "^-", "¹": "1",
    }
)  # fmt: skip


def origin(calibration: Calibration, target: str) -> Iterator[str]:
    """Of which IMU and campaign these parameters for `target` are."""
    campaign = calibration.campaign
    yield _("Calibration of an IMU on a turntable, for {target}.", target=target)
    if campaign["simulated"]:
        yield _("SIMULATED: no real instrument has these errors.")
    yield _(
        "IMU: {instrument}, serial number {serial}",
        instrument=_quoted(campaign["instrument"]),
        serial=_quoted(campaign["serial"]),
    )
    yield _(
        "Campaign: {campaign}, date {date}",
        campaign=_quoted(campaign["campaign"]),
        date=_quoted(campaign["date"]),
    )
    if calibration.not_exported:
        yield ""
        yield _("Nothing is exported. {not_exported}", not_exported=calibration.not_exported)
        return
    yield (
        _(
            "The whole calibration, with every sigma, is in {campaign}.calibration.json, "
            "which also contains readings before and after the correction.",
            campaign=campaign["campaign"],
        )
    )


def mounts(calibration: Calibration, chosen: Sequence[tuple[str, Triad]]) -> Iterator[str]:
    """From which mount the numbers are, where the campaign has several."""
    if len(calibration.mounts) > 1:
        names = ", ".join(f"{triad.kind} {_quoted(name)}" for name, triad in chosen)
        yield (
            _(
                "The IMU was fixed on {mounts} mounts; each has an M of its own, because M "
                "contains the mounting rotation. These numbers are from: {names}.",
                mounts=len(calibration.mounts),
                names=names,
            )
        )


def verdicts(triads: Iterable[Triad]) -> Iterator[str]:
    """What the diagnosis says of each triad, and on which condition its numbers are valid."""
    for triad in triads:
        verdict = triad.verdict
        if triad.unusable:
            yield _(
                "The {kind}s are not usable, so nothing is given for them. {reason}",
                kind=triad.kind,
                reason=triad.unusable,
            )
        elif verdict and verdict["condition"]:
            yield _(
                "The numbers of the {kind}s are valid on this condition: {condition}",
                kind=triad.kind,
                condition=verdict["condition"],
            )
        elif verdict and verdict["sentence"]:
            yield f"{triad.kind.capitalize()}: {verdict['sentence']}"


def effect_terms(triads: Iterable[Triad]) -> Iterator[str]:
    """For each effect in the model of a triad, the terms that the file does not contain."""
    for triad in triads:
        for one in triad.effects:
            terms = ", ".join(
                f"{row['parameter']} = {row['value']:.4g} {row['unit'].removeprefix('1')}".rstrip()
                for row in (*one.parameters.values(), *one.constants.values())
                if row["value"] is not None
            )
            if not terms:
                continue
            if not one.effect.terms:
                yield _(
                    "- {effect}: the numbers of the {kind}s are those of a model with it "
                    "({terms}). It is in no correction of readings: {stays}",
                    effect=in_words(one.effect.name),
                    kind=triad.kind,
                    terms=terms,
                    stays=one.effect.stays,
                )
                continue
            yield _(
                "- {effect}: the numbers of the {kind}s are those of a model with it, and readings "
                "corrected without it still contain it: {terms}. It adds to the reading of {added}",
                effect=in_words(one.effect.name),
                kind=triad.kind,
                terms=terms,
                added="; ".join(
                    f"{axis}: {text}" for axis, text in added_by(one, triad.kind).items()
                ),
            )


def commented(paragraphs: Iterable[str]) -> list[str]:
    """Each paragraph as lines of a comment; one that begins with '- ' as an item of a list."""
    lines = []
    for paragraph in paragraphs:
        indent = "  " if paragraph.startswith("- ") else ""
        wrapped = textwrap.wrap(
            _ascii(paragraph),
            LINE_WIDTH,
            subsequent_indent=indent,
            break_long_words=False,
            break_on_hyphens=False,
        )
        lines += [f"# {line}" for line in wrapped] or ["#"]
    return lines


def _quoted(name: str) -> str:
    """A name from outside, between quotes and not too long."""
    short = name if len(name) <= MAX_NAME_LENGTH else f"{name[:MAX_NAME_LENGTH]}…"
    return f'"{_ascii(short)}"'


def _ascii(text: str) -> str:
    """`text` in printable ASCII on one line; any other character as its escape sequence."""
    return "".join(
        c if c.isascii() and c.isprintable() else c.encode("unicode_escape").decode()
        for c in text.translate(ASCII_SPELLING)
    )
