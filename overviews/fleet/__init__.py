"""Several campaigns taken together: effects too small for one, what shares them, populations."""
