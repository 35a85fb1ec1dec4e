"""Stage `pdf`: the report for print."""
