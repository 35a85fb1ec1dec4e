"""The samples with the errors taken out, and the check against what is known."""
