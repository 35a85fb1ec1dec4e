"""This calibration into the archive of its IMU, and the earlier ones of the same IMU out of it."""
