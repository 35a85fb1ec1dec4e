"""From a number of the report down to the lines of the logs that it came from."""
