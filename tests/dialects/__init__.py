"""Translators into the dialects of tools, and random models, for the tests."""
