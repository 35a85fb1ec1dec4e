"""A number of the report by its identifier, such as `gyroscope/joint/bias_x`."""

import difflib
from dataclasses import dataclass

from inertial.campaign.records import Row, rows_of
from inertial.tables import PARAMETERS
from inertial.tables.errors import Refusal
from stages.tracing.origins import Campaign

NEAR = 6  # identifiers that are offered where one is not known


@dataclass(frozen=True)
class Number:
    """A row of PARAMETERS, and the table it stands in: folder/file."""

    row: Row
    table: str


def number(campaign: Campaign, identifier: str) -> Number:
    """The number with this identifier.

    Raises
    ------
    Refusal
        where the campaign has no results, or none with this identifier, with near ones
    """
    found: dict[str, Number] = {}
    for path in sorted(campaign.derived.glob("*/parameters.parquet")):
        table = f"{path.parent.name}/{path.name}"
        found |= {row["id"]: Number(row, table) for row in rows_of(PARAMETERS.read(path))}
    if not found:
        raise Refusal(
            str(campaign.derived),
            "",
            "no results",
            "tables of parameters",
            f"run the campaign: make report CAMPAIGN={campaign.name}",
        )
    if identifier not in found:
        near = difflib.get_close_matches(identifier, found, n=NEAR, cutoff=0.5)
        raise Refusal(
            str(campaign.derived),
            "",
            f"no number {identifier!r}",
            f"one of {', '.join(near or found)}",
            "give one of these: ID=<number>",
        )
    return found[identifier]
