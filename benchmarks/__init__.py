"""What the project is worth beside others: `make bench` measures and times it on the same data."""
