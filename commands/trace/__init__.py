"""From a number of the report down to the lines of the logs from which it was computed."""
