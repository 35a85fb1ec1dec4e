"""What the calibration is worth in free inertial navigation, and which parameter limits it."""
