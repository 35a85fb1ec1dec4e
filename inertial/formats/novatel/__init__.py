"""Logs of NovAtel receivers: increments of the IMU among any other messages, text and binary."""
