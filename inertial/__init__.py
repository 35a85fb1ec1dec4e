"""What the stages are made of; it knows no stage."""
