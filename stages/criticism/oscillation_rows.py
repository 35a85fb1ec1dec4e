"""The oscillations as rows: the strongest of each axis, and the detection limits."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.steady_residuals import SteadyTurn
from inertial.effects import CATALOGUE
from inertial.effects.table_ripple import HIGHEST, LOWEST, STEP
from inertial.estimation.periodic_in_angle import SUFFICES
from inertial.model_selection.detection_limits import NOT_EXCITED, VISIBLE
from inertial.tables import AXES
from inertial.text.cause_names import in_words
from inertial.text.numbers import significant
from inertial.text.units import ARC_SECOND
from stages.criticism import oscillation_words as words
from stages.criticism.oscillation_fits import Ringing
from stages.criticism.oscillation_search import TABLE, Bound, Heard

# ---- The lines of the turns as rows: the strongest of each axis, and what was found beneath them.

Row = dict[str, Any]


def listed(heard: Heard, named: Sequence[tuple[str, Bound]]) -> Iterator[Row]:
    """The strongest line of each axis in each turn; then others of what was found.

    named : each oscillation with the effect that it is taken for
    """
    turns = {turn.name: turn for turn in heard.turns}
    told = set()
    for ring in heard.strongest:
        turn = turns[ring.manoeuvre]
        effect = next((name for name, one in named if _is(ring, one, turn)), None)
        told.add((ring.manoeuvre, ring.axis, effect))
        yield _row(ring, turn, effect)
    for name, one in named:
        for ring in one.shown:
            turn = turns[ring.manoeuvre]
            if (ring.manoeuvre, _axis(ring, turn), name) not in told:
                yield _row(ring, turn, name)


def _is(ring: Ringing, one: Bound, turn: SteadyTurn) -> bool:
    """Whether a line is that of an oscillation: within a bin."""
    frequency = one.frequencies.get(turn.name, np.inf)
    return abs(ring.line.frequency - frequency) < 1 / turn.seconds


def _axis(ring: Ringing, turn: SteadyTurn) -> str:
    """The axis of the case that is nearest to that of the line."""
    return ring.axis if ring.axis != TABLE else AXES[int(np.argmax(np.abs(turn.about)))]


def _row(ring: Ringing, turn: SteadyTurn, effect: str | None) -> Row:
    return {
        "manoeuvre": ring.manoeuvre,
        "axis": _axis(ring, turn),
        "frequency": ring.line.frequency,
        "frequency_sigma": ring.line.sigma_frequency,
        "amplitude": ring.line.amplitude,
        "amplitude_sigma": ring.line.sigma_amplitude,
        "p_value": ring.line.p_value,
        "order": ring.line.frequency / turn.hertz(1.0) if np.isfinite(turn.rate) else None,
        "effect": effect,
    }


# ---- What the turns could have shown of oscillations: of amplitudes, a and b, and for which
# orders.

Array = NDArray[np.float64]

IN_TIME, RIPPLE, ECCENTRICITY = "oscillation", "table_ripple", "table_eccentricity"
EFFECTS = (IN_TIME, RIPPLE, ECCENTRICITY)
SHOWN = {IN_TIME: ("amplitude",), RIPPLE: ("a", "b"), ECCENTRICITY: ("a", "b")}


@dataclass(frozen=True)
class Seen:
    """From what size on a parameter is seen: at a usual order, at the best and at the worst."""

    size: float
    best: float
    worst: float


def seen(heard: Heard, name: str) -> Seen | None:
    """Of one of the three effects; none where no turn shows any size."""
    if name == IN_TIME:
        sizes = SUFFICES * np.array([ring.line.sigma_amplitude for ring in heard.strongest])
    elif heard.orders is None:
        return None
    else:
        sizes = heard.orders.sigma * heard.seen
        sizes = (
            sizes[:1]
            if name == ECCENTRICITY
            else np.interp(orders(heard), heard.orders.order, sizes)
        )
    sizes = sizes[np.isfinite(sizes)]
    if not len(sizes):
        return None
    return Seen(float(np.median(sizes)), float(sizes.min()), float(sizes.max()))


def orders(heard: Heard) -> Array:
    """The orders of the catalogue's ripple that sampling lets see."""
    assert heard.orders is not None  # else no one asks
    tried = np.arange(LOWEST, HIGHEST + STEP / 2, STEP)
    return np.asarray(tried[tried <= heard.orders.order[-1]])


def silence(heard: Heard, name: str) -> str:
    """Why an effect that is not named is not, in a sentence."""
    title = in_words(name)
    if heard.more:
        return f"Beside {len(heard.lines)} oscillations that are named no {title} was looked for."
    if name == IN_TIME:
        if not heard.strongest:
            return f"This campaign cannot show an oscillation: {words.NO_TURN}."
        if heard.lines:
            return "No oscillation is left beside what is named."
        return "No oscillation stands out of the noise of the turns."
    if heard.orders is None:
        reason = words.NO_ANGLE if heard.turns else words.NO_TURN
        return f"This campaign cannot show {title}: {reason}."
    size = seen(heard, name)
    told = f"No {title} stands out of the noise of the turns."
    if size is None:
        return f"{told} Noise so slow is told by how turns differ, and there is one only."
    return f"{told} It would be {_from(heard, name, size)}"


def blind_spots(heard: Heard, suffix: str) -> Iterator[Row]:
    """A row for each parameter that is a size; any frequency is heard, and any order."""
    for name in EFFECTS:
        size = seen(heard, name)
        for parameter in CATALOGUE[name].parameters:
            if parameter.name not in SHOWN[name]:
                continue
            title = f"{in_words(name)}, {parameter.name}"
            yield {
                "effect": f"{name}{suffix}",
                "parameter": parameter.name,
                "visible": size.size if size else None,
                "best": size.best if size else None,
                "worst": size.worst if size else None,
                "unit": parameter.unit,
                "reason": VISIBLE if size else NOT_EXCITED,
                "sentence": f"{title}: {_from(heard, name, size)}"
                if size
                else f"{title}: not seen. {silence(heard, name)}",
            }


def _from(heard: Heard, name: str, size: Seen) -> str:
    if name == IN_TIME:
        return f"seen from {significant(size.size, 2)} rad/s on in each turn."
    arcs = [significant(one / ARC_SECOND, 2) for one in (size.size, size.worst, size.best)]
    if name == ECCENTRICITY:
        longest = max(t.seconds * t.hertz(1.0) for t in heard.turns if np.isfinite(t.rate))
        return f"seen from {arcs[0]}″ on.{words.of_short_turn(longest)}"
    tried = [significant(one, 3) for one in orders(heard)[[0, -1]]]
    return (
        f"seen from {arcs[0]}″ on; from {arcs[1]}″ where it has {tried[0]} periods in a turn, from"
        f" {arcs[2]}″ where it has {tried[1]}."
    )
