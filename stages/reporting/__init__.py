"""The lab report: its outline as data, its figures, its templates."""
