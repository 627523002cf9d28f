"""What a saved model keeps for the way back: a comment that starts with a known word."""

PREFIX = "sysmlc-kept/1 "
"""How the body starts; what follows is JSON (metamodels/sysmlc-kept.schema.json)."""
