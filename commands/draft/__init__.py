"""A first campaign file from the logs alone: what they are, what was done, what is to be asked."""
