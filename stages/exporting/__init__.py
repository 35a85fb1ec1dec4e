"""A calibration in the formats that other programs read, each with what it cannot carry."""
