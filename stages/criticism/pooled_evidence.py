"""Information of the campaign on effects too small to detect in it alone, for fleets."""

from collections.abc import Iterator

import numpy as np

from inertial.effects import CATALOGUE
from inertial.estimation.effect_information import MIN_INFORMATION_SHARE as MIN_SHARE
from stages.criticism.finding_rows import TableRow
from stages.criticism.selection import Selection

# Those without a scan mean the same in every campaign; one that has a single size, or is absent,
# is a mistake in a statement.
POOLED = tuple(
    effect
    for effect in CATALOGUE.values()
    if effect.sought_in == "blocks" and effect.scan is None and effect.only is None
)


def pooled_evidence_rows(selection: Selection, mount: str) -> Iterator[TableRow]:
    """Score and information of the pooled effects; named effects of other kinds are fitted.

    Where the residuals exceed the noise also with the named effects, their size is what counts.
    """
    evidence = selection.evidence.observable()
    if not evidence.sensors:
        return
    if selection.named.excesses:
        evidence = evidence.scaled(selection.named.excesses)
    place = {name: i for i, name in enumerate(evidence.names)}
    own = {
        name: (effect, parameter)
        for effect in POOLED
        for name, parameter in zip(effect.columns, effect.parameters, strict=True)
        if name in place
    }
    pooled = [place[name] for name in own]
    others = {i for cause in selection.named.causes for i in cause.columns} - set(pooled)
    total = evidence.total.given(sorted(others)) if others else evidence.total
    left, whole = np.diag(total.information), np.diag(evidence.total.information)
    shown = {
        i: of for i, of in zip(pooled, own.values(), strict=True) if left[i] > MIN_SHARE * whole[i]
    }
    for i, (effect, parameter) in shown.items():
        row = {"mount": mount, "effect": effect.name, "parameter": parameter.name}
        yield "score_vector", row | {"unit": parameter.unit, "score": float(total.right[i])}
        for j, (with_effect, with_parameter) in shown.items():
            information = float(total.information[i, j])
            if j >= i and information:
                column = {"with_effect": with_effect.name, "with_parameter": with_parameter.name}
                yield "information_matrix", row | column | {"information": information}
