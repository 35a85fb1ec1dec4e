"""Whether a parameter is within its tolerance, |truth| ≤ T, by an estimate y ± σ (JCGM 106:2012).

Both rules are binary acceptance on the measured value: simple acceptance takes the tolerance itself
as the acceptance interval (8.2), the guarded one narrows it by w = U = 2 σ (8.3.2, ISO 14253-1). A
guarded rejection widens it as much, and between both nothing is shown. Errors are normal, nothing
else is known of the parameter, so P(truth ≤ x) = Φ((x − y)/σ).
"""

from dataclasses import dataclass

from scipy.stats import norm

from inertial.text.units import COVERAGE_FACTOR

GUARD_BAND, SIMPLE_ACCEPTANCE = "guard_band", "simple_acceptance"
CONFORMS, DOES_NOT_CONFORM, NOT_SHOWN = "conforms", "does_not_conform", "not_shown"


@dataclass(frozen=True)
class Decision:
    """A statement, and the probability that it is wrong; none where nothing is shown."""

    statement: str
    risk: float | None


def decision(value: float, sigma: float, limit: float, rule: str) -> Decision:
    """The statement on |truth| ≤ limit, all in one unit; the limit is positive."""
    guard = COVERAGE_FACTOR * sigma if rule == GUARD_BAND else 0.0
    outside = float(norm.sf((limit - value) / sigma) + norm.cdf((-limit - value) / sigma))
    if abs(value) <= limit - guard:
        return Decision(CONFORMS, outside)
    if abs(value) > limit + guard:
        return Decision(DOES_NOT_CONFORM, 1 - outside)
    return Decision(NOT_SHOWN, None)
