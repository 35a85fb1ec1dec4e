"""One finding: what is wrong where, how large, what it does to the result, what to do."""

from dataclasses import asdict, dataclass

import pandas as pd

from inertial.tables import FINDINGS


@dataclass(frozen=True)
class Finding:
    """A row of the findings table; times in s, `size` in `unit`."""

    id: str
    cause: str
    sentence: str
    consequence: str
    action: str
    severity: int  # 3 spoils a result, 2 weakens it, 1 is good to know
    sensor: str | None = None
    axis: str | None = None
    log: str | None = None
    manoeuvre: str | None = None
    from_s: float | None = None
    to_s: float | None = None
    count: int = 1
    size: float | None = None
    unit: str = "1"
    p_value: float | None = None


def table_of(findings: list[Finding]) -> pd.DataFrame:
    """The findings table, which may be empty."""
    return pd.DataFrame([asdict(f) for f in findings]) if findings else FINDINGS.empty()
