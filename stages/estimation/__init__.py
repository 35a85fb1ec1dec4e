"""Between the tables and inference: what the blocks of a campaign say, and rows of results."""
