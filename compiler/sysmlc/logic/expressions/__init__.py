"""Expressions of guards, effects and constraints: syntax, names, and translation to formulas."""
