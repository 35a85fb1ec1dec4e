"""The references that two campaigns share: errors that both results contain alike.

A reference of error e moves a parameter of both results by s₁ e and s₂ e, so that their difference
has the variance

    σ₁² + σ₂² − 2 Σ s₁ s₂ σ_e²        over the shared references.

The uncertainty budget of a campaign gives the share h of a reference in the variance of each
parameter, |s| σ_e = σ √h. That s₁ and s₂ have one sign is certain for gravity and scale factors,
which read gravity in both, and where both plans are the same.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import isclose, sqrt

from inertial.text.messages import _
from inertial.text.parameters import SCALE
from stages.report.tables import Record, Tables

SAME = 1e-9  # relative, within which two stated numbers are one
NAMELESS = ("by hand", "not named")  # of the column table: it may be any
TABLE_SOURCES = ("position", "angle")
POSE = ("do", "mount", "angle", *(f"{of}_{a}" for of in ("up", "mark", "about") for a in "xyz"))
DECIMALS = 6  # of a set direction or angle
Key = tuple[str, str, str]  # mount, sensor and quantity


@dataclass(frozen=True)
class Shared:
    """Which references two campaigns share, and their shares in the variance of each parameter.

    `sites`: sources whose error is the same for certain; `table`: it is the same table at the same
    positions, whose errors repeat as far as they are not chance, which nobody states.
    """

    sites: tuple[str, ...]
    table: bool
    same_plan: bool
    shares: tuple[Mapping[tuple[Key, str], float], Mapping[tuple[Key, str], float]]

    def covariance(self, key: Key, sigmas: tuple[float, float], *, table: bool = False) -> float:
        """Of the two values of a parameter; `table`: as if all errors of the table repeated."""
        sources = (*self.sites, *(TABLE_SOURCES if table and self.table else ()))
        return sum(
            sigmas[0] * sigmas[1] * sqrt(self._share(0, key, of) * self._share(1, key, of))
            for of in sources
            if self.same_plan or (of == "gravity" and key[2] in SCALE)
        )

    def _share(self, which: int, key: Key, source: str) -> float:
        return min(self.shares[which].get((key, source), 0.0), 1.0)


def shared_by(first: Tables, second: Tables) -> Shared:
    """What two campaigns share, as far as their plans say."""
    about = (first.row("campaign"), second.row("campaign"))
    place = all(
        about[0][key] is not None and _same(about[0][key], about[1][key])
        for key in ("latitude", "height")
    )
    known = [{row["quantity"]: row for row in tables.rows("known")} for tables in (first, second)]
    sites = []
    if place and _same_known(known[0].get("gravity"), known[1].get("gravity")):
        sites.append("gravity")
    if place and _same_known(known[0].get("earth_rate_up"), known[1].get("earth_rate_up")):
        sites.append("latitude")
    same_plan = _poses(first) == _poses(second)
    one_table = about[0]["table"] == about[1]["table"] and about[0]["table"] not in NAMELESS
    return Shared(
        tuple(sites), one_table and same_plan, same_plan, (_shares(first), _shares(second))
    )


def _same(one: float, other: float) -> bool:
    return isclose(one, other, rel_tol=SAME, abs_tol=0.0)


def _same_known(one: Record | None, other: Record | None) -> bool:
    """Whether both take the same value as known; its error is then one, whatever it is."""
    if one is None or other is None or one["value"] is None or other["value"] is None:
        return False
    return _same(one["value"], other["value"])


def _poses(tables: Tables) -> list[tuple[object, ...]]:
    """What was set in each manoeuvre, in the order of the plan."""
    return [
        tuple(round(v, DECIMALS) if isinstance(v := row[key], float) else v for key in POSE)
        for row in tables.rows("manoeuvres")
    ]


def _shares(tables: Tables) -> dict[tuple[Key, str], float]:
    return {
        ((row["mount"], row["sensor"], row["quantity"]), row["source"]): float(row["share"])
        for row in tables.rows("uncertainty_budget")
    }


def in_sentences(shared: Shared, names: tuple[str, str]) -> list[str]:
    """What is shared and what follows from it."""
    said = []
    words = {"gravity": _("gravity"), "latitude": _("latitude")}
    missing = [n for n, own in zip(names, shared.shares, strict=True) if not own]
    if shared.sites and not missing:
        said.append(
            _(
                "Both stand at one place and take the same {references} as known: its error is in "
                "both results alike, and is not in the σ of the differences.",
                references=_(" and ").join(words[of] for of in shared.sites),
            )
        )
    if shared.sites and not shared.same_plan and not missing:
        said.append(
            _(
                "The plans differ, so that only the scale factors of the accelerometers are known "
                "to contain it alike."
            )
        )
    if shared.table and not missing:
        said.append(
            _(
                "Both were set to the same positions of one table. As far as its errors repeat the "
                "differences are surer than σ says: the last column has σ if all of them did. p is "
                "by the former."
            )
        )
    if missing:
        said.append(
            _(
                "No uncertainty budget is known of {campaigns}: the values are compared as "
                "independent ones.",
                campaigns=_(" and ").join(missing),
            )
        )
    return said
