"""A static position inconsistent with the others, as a finding with the affected parameters.

Only where the rests do not determine all parameters: else criticism weighs the position against
every effect of the accelerometers, and what it finds likelier is said once.
"""

from collections.abc import Iterator
from math import degrees

import numpy as np
from numpy.typing import NDArray

from inertial.campaign.estimates import NAMES
from inertial.campaign.findings import Finding
from inertial.campaign.records import with_mount
from inertial.estimation.position_outlier import OffPosition
from inertial.tables import AXES
from inertial.text.messages import _
from inertial.text.numbers import fixed, significant
from inertial.text.parameters import PARTS
from inertial.text.units import quantity

Array = NDArray[np.float64]

MIN_NOTABLE_SIGMA = 1.0  # sigmas of the estimate by which a term must move to be named
WORDS = {
    "bias": _("bias of the {row} accelerometer"),
    "scale": _("scale factor of the {row} accelerometer"),
    "cross": _("response of the {row} accelerometer to force along {column}"),
}


def findings(off: OffPosition, sigma: Array, mount: str) -> Iterator[Finding]:
    """One finding; `sigma`: (12,), of the parameters without the scatter."""
    cause, several = "table_position_error", len(off.positions) > 1
    names = _(" or ").join(off.positions)
    axis = int(np.argmax(np.abs(off.about)))
    affected = [
        _change(name, float(off.moved[i]))
        for i, name in enumerate(NAMES)
        if abs(off.moved[i]) > MIN_NOTABLE_SIGMA * sigma[i]
    ]
    size = fixed(degrees(off.tilt), 4)
    yield Finding(
        id="/".join(("accelerometer", with_mount(cause, mount), off.positions[0])),
        cause=cause,
        mount=mount,
        sensor="accel",
        manoeuvre=off.positions[0],
        size=off.tilt,
        unit="rad",
        p_value=off.p_value,
        severity=2,
        sentence=_(
            "The position {names} deviates by {size} ± {fixed}°, mostly about {axes}, "
            "from all others.",
            names=names,
            size=size,
            fixed=fixed(degrees(off.sigma), 4),
            axes=AXES[axis],
        )
        + (_(" The readings do not distinguish which of these it is.") if several else "")
        + _(
            " Or the accelerometers have an error outside the twelve parameters: these rests do "
            "not tell the two apart."
        ),
        consequence=(
            _(
                "With its attitude estimated, {affected}. The joint estimate models it as "
                "scatter between positions.",
                affected="; ".join(affected),
            )
            if affected
            else _("No parameter moves by more than its sigma.")
        ),
        action=_("Set this position again and record it; or state position_sigma_arcsec as it is."),
    )


def _change(name: str, by: float) -> str:
    parts = PARTS[name]
    kind = parts.kind
    words = WORDS[kind].format(row=parts.sensor_axis, column=parts.input_axis)
    unit = quantity(name, "m/s²" if kind == "bias" else "1").laboratory
    return _(
        "the {words} moves by {significant} {name}",
        words=words,
        significant=significant(unit.of(by), 3),
        name=unit.name,
    )
