"""Comparison with other programs on the same data: accuracy, time, memory (`make bench`)."""
