"""The archive of calibrations: one file for each, which never changes."""
