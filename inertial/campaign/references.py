"""The references that a campaign rests on, by names that are equal where the reference is the same.

An error of a reference is in all results that rest on it alike, so it is in none of their
differences. Of error e it moves a parameter of both by s₁ e and s₂ e; the uncertainty budget gives
its share h in the variance of each parameter, |s| σ_e = σ √h. That s₁ and s₂ have one sign is
certain for scale factors, which read gravity, or rates of the table, in both, and where both plans
are the same. By which share all rates of a table are off is one error. Its other errors repeat as
far as they are not chance, which nobody states: so they are none of these.
"""

from collections.abc import Iterable
from dataclasses import dataclass
from hashlib import sha256

from inertial.campaign.records import Row
from inertial.text.parameters import SCALE

DIGITS = 9  # of a stated number, by which two are one
DECIMALS = 6  # of a set direction or angle
BY_HAND = "by hand"
NOT_NAMED = "not named"  # of a table, as plans, drafts and the stage plan write it
NAMELESS = (BY_HAND, NOT_NAMED, "not known", "unknown")  # of the column table: it may be any
POSE = ("do", "mount", "angle", *(f"{of}_{a}" for of in ("up", "mark", "about") for a in "xyz"))
QUANTITIES = {"gravity": "gravity", "latitude": "earth_rate_up"}  # by source, as in known
TABLE_RATE = "table_rate"  # the source of the error of all rates of a table
READ_AS_SCALE = {"gravity": "accel", TABLE_RATE: "gyro"}  # by source: by the sensor whose scale


@dataclass(frozen=True)
class References:
    """`sources`: names of what was taken as known, such as gravity there; `table`: or none.

    `plan`: what was set in each manoeuvre, in the order of the plan.
    """

    sources: dict[str, str]
    table: str | None
    plan: str

    def name(self, source: str, sensor: str, parameter: str) -> str:
        """Of the error of a reference in a parameter: equal where both contain it alike."""
        alike = READ_AS_SCALE.get(source) == sensor and parameter in SCALE
        return self.sources[source] if alike else f"{self.sources[source]} plan {self.plan}"


def references_of(campaign: Row, known: Iterable[Row], manoeuvres: Iterable[Row]) -> References:
    """By rows of the tables of the plan."""
    values = {row["quantity"]: row["value"] for row in known}
    place = (campaign["latitude"], campaign["height"])
    sources = {
        source: " ".join([source, *(f"{each:.{DIGITS}g}" for each in (*place, values[quantity]))])
        for source, quantity in QUANTITIES.items()
        if None not in (*place, values.get(quantity))
    }
    poses = [
        [round(v, DECIMALS) + 0.0 if isinstance(v := row[key], float) else v for key in POSE]
        for row in manoeuvres
    ]
    table = None if campaign["table"] in NAMELESS else campaign["table"]
    if table is not None:
        sources[TABLE_RATE] = f"{TABLE_RATE} {table}"
    return References(sources, table, sha256(repr(poses).encode()).hexdigest()[:16])


def reference_rows(references: References, budget: Iterable[Row]) -> list[Row]:
    """What of each parameter's sigma is the error of a reference; `budget`: of uncertainty."""
    return [
        {key: row[key] for key in ("mount", "sensor", "sigma")}
        | {"parameter": row["quantity"]}
        | {"reference": references.name(row["source"], row["sensor"], row["quantity"])}
        for row in budget
        if row["source"] in references.sources
    ]
