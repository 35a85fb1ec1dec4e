"""Pages of several campaigns: all of them, an IMU over time, two beside each other, a fleet.

They look as the report does, and compute nothing anew but what only several campaigns can show.
"""
