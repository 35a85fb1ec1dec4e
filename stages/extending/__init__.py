"""The model with the effects that were named: parameters, gain, worth, and whether it counts."""
