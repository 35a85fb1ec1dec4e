"""What can be said of a recording without the plan: its time, its values, its scale."""
