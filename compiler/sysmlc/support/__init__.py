"""Helpers for all layers: output files, cache, escapes, suggestions, resources, TOML."""
