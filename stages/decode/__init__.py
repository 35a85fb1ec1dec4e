"""The logs become samples in SI units, body axes and one clock; no byte is left unaccounted for."""
