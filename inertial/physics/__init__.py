"""The forward problem: site, motion of the table, and what an IMU reads there; arrays only."""
