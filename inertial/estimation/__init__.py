"""Least squares and the equations of accelerometers and gyros; arrays only."""
