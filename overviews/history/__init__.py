"""The history of an IMU as a page: every parameter over its calibrations."""
