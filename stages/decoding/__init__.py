"""Logs of every kind as samples in SI units, body axes and one clock."""
