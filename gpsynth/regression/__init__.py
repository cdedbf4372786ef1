"""Symbolic regression: formulas found from data (X, y)."""
