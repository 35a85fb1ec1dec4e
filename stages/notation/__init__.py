"""How numbers are written for a person: digits, signs, and the units of the laboratory."""
