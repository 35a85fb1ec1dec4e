"""What is compared with what: rests, turns, directions, methods, and what others published."""
