"""The accelerometers from rests and steady turns: bias, M, mounting, with covariance."""
