"""What a page of a fleet reads of each campaign: places and tables. It loads no library."""

from inertial import tables

READ = {
    "campaign": ("plan/campaign.parquet", tables.CAMPAIGN),
    "inputs": ("plan/inputs.parquet", tables.INPUTS),
    "known": ("plan/known.parquet", tables.KNOWN),
    "score": ("criticism/score_vector.parquet", tables.SCORE_VECTOR),
    "information": ("criticism/information_matrix.parquet", tables.INFORMATION_MATRIX),
    "result": ("diagnosis/result.parquet", tables.PARAMETERS),
    "covariance": ("diagnosis/covariance.parquet", tables.COVARIANCE),
}
