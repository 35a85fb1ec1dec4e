"""The model with the effects that were named, refitted: what it gains, and whether it counts."""
