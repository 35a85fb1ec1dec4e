"""What the IMU should have read, by the forward model with the solved parameters."""
