"""All campaigns on one page, with all IMUs and when they are due."""
