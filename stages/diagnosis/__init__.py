"""Causes, not symptoms: findings weighed against each other, and the result that counts."""
