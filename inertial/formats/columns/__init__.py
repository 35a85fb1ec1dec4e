"""Logs of columns: one data row per sample, in text or in a container."""
