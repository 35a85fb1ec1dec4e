"""What a page of a fleet reads of each campaign. It loads no library."""

from inertial import tables
from inertial.tables.declared import From, of_stage

READ = {
    **of_stage("plan", tables.CAMPAIGN, tables.INPUTS, tables.KNOWN, tables.MANOEUVRES),
    "score": From("criticism", tables.SCORE_VECTOR),
    "information": From("criticism", tables.INFORMATION_MATRIX),
    "scores": From("criticism", tables.SCORES),
    "result": From("diagnosis", tables.PARAMETERS, "result"),
    "covariance": From("diagnosis", tables.COVARIANCE),
    "uncertainty_budget": From("compensation", tables.UNCERTAINTY_BUDGET),
}
