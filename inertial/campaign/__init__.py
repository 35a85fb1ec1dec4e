"""Between tables and arrays: the records of a campaign, its static positions and rate segments."""
