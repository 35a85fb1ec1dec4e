"""The refitted model with the named effects: its gain, and whether it becomes final."""
