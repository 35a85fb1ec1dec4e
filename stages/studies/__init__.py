"""S0's studies: parameters by epochs, running means and windows, and the table's time and angle."""
