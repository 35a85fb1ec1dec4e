"""The campaign file, made explicit: one row per manoeuvre in SI, and all that is taken as known."""
