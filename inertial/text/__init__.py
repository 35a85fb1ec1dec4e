"""How numbers, units and causes are written for a person."""
