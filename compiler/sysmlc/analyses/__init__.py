"""Analyses compute results from the refined graph, on demand, and never change it."""
