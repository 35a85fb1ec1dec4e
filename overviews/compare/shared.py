"""The references that two campaigns share: errors that both results contain alike.

A reference of error e moves a parameter of both results by s₁ e and s₂ e, so that their difference
has the variance

    σ₁² + σ₂² − 2 Σ s₁ s₂ σ_e²        over the shared references, see `references`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from math import sqrt

from inertial.campaign.references import TABLE_RATE, References, references_of
from inertial.text.messages import _
from stages.report.tables import Tables

TABLE_SOURCES = ("position", "angle", "rate")
Key = tuple[str, str, str]  # mount, sensor and quantity


@dataclass(frozen=True)
class Shared:
    """Which references two campaigns share, and their shares in the variance of each parameter.

    `sources`: those whose error is the same for certain; `table`: it is the same table at the same
    positions, whose errors repeat as far as they are not chance, which nobody states.
    """

    references: tuple[References, References]
    shares: tuple[Mapping[tuple[Key, str], float], Mapping[tuple[Key, str], float]]

    @property
    def sources(self) -> tuple[str, ...]:
        """In the order of the first."""
        first, second = self.references
        return tuple(s for s, name in first.sources.items() if second.sources.get(s) == name)

    @property
    def same_plan(self) -> bool:
        """Whether both set the same in the same order."""
        return self.references[0].plan == self.references[1].plan

    @property
    def table(self) -> bool:
        """See above."""
        first, second = self.references
        return self.same_plan and first.table is not None and first.table == second.table

    def covariance(self, key: Key, sigmas: tuple[float, float], *, table: bool = False) -> float:
        """Of the two values of a parameter; `table`: as if all errors of the table repeated."""
        first, second = self.references
        _mount, *of = key
        alike = [s for s in self.sources if first.name(s, *of) == second.name(s, *of)]
        return sum(
            sigmas[0] * sigmas[1] * sqrt(self._share(0, key, source) * self._share(1, key, source))
            for source in (*alike, *(TABLE_SOURCES if table and self.table else ()))
        )

    def _share(self, which: int, key: Key, source: str) -> float:
        return min(self.shares[which].get((key, source), 0.0), 1.0)


def shared_by(first: Tables, second: Tables) -> Shared:
    """What two campaigns share, as far as their plans say."""
    both = (first, second)
    of = [references_of(t.row("campaign"), t.rows("known"), t.rows("manoeuvres")) for t in both]
    return Shared((of[0], of[1]), (_shares(first), _shares(second)))


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
    of_site = [source for source in shared.sources if source in words]
    if of_site and not missing:
        said.append(
            _(
                "Both stand at one place and take the same {references} as known: its error is in "
                "both results alike, and is not in the σ of the differences.",
                references=_(" and ").join(words[of] for of in of_site),
            )
        )
    if of_site and not shared.same_plan and not missing:
        said.append(
            _(
                "The plans differ, so that only the scale factors of the accelerometers are known "
                "to contain it alike."
            )
        )
    steady = [any(source == TABLE_RATE for _key, source in own) for own in shared.shares]
    if TABLE_RATE in shared.sources and all(steady):
        said.append(
            _(
                "Both were turned at known rates of one table: by which share all of these are off "
                "is in the scale factors of both alike, and is not in the σ of the differences."
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
