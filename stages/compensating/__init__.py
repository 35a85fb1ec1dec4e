"""The errors of the IMU taken out of its samples, and whether that worked."""
