"""Contracts of the subjects of requirements: assumptions and demands."""
