"""Log formats, one per file: bytes → counts, times, status. They know no calibration."""
