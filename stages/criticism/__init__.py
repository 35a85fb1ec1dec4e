"""Which physical effects the simulation lacks, by name."""
