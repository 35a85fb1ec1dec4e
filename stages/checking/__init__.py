"""What is wrong with a recording, told in a terminal while the set-up still stands."""
