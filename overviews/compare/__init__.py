"""Two campaigns beside each other: what their results, conditions and settings differ by."""
