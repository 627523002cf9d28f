"""The shipped examples as tests."""
