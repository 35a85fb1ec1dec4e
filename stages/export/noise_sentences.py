"""What the head of a file says of the noise: measured, for a filter, and why they differ."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from math import degrees

from inertial.text.messages import _
from stages.export.calibration import Use
from stages.export.filter_noise import FilterNoise

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
        "random walk of the bias, what follows the motion to the density, such that "
        "density^2 T + walk^2 T^3 / 3 is the variance of the integral at T. A bias instability "
        "that was measured is added to the random walk, as the one of the same Allan deviation "
        "at T.",
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
