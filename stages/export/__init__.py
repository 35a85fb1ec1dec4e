"""The calibration for other programs: JSON and YAML, Kalibr, PX4, ArduPilot."""
