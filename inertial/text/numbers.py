"""How a number is written: as many digits as its sigma allows, digits under digits."""

import re
from collections.abc import Iterable, Sequence
from math import floor, isfinite, log10

from inertial.text.messages import ENGLISH, THIN_SPACE, Recipe, _, language, noun, remember

FIGURE_SPACE = "\u2007"  # as wide as a digit
POINT_SPACE = "\u2008"  # as wide as a decimal point
KEPT = frozenset(("\n", FIGURE_SPACE, POINT_SPACE, THIN_SPACE))  # no control characters
DIGITS_OF_SIGMA = 2
MOST_DECIMALS = 15
NUMBER = re.compile(r"[^\d×±]*[\d\u202f]+(?:\.(\d+))?")  # alone, after a sign or a mark


def fixed(value: float | None, decimals: int) -> str:
    """`value` with so many decimals and a true minus sign; — where there is none.

    Decimals below zero are places before the point: −2 is to hundreds.
    """
    if value is None or not isfinite(value):
        return "—"
    text = f"{round(value, decimals) if decimals < 0 else value:.{max(decimals, 0)}f}"
    return text.removeprefix("-") if float(text) == 0 else text.replace("-", "−")


def significant(value: float | None, digits: int = 4) -> str:
    """`value` to so many significant digits; with a power of ten where it is far from 1."""
    if value is None or not isfinite(value):
        return "—"
    if value == 0:
        return "0"
    # Rounded first: 9.9996 to four digits is 10.00.
    exponent = floor(log10(abs(float(f"{value:.{digits - 1}e}"))))
    if -4 <= exponent < 6:
        return fixed(value, digits - 1 - exponent)
    return f"{fixed(value / 10.0**exponent, digits - 1)} × 10{raised(exponent)}"


def raised(exponent: int) -> str:
    """`exponent` as a superscript."""
    return str(exponent).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def decimals_of(sigma: float | None, digits: int = DIGITS_OF_SIGMA) -> int | None:
    """Decimals that show `digits` significant digits of `sigma`, below zero where these end
    before the point; none without a sigma."""
    if sigma is None or not isfinite(sigma) or sigma <= 0:
        return None
    exponent = floor(log10(float(f"{sigma:.{digits - 1}e}")))
    return min(digits - 1 - exponent, MOST_DECIMALS)


def common_decimals(sigmas: Iterable[float | None]) -> int | None:
    """Decimals for numbers that stand below each other: those of the smallest sigma.

    `with_sigma` gives fewer to those that are less sure.
    """
    return max((d for sigma in sigmas if (d := decimals_of(sigma)) is not None), default=None)


def with_sigma(value: float | None, sigma: float | None, decimals: int | None) -> tuple[str, str]:
    """A value and its sigma with the same decimals; to five digits where no sigma is known.

    It has no more digits than its own sigma knows, whatever the decimals (GUM, 7.2.6).
    """
    if decimals is None:
        return significant(value, 5), "—"
    own = decimals_of(sigma)
    decimals = decimals if own is None else min(decimals, own)
    return fixed(value, decimals), fixed(sigma, decimals)


def with_own_sigma(
    value: float | None, sigma: float | None, digits: int = DIGITS_OF_SIGMA
) -> tuple[str, str]:
    """A value and its sigma, to so many digits of that."""
    return with_sigma(value, sigma, decimals_of(sigma, digits))


def plus_minus(value: float | None, sigma: float | None, digits: int = DIGITS_OF_SIGMA) -> str:
    """The same in a sentence: value ± sigma."""
    return " ± ".join(with_own_sigma(value, sigma, digits))


def aligned(texts: Sequence[str]) -> list[str]:
    """`texts` padded on the right so that their decimal points stand below each other."""
    found = [NUMBER.fullmatch(text) for text in texts]
    longest = max((len(number[1] or "") for number in found if number), default=0)
    return [
        text + POINT_SPACE * (number[1] is None) + FIGURE_SPACE * (longest - len(number[1] or ""))
        if number and longest
        else text
        for text, number in zip(texts, found, strict=True)
    ]


def whole(value: float | None) -> str:
    """A count with its thousands apart."""
    if value is None or not isfinite(value):
        return "—"
    return f"{round(value):,}".replace(",", THIN_SPACE).replace("-", "−")


def probability(p_value: float | None) -> str:
    """A p-value, with its order of magnitude where it is small.

    Of one below 10⁻¹² only that is said: no noise is known to be Gaussian so far out.
    """
    if p_value is None or not isfinite(p_value):
        return "—"
    if p_value < 1e-12:
        return "< 10⁻¹²"
    if p_value < 1e-3:
        digit, _, exponent = f"{p_value:.0e}".partition("e")
        return f"{digit} × 10{raised(int(exponent))}"
    return fixed(p_value, 3 if p_value < 0.1 else 2)


def p_is(p_value: float | None) -> str:
    """A p-value as part of a sentence: p = 0.41, p < 10⁻¹²."""
    text = probability(p_value)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


NOUNS = (  # that are counted where no one sees them: inside of other strings, or by a name
    _("check"),
    _("day"),
    _("manoeuvre"),
    _("pair"),
    _("position"),
    _("reading"),
    _("record"),
    _("refused line"),
    _("sample"),
    _("cause"),
    _("value"),
)


def counted(count: int, one: str, many: str = "") -> str:
    """`count` with its noun, a message: 1 finding, 3 findings, no findings."""
    number = whole(count) if count else _("no")
    if language() != ENGLISH:
        return _("{number} {noun}", number=number, noun=noun(one))
    text = f"{number} {one if count == 1 else many or f'{one}s'}"
    remember(text, Recipe(("{number} {noun}",), {"number": number, "noun": noun(one)}))
    return text


def shortened(text: str, most: int) -> str:
    """The beginning of a long text, control characters made visible."""
    seen = visible(text).strip()
    return seen if len(seen) <= most else seen[: most - 1].rstrip() + "…"


def visible(text: str) -> str:
    """A text from outside in which nothing can act on a terminal: control characters show as �."""
    return "".join(letter if letter.isprintable() or letter in KEPT else "�" for letter in text)
