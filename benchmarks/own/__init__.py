"""Programs in a process of their own that do this project's part of a benchmark."""
