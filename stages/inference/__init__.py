"""The inverse problem: from readings to parameters, each with its covariance."""
