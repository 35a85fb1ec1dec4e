"""Coarse alignment, and the error of the attitude with and without rotation."""
