"""Stage `report`: the calibration report as one page, and its verdict as text."""
