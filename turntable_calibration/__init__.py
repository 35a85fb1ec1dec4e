"""The command `turntable-calibration`: the workflow of this project on a folder of one's own."""
