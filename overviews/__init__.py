"""Pages of several campaigns: all of them, the history of an IMU, two beside each other.

They look as the report does, and compute nothing anew but what only several campaigns can show.
"""
