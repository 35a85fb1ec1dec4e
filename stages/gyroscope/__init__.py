"""The gyros from turns and rests: bias, scale factors, cross terms, mounting, with covariance."""
