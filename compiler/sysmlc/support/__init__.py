"""Helpers for all layers that know nothing of models: files, cache, escapes, text formats."""
