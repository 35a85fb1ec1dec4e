"""The head of a parameter file: origin, mount, effects, as comment lines in ASCII.

Autopilots, their ground stations and Kalibr read these files with the character set of the
machine they run on, so nothing but ASCII is written.
"""

import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import degrees

from inertial.text.cause_names import in_words
from inertial.text.messages import _
from stages.export.calibration import Calibration, Triad, Use, added_by
from stages.export.filter_noise import FilterNoise

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
    yield _(
        "The whole calibration, with every sigma, is in {campaign}.calibration.json, "
        "which also contains readings before and after the correction.",
        campaign=campaign["campaign"],
    )


def mounts(calibration: Calibration, chosen: Sequence[tuple[str, Triad]]) -> Iterator[str]:
    """From which mount the numbers are, where the campaign has several."""
    if len(calibration.mounts) > 1:
        names = ", ".join(f"{triad.kind} {_quoted(name)}" for name, triad in chosen)
        yield _(
            "The IMU was fixed on {mounts} mounts; each has an M of its own, because M "
            "contains the mounting rotation. These numbers are from: {names}.",
            mounts=len(calibration.mounts),
            names=names,
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


# ---- What the head of a file says of the noise: measured, for a filter, and why they differ.

UNITS = {
    "accelerometer": ("(m/s^2)/sqrt Hz", "(m/s^3)/sqrt Hz"),
    "gyroscope": ("(rad/s)/sqrt Hz", "(rad/s^2)/sqrt Hz"),
}


def explanation(
    use: Use, noise: Mapping[str, Sequence[FilterNoise]], *, corrected: bool
) -> Iterator[str]:
    """Why a filter gets more than was measured, in which motion and over which time.

    Nothing where the errors of the calibration are not known, as after a recording of the noise.

    corrected : the readings are corrected by all of the calibration before the filter gets them
    """
    if all(one.own_walk is None for found in noise.values() for one in found):
        return
    errors = (
        _("the sigmas of this calibration, for readings that were corrected by all of it")
        if corrected
        else _("the sigmas of this calibration, and all that is not corrected, as stated above")
    )
    yield _(
        "The noise for a filter contains the errors of the calibration itself, so it needs no "
        "further factor: {errors}. Their integral over T = {seconds:g} s was computed for a motion "
        "of {rate:g} deg/s rms about and {force:g} m/s^2 rms along each axis, which changes within "
        "{correlation:g} s, and for gravity in any direction (section export of config.yaml). What "
        "is constant (bias, gravity times scale factor and cross-axis errors) is added to the "
        "random walk of the bias, what follows the motion to the density, such that density^2 T + "
        "walk^2 T^3 / 3 is the variance of the integral at T. A bias instability that was measured "
        "is added to the random walk, as the one of the same Allan deviation at T.",
        errors=errors,
        seconds=use.seconds,
        rate=degrees(use.rate_rms),
        force=use.force_rms,
        correlation=use.correlation,
    )
    yield _(
        "It does not contain what a table cannot show: vibration of the vehicle, another "
        "temperature, the change of the biases from one switch-on to the next."
    )


def numbers(noise: Mapping[str, Sequence[FilterNoise]]) -> Iterator[str]:
    """By kind, measured and for a filter, each axis; nothing where nothing was measured."""
    for kind, found in noise.items():
        yield from _of_kind(kind, found)
    if any(one.walk_is_limit for found in noise.values() for one in found):
        yield _(
            "- a random walk after < is an upper limit (95 %): none is significant. The "
            "filter gets the limit, for without a random walk it would trust an old bias forever"
        )


def _of_kind(kind: str, found: Sequence[FilterNoise]) -> Iterator[str]:
    if not found:
        return
    density, walk = UNITS[kind]
    yield _(
        "- density of the {kind}s, {unit}: measured {measured}; for a filter {filtered}",
        kind=kind,
        unit=density,
        measured=_listed((one.axis, one.measured_density) for one in found),
        filtered=_listed((one.axis, one.density) for one in found),
    )
    measured = [one for one in found if one.walk is not None]
    if measured:
        yield _(
            "- random walk of the bias of the {kind}s, {unit}: measured {measured}; for a filter "
            "{filtered}",
            kind=kind,
            unit=walk,
            measured=_listed(
                ((one.axis, one.measured_walk) for one in measured),
                [one.walk_is_limit for one in measured],
            ),
            filtered=_listed((one.axis, one.walk) for one in measured),
        )
    if any(one.own_walk is None for one in found):
        yield _(
            "- the errors of the calibration are not contained for the {kind}s, because not all "
            "of their parameters were determined",
            kind=kind,
        )


def not_measured(found: Sequence[FilterNoise]) -> str:
    """Why there is no random walk, and what the calibration alone contributes to it."""
    own = [one.own_walk for one in found if one.own_walk is not None]
    alone = (
        _(" The errors of the calibration alone are worth {own:.2g}.", own=max(own)) if own else ""
    )
    return (
        _(
            "it was not measured: no static stretch is long enough. Record one of an hour or "
            "more (do: rest)."
        )
        + alone
    )


def _listed(values: Iterable[tuple[str, float | None]], limits: Sequence[bool] = ()) -> str:
    signs = ["<" if limit else "=" for limit in limits] or ["="] * 3
    return ", ".join(
        f"{axis}{sign}{value:.4g}" for (axis, value), sign in zip(values, signs, strict=False)
    )
