"""Showing the logs to the detectors, and turning what they see into findings and masks."""
