"""The physical effects that the simulation does not contain, by name."""
