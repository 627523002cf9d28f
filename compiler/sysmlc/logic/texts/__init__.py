"""Formal texts in models: temporal logic with the past, and property patterns as sentences."""
