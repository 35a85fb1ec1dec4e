"""What all findings have in common: identifiers, the members of a class, and parameters."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import numpy as np

from inertial.campaign.effect_sentences import Estimated
from inertial.campaign.records import with_mount
from inertial.text.messages import _

Row = Mapping[str, Any]
TableRow = tuple[str, Row]  # the name of a table that the stage writes, and a row of it

ONLY_CONSISTENT = _("The data are no more than consistent with {effects}.")


def finding_id(cause: str, mount: str, *places: str) -> str:
    """A stable identifier; it is compared and shown, never parsed."""
    return "/".join(["criticism", with_mount(cause, mount), *places])


def finding_row(cause: str, mount: str, **columns: Any) -> TableRow:
    """A row of `findings`: one, of severity 2, called by its cause, unless `columns` differ."""
    row = {
        "id": finding_id(cause, mount),
        "mount": mount,
        "cause": cause,
        "count": 1,
        "severity": 2,
    }
    return "findings", row | columns


def member_rows(
    finding: str,
    mount: str,
    members: Sequence[str],
    probability: Sequence[float] = (),
    captured: Sequence[float] = (),
) -> Iterator[TableRow]:
    """The effects of a class, the most probable first."""
    for i, effect in enumerate(members):
        row = {"finding": finding, "mount": mount, "rank": i + 1, "effect": effect}
        row |= {"probability": probability[i] if probability else None}
        yield "members", row | {"captured": captured[i] if captured else None}


def parameter_row(
    mount: str, effect: str, parameter: Estimated, finding: str | None, identifier: str
) -> TableRow:
    """A row of `effects`; `identifier`: of the effect, or of the finding where it has several."""
    return "effects", {
        "id": f"{identifier}/{parameter.name}",
        "mount": mount,
        "finding": finding,
        "effect": effect,
        "parameter": parameter.name,
        "value": parameter.value,
        "sigma": parameter.sigma,
        "detection_limit": parameter.detection_limit,
        "least_squares": parameter.least_squares,
        "unit": parameter.unit,
        "meaning": parameter.meaning,
    }


def snr_of(statistic: float, degrees: int) -> float:
    """Signal-to-noise ratio: the statistic less what noise adds to it."""
    return float(np.sqrt(max(statistic - degrees, 0.0)))
