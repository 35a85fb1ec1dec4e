"""Where the manoeuvres of the plan are in the logs, and each reduced to short means."""
