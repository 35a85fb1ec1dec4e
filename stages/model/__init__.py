"""The forward problem: the site, the motion of the table, and what an IMU should read there."""
