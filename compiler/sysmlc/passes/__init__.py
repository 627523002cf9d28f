"""Passes: each refines the graph in place; ``pipeline`` knows their order."""
